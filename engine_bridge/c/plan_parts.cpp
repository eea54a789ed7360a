#include "engine_bridge/c/plan_parts.h"

#include <utility>

#include "engine_bridge/c/stage_plan.h"

namespace pellucid::c {

uint32_t PlanParts::add(PlannedImage image) {
  plan.images.push_back(std::move(image));
  return static_cast<uint32_t>(plan.images.size() - 1);
}

uint32_t PlanParts::own(const char* name, pld_format format, PartOfFrame part, uint32_t layers) {
  return add({name, PLD_ROLE_OWN, format, part, layers, {}});
}

PlanParts::Planes PlanParts::addPlanes(const std::vector<PlaneSpec>& specs, PartOfFrame part, const char* prefix) {
  Planes planes;
  for (const PlaneSpec& spec : specs)
    planes.push_back(
        {spec, add({std::string(prefix) + spec.name, PLD_ROLE_OWN, formatOf(spec.format), part, 1, spec.clear})});
  return planes;
}

void PlanParts::addImages() {
  const auto host = [&](const char* name, pld_role role) { return add({name, role}); };
  colour_ = host("colour", PLD_ROLE_COLOUR);
  depth_ = host("depth", PLD_ROLE_DEPTH);
  if (p_.rims()) occlusion_ = host("occlusion", PLD_ROLE_OCCLUSION);
  picture_ = host("picture", PLD_ROLE_PICTURE);
  addOutputImages();
  const LayerModel model = modelOf(p_);
  layers_ = addPlanes(c::planesOf(p_));
  if (p_.planarDepth()) planarZ_ = own("opaqueZ", PLD_FORMAT_R32F);
  if (p_.frontStage()) front_ = addPlanes(pellucid::planesOf(model, PlaneStage::front));
  if (p_.has(PLD_FEATURE_SOLIDS)) {
    solids_ = addPlanes(pellucid::planesOf(model, PlaneStage::solids));
    if (!p_.exact()) solidDepth_ = own("solidDepth", PLD_FORMAT_DEPTH32F);
  }
  if (p_.rimsApart()) rims_ = addPlanes(pellucid::planesOf(model, PlaneStage::rims));
  if (p_.low()) addLowImages();
  if (p_.has(PLD_FEATURE_DIFFUSION))
    for (const char* name : kPyramid)
      pyramid_.push_back(
          own(name, PLD_FORMAT_RGBA32F, PartOfFrame::pyramid, static_cast<uint32_t>(shape_.atlasLayers)));
  marks_ = addPlanes(pellucid::planesOf(model, PlaneStage::marks));
  if (p_.marked() && p_.has(PLD_FEATURE_SOLIDS))
    solidMarks_ = addPlanes(pellucid::planesOf(model, PlaneStage::solidMarks));
  if (p_.reachesOpacity()) listedDepths_ = addPlanes(pellucid::planesOf(model, PlaneStage::listedDepths));
}

void PlanParts::addOutputImages() {
  const auto host = [&](const char* name, pld_role role) { return add({name, role}); };
  if (p_.outputs()) {
    reactive_ = host("reactive", PLD_ROLE_REACTIVE);
    nearestDepth_ = host("nearest depth", PLD_ROLE_NEAREST_DEPTH);
  }
  if (p_.meansDepth()) meanDepth_ = host("mean depth", PLD_ROLE_MEAN_DEPTH);
  if (p_.reachesOpacity()) opacityDepth_ = host("opacity depth", PLD_ROLE_OPACITY_DEPTH);
  if (p_.moves()) motion_ = host("motion", PLD_ROLE_MOTION);
  if (p_.named()) identity_ = host("identity", PLD_ROLE_IDENTITY);
}

void PlanParts::addLowImages() {
  farthestZ_ = own("farthestZ", PLD_FORMAT_R32F, PartOfFrame::low);
  low_ = addPlanes(c::planesOf(lowPermutation(p_)), PartOfFrame::low, "low ");
  for (const char* name : kTexels) texels_.push_back(own(name, PLD_FORMAT_RGBA32F, PartOfFrame::low));
  over_ = addPlanes(pellucid::planesOf(modelOf(p_), PlaneStage::over));
}

PlannedPass& PlanParts::addPass(const char* name, pld_stage stage, const char* file, std::vector<std::string> defines) {
  PlannedPass& pass = plan.passes.emplace_back();
  pass.name = name;
  pass.stage = stage;
  pass.file = file;
  pass.defines = std::move(defines);
  return pass;
}

void PlanParts::attach(PlannedPass& pass, const Planes& planes, pld_load load, bool blends) {
  for (const PlacedPlane& plane : planes)
    pass.attachments.push_back({plane.image, static_cast<uint32_t>(plane.spec.target), 0, load, kAllComponents,
                                blends ? blendOf(plane.spec.blend) : pld_blend{}});
}

void PlanParts::attachWhole(PlannedPass& pass, uint32_t image, uint32_t location) {
  pass.attachments.push_back({image, location, 0, PLD_LOAD_ANY, kAllComponents, {}});
}

void PlanParts::read(PlannedPass& pass, uint32_t image, int binding, const std::string& sampler, int32_t layer) {
  pass.reads.push_back({image, static_cast<uint32_t>(binding), sampler, layer});
}

}  // namespace pellucid::c
