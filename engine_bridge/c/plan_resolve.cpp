#include "engine_bridge/c/plan_resolve.h"

#include "shaders/plane_defines.h"

namespace pellucid::c {

void ResolvePlan::readPyramid(PlannedPass& pass, int32_t layer) const {
  for (std::size_t i = 0; i < pyramid_.size(); ++i)
    read(pass, pyramid_[i], kSpreadUnit + static_cast<int>(i), kPyramid[i], layer);
}

void ResolvePlan::addSpread() {
  if (!p_.has(PLD_FEATURE_DIFFUSION)) return;
  PlannedPass& pass = addPass("spread", PLD_STAGE_LAYERS, "gl/spread_level.frag", resolveDefines(p_));
  pass.moment = Moment::resolve;
  pass.part = PartOfFrame::pyramid;
  read(pass, colour_, kBackgroundUnit, "background");
  read(pass, planarZ_, kOpaqueZUnit, "opaqueZ");
  if (!solids_.empty()) read(pass, solids_[0].image, kSolidUnit, "solid");
  for (const PlacedPlane& plane : layers_)  // of the published tier all planes say what a pixel spreads by
    if (p_.published() || plane.spec.sum == PlaneSum::refraction)
      read(pass, plane.image, plane.spec.unit, plane.spec.name);
  readPyramid(pass, PLD_LAYER_BEFORE);
  for (std::size_t i = 0; i < pyramid_.size(); ++i)
    pass.attachments.push_back(
        {pyramid_[i], static_cast<uint32_t>(i), PLD_LAYER_OF_REPEAT, PLD_LOAD_ANY, kAllComponents, {}});
  pass.numbers = {StageNumber::pictureSize, StageNumber::level, StageNumber::spreadLevels};
}

//   colour   of the background, where nothing shows another
//   nearest  the depth of the nearest layer
void ResolvePlan::readResolved(PlannedPass& pass, bool colour, bool nearest) const {
  if (colour || p_.scatters()) read(pass, colour_, kBackgroundUnit, "background");
  for (const PlacedPlane& plane : layers_)
    if (plane.spec.sum != PlaneSum::nearestZ || nearest || p_.scatters())
      read(pass, plane.image, plane.spec.unit, plane.spec.name);
  for (const PlacedPlane& plane : over_) read(pass, plane.image, plane.spec.unit, plane.spec.name);
  if (p_.scatters()) read(pass, planarZ_, kOpaqueZUnit, "opaqueZ");
  if (!solids_.empty()) read(pass, solids_[0].image, kSolidUnit, "solid");
  readPyramid(pass, PLD_LAYERS_ALL);
  pass.numbers = {StageNumber::pictureSize};
  if (!p_.scatters()) return;
  pass.numbers.insert(pass.numbers.end(), {StageNumber::lookup, StageNumber::largestSpread});
  if (pyramid_.empty()) return;
  pass.numbers.push_back(StageNumber::spreadLevels);
  if (shape_.atlasLayers > 1) pass.defines.emplace_back("SPREAD_LAYERS");
}

PlannedPass& ResolvePlan::addShown(const char* name, const char* file, int firstView, int lastView) {
  PlannedPass& pass = addPass(name, PLD_STAGE_LAYERS, file, resolveDefines(p_));
  pass.moment = Moment::resolve;
  pass.firstView = firstView;
  pass.lastView = lastView;
  return pass;
}

void ResolvePlan::addPicture() {
  PlannedPass& pass = addShown("picture", "gl/picture.frag", PLD_VIEW_PICTURE, PLD_VIEW_PICTURE);
  readResolved(pass, true, false);
  attachWhole(pass, picture_);
}

void ResolvePlan::addOutputs() {
  addDepths();
  addMarks();
}

void ResolvePlan::addMasks() {
  if (!p_.outputs()) return;
  for (const bool depth : {false, true}) {
    const int view = depth ? PLD_VIEW_NEAREST_DEPTH : PLD_VIEW_REACTIVE;
    PlannedPass& output = addShown(depth ? "nearest depth" : "reactive", "gl/outputs.frag", view, view);
    readResolved(output, false, true);
    output.numbers.push_back(StageNumber::view);
    attachWhole(output, depth ? nearestDepth_ : reactive_);
  }
}

PlannedPass& ResolvePlan::addLook(const char* name, const char* file, int view) {
  PlannedPass& pass = addShown(name, file, view, view);
  pass.defines = resolveDefines(p_, false);
  pass.numbers = {StageNumber::pictureSize};
  return pass;
}

void ResolvePlan::readSums(PlannedPass& pass) const {
  for (const PlacedPlane& plane : layers_)
    if (isPacked(plane.spec.sum) || plane.spec.sum == PlaneSum::frontRadiance ||
        plane.spec.sum == PlaneSum::frontDepth || plane.spec.sum == PlaneSum::sortedLight ||
        plane.spec.sum == PlaneSum::sortedTransmission)
      read(pass, plane.image, plane.spec.unit, plane.spec.name);
  if (!solids_.empty()) read(pass, solids_[0].image, kSolidUnit, "solid");
}

PlannedPass& ResolvePlan::addListed(const char* name, const char* component, int view) {
  PlannedPass& pass = addShown(name, "gl/output_listed_depth.frag", view, view);
  pass.defines = {std::string("LISTED_DEPTH ") + component};
  read(pass, listedDepths_[0].image, kMarksUnit, "layerDepths");
  return pass;
}

void ResolvePlan::addDepths() {
  if (meanDepth_ != PLD_NO_IMAGE && !listedDepths_.empty()) {
    attachWhole(addListed("mean depth", "g", PLD_VIEW_MEAN_DEPTH), meanDepth_);
  } else if (meanDepth_ != PLD_NO_IMAGE) {
    PlannedPass& mean = addLook("mean depth", "gl/output_mean_depth.frag", PLD_VIEW_MEAN_DEPTH);
    readSums(mean);
    for (const PlacedPlane& plane : layers_)
      if (plane.spec.sum == PlaneSum::nearestZ) read(mean, plane.image, plane.spec.unit, plane.spec.name);
    attachWhole(mean, meanDepth_);
  }
  if (opacityDepth_ != PLD_NO_IMAGE)
    attachWhole(addListed("opacity depth", "r", PLD_VIEW_OPACITY_DEPTH), opacityDepth_);
}

void ResolvePlan::addMarks() {
  const auto readMarks = [&](PlannedPass& pass) {
    read(pass, marks_[0].image, kMarksUnit, marks_[0].spec.name);
    if (!solidMarks_.empty()) read(pass, solidMarks_[0].image, kSolidMarksUnit, solidMarks_[0].spec.name);
  };
  if (motion_ != PLD_NO_IMAGE) {
    PlannedPass& motion = addLook("motion", "gl/output_motion.frag", PLD_VIEW_MOTION);
    readSums(motion);
    for (const PlacedPlane& plane : over_) read(motion, plane.image, plane.spec.unit, plane.spec.name);
    readMarks(motion);
    attachWhole(motion, motion_);
  }
  if (identity_ != PLD_NO_IMAGE) {
    PlannedPass& identity = addShown("identity", "gl/output_identity.frag", PLD_VIEW_IDENTITY, PLD_VIEW_IDENTITY);
    identity.defines = {marks_[0].spec.components() == 1 ? "IDENTITY r" : "IDENTITY a"};
    if (solids_.empty()) identity.defines.emplace_back("NO_SOLIDS");
    if (!solids_.empty()) read(identity, solids_[0].image, kSolidUnit, "solid");
    readMarks(identity);
    attachWhole(identity, identity_);
  }
}

void ResolvePlan::addDebugViews() {
  if (!shape_.debugViews) return;
  PlannedPass& sums = addShown("view", "gl/view.frag", PLD_VIEW_LAYER_COUNT, PLD_VIEW_SOLID);
  readResolved(sums, true, true);
  sums.numbers.push_back(StageNumber::view);
  attachWhole(sums, picture_);
  if (p_.rimsApart()) {
    constexpr int openUnit = 14;
    PlannedPass& rims = addShown("view of rims", "gl/view_rims.frag", PLD_VIEW_RIM_OCCLUSION, PLD_VIEW_RIM_LOSS);
    // What rims take is looked at where it is, not where it is seen.
    rims.defines = resolveDefines(p_, false);
    rims.defines.push_back(rimSamplers());
    for (const Planes* planes : {&layers_, &rims_})
      for (const PlacedPlane& plane : *planes) read(rims, plane.image, plane.spec.unit, plane.spec.name);
    read(rims, planarZ_, kOpaqueZUnit, "opaqueZ");
    read(rims, occlusion_, openUnit, "opaqueOpen");
    if (!solids_.empty()) read(rims, solids_[0].image, kSolidUnit, "solid");
    rims.numbers = {StageNumber::pictureSize, StageNumber::form, StageNumber::view};
    attachWhole(rims, picture_);
  }
  if (p_.low()) {
    PlannedPass& low = addShown("view of low resolution", "gl/view_low.frag", PLD_VIEW_LOW_COLOUR, PLD_VIEW_LOW_DEPTH);
    low.defines.clear();
    for (std::size_t i = 0; i < texels_.size(); ++i) read(low, texels_[i], static_cast<int>(i), kTexels[i]);
    low.numbers = {StageNumber::view, StageNumber::factor};
    attachWhole(low, picture_);
  }
}

}  // namespace pellucid::c
