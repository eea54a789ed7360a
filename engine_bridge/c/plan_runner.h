// Runs the passes of a plan in the host's context: the only code that turns one into calls of GL.
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "engine_bridge/c/plan_sizes.h"
#include "engine_bridge/c/plan_textures.h"
#include "engine_bridge/c/recipe_numbers.h"

namespace pellucid::c {

class PlanRunner {
 public:
  PlanRunner(Device& device, const RecipePlan& plan, const PlanTextures& textures)
      : device_(device), plan_(plan), textures_(textures) {}

  std::string build();  // a program for each full-screen pass; empty, else the driver's words
  void destroy();

  const PlannedPass& drawsOf(pld_stage stage) const;
  // Texture units that passes read from when a stage ends, or when the view is resolved: 0 to this number - 1.
  int unitsAtEnd(pld_stage stage) const;
  int unitsOfResolve() const;
  bool reads(const PlannedPass& pass, pld_role role) const;

  // Before the first pass of several, between which nothing but this draws.
  void begin(const pld_frame& frame, int width);
  // Likewise, of a face of shadow maps.
  //   layer  of the maps, that of the face's first channel
  void beginFace(int layer);
  // A full-screen pass, as often as the frame repeats it. Where the host's target is drawn to, it is bound.
  void run(const PlannedPass& pass, int view = 0);
  // Of draws: the framebuffer; what of its planes is cleared; how they are blended and what is tested against.
  void bindFrame(const PlannedPass& pass) const;
  void clear(const PlannedPass& pass) const;
  void setBlending(const PlannedPass& pass) const;
  void setTests(const PlannedPass& pass) const;
  // Textures of the seam, from the unit of pld_create_info on; what the stage does not read is unbound.
  void bindSeam(const PlannedPass& pass);

 private:
  // A text that passes share which look at the same, with what it was told last.
  struct Own {
    Program program;
    const PlannedPass* like = nullptr;
    std::vector<NumberPlace> numbers;
    std::vector<GLint> places;  // of each number in the program
    std::vector<std::byte> told, wanted;
    bool isTold = false;
  };

  std::string build(const PlannedPass& pass, Own& own) const;
  GLuint firstUnitOf(const PlannedPass& pass) const;
  GLuint textureOf(uint32_t image) const;
  void bind(GLuint unit, GLuint texture);
  void bindReads(const PlannedPass& pass);
  void tell(Own& own, uint32_t repeat, int view);
  void setPlain(const PassArea& area);

  Device& device_;
  const RecipePlan& plan_;
  const PlanTextures& textures_;
  std::vector<Own> programs_;
  std::vector<std::size_t> programOf_;  // of each pass
  // Of the passes since begin().
  pld_frame frame_{};
  int width_ = 0, faceLayer_ = 0;
  bool isPlain_ = false;
  std::array<GLuint, kMostUnits> bound_{};  // of what is bound since begin()
};

}  // namespace pellucid::c
