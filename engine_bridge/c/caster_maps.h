// Shadow maps of transparent casters: the host draws what a light sees, the plan's passes filter it, and it is kept for
// lookups.
#pragma once
#include "engine_bridge/c/caster_checks.h"
#include "engine_bridge/c/plan_runner.h"

namespace pellucid::c {

class CasterMaps {
 public:
  explicit CasterMaps(Device& device) : device_(device) {}

  // The same info again keeps the maps; null gives them back.
  pld_status resize(const pld_shadow_info* info);
  void release();
  pld_status begin(const pld_shadow_view& view);
  void end();  // filters the face; only while one is open

  bool exist() const { return table_ != 0; }
  bool isOpen() const { return open_; }
  bool hasFace(int face) const { return faces_[face] != FaceKind::empty; }
  const pld_shadow_info& info() const { return plan_.maps; }  // all 0 without maps
  int edge() const;                                           // texels, as looked up
  // GL names, 0 without maps.
  GLuint texture() const { return exist() ? textures_.texture(plan_.passes.back().attachments[0].image) : 0; }
  GLuint table() const { return table_; }
  uint64_t bytes() const { return textures_.bytes(); }
  // PLD_VIEW_SHADOW_* of a face, over the bound framebuffer. What is bound to unit 0 as a 2D array comes back, unless
  // the host restores.
  void drawView(pld_view view, int face) const;

 private:
  enum class FaceKind : uint8_t { empty, directional, local };  // as it was drawn

  pld_status make();
  void makeTable();
  const PlannedPass& draws() const { return plan_.passes.front(); }
  void openFace(const pld_shadow_view& view, bool tests);
  void setTable() const;

  Device& device_;
  RecipePlan plan_;
  PlanTextures textures_{device_};
  PlanRunner runner_{device_, plan_, textures_};
  Program view_;
  GLuint table_ = 0, uniforms_ = 0;
  FaceKind faces_[kMostFaces] = {};
  // Of the face that is open.
  bool open_ = false;
  pld_shadow_view opened_{};
  double rows_ = 1.0;  // -1: NDC's y runs against the rows
  GLenum depthAttachment_ = 0;
};

}  // namespace pellucid::c
