// Shadow maps of transparent casters: the host draws what a light sees, this library filters it and keeps it for
// lookups.
#pragma once
#include "engine_bridge/c/caster_checks.h"
#include "engine_bridge/c/pass_device.h"

namespace pellucid::c {

class CasterMaps {
 public:
  explicit CasterMaps(Device& device) : device_(device) {}

  // The same info again keeps the maps; null gives them back.
  pld_status resize(const pld_shadow_info* info);
  void release();
  pld_status begin(const pld_shadow_view& view);
  void end();  // filters the face; only while one is open

  bool exist() const { return maps_ != 0; }
  bool isOpen() const { return open_; }
  bool hasFace(int face) const { return faces_[face] != FaceKind::empty; }
  const pld_shadow_info& info() const { return info_; }
  int edge() const;  // texels, as looked up
  // GL names, 0 without maps.
  GLuint texture() const { return maps_; }
  GLuint table() const { return table_; }
  uint64_t bytes() const { return bytes_; }
  // PLD_VIEW_SHADOW_* of a face, over the bound framebuffer. What is bound to unit 0 as a 2D array comes back, unless
  // the host restores.
  void drawView(pld_view view, int face) const;

 private:
  enum class FaceKind : uint8_t { empty, directional, local };  // as it was drawn

  pld_status make();
  std::string build();
  bool makeDrawn(GLuint& frame, GLuint* textures, int count, int width, int height);
  bool makeMaps();
  void makeTable();
  void openFace(const pld_shadow_view& view, bool tests);
  void filter(int face) const;
  void setTable() const;

  Device& device_;
  pld_shadow_info info_{};
  Program texels_, down_, view_;
  GLuint drawn_[2] = {}, across_[3] = {}, maps_ = 0, table_ = 0, uniforms_ = 0;
  GLuint drawnFrame_ = 0, acrossFrame_ = 0, mapFrame_ = 0;
  uint64_t bytes_ = 0;
  FaceKind faces_[kMostFaces] = {};
  // Of the face that is open.
  bool open_ = false;
  pld_shadow_view opened_{};
  double rows_ = 1.0;  // -1: NDC's y runs against the rows
  GLenum depthAttachment_ = 0;
};

}  // namespace pellucid::c
