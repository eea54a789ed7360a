// What the parts of a plan's making share: its images, and how passes draw to them and read them.
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/c/recipe_plan.h"

namespace pellucid::c {

// Images by the names of their samplers: planes of the spread pyramid, and texels of low resolution.
constexpr const char* kPyramid[] = {"spreadColour", "spreadLimits", "spreadMoments", "spreadReachColour",
                                    "spreadRateColour"};
constexpr const char* kTexels[] = {"radianceTexels", "opacityTexels", "depthTexels"};

// Whether the layers' sums have a plane for it, which shaders/gl/packing.glsl unpacks.
constexpr bool isPacked(PlaneSum sum) {
  return sum <= PlaneSum::light;
}

class PlanParts {
 public:
  PlanParts(const Permutation& permutation, const PlanShape& shape) : p_(permutation), shape_(shape) {
    plan.atlasLayers = shape.atlasLayers;
  }

  RecipePlan plan;

  void addImages();

 protected:
  // A plane and where it is.
  struct PlacedPlane {
    PlaneSpec spec;
    uint32_t image;
  };
  using Planes = std::vector<PlacedPlane>;

  PlannedPass& addPass(const char* name, pld_stage stage, const char* file, std::vector<std::string> defines);
  static void attach(PlannedPass& pass, const Planes& planes, pld_load load, bool blends);
  static void attachWhole(PlannedPass& pass, uint32_t image, uint32_t location = 0);
  static void read(PlannedPass& pass, uint32_t image, int binding, const std::string& sampler, int32_t layer = 0);

  const Permutation& p_;
  const PlanShape shape_;
  uint32_t colour_ = PLD_NO_IMAGE, depth_ = PLD_NO_IMAGE, occlusion_ = PLD_NO_IMAGE, picture_ = PLD_NO_IMAGE,
           reactive_ = PLD_NO_IMAGE, nearestDepth_ = PLD_NO_IMAGE, planarZ_ = PLD_NO_IMAGE, solidDepth_ = PLD_NO_IMAGE,
           farthestZ_ = PLD_NO_IMAGE, meanDepth_ = PLD_NO_IMAGE, opacityDepth_ = PLD_NO_IMAGE, motion_ = PLD_NO_IMAGE,
           identity_ = PLD_NO_IMAGE;
  std::vector<uint32_t> texels_, pyramid_;
  Planes solids_, front_, layers_, rims_, low_, over_, marks_, solidMarks_, listedDepths_;

 private:
  uint32_t add(PlannedImage image);
  uint32_t own(const char* name, pld_format format, PartOfFrame part = PartOfFrame::picture, uint32_t layers = 1);
  Planes addPlanes(const std::vector<PlaneSpec>& specs, PartOfFrame part = PartOfFrame::picture,
                   const char* prefix = "");
  void addOutputImages();
  void addLowImages();
};

}  // namespace pellucid::c
