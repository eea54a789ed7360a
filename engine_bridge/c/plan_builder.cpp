#include "engine_bridge/c/plan_builder.h"

#include <utility>

#include "shaders/plane_defines.h"

namespace pellucid::c {
namespace {

constexpr int kFarthestUnit = 5;  // of shaders/gl/low_texel.frag
constexpr uint32_t kColours = 7;  // of a write mask

// Blocks that the lists of a stage take, of those that the pass has: bits.
uint32_t listsOf(const Permutation& p, pld_stage stage) {
  return (1u << listBlocks(p, stage)) - 1u;
}

uint32_t marksOf(const Permutation& p) {
  return p.marked() ? 1u << (listBlocks(p) - 1) : 0;
}

}  // namespace

void PlanBuilder::addPlanarDepth() {
  if (!p_.planarDepth()) return;
  PlannedPass& pass =
      addPass("planar depth", firstStageOf(p_), "gl/planar_depth.frag", depthDefines(p_.depth, shape_.clip));
  pass.moment = Moment::begin;
  read(pass, depth_, 0, "hostDepth");
  attachWhole(pass, planarZ_);
  pass.numbers = {StageNumber::depthRows, StageNumber::metresPerUnit};
}

// What shaders/gl/seam.glsl looks up in a stage.
void PlanBuilder::readSeam(PlannedPass& pass) const {
  const auto readFrom = [&](int unit, uint32_t image) { read(pass, image, unit, kSeamSamplers[unit]); };
  const pld_stage stage = pass.stage;
  const bool low = stage == PLD_STAGE_LOW, layers = stage == PLD_STAGE_LAYERS;
  const bool tests = p_.depth == PLD_DEPTH_LINEAR || stage == PLD_STAGE_SOLIDS || low;
  const bool rims = p_.rimsInSeam() && layers;
  if (tests || rims || (p_.scatters() && (layers || low))) readFrom(0, low ? farthestZ_ : planarZ_);
  if (!solids_.empty() && stage != PLD_STAGE_SOLIDS && !low) readFrom(1, solids_[0].image);
  if (!front_.empty() && layers) readFrom(2, front_[0].image);
  if (rims) readFrom(3, occlusion_);
}

void PlanBuilder::addStage(pld_stage stage, const char* name, const Planes& planes) {
  if (!(stagesOf(p_) & (1u << stage))) return;
  const bool low = stage == PLD_STAGE_LOW, solids = stage == PLD_STAGE_SOLIDS;
  PlannedPass& pass = addPass(name, stage, "", {});
  pass.kind = PLD_PASS_DRAWS;
  pass.moment = Moment::draws;
  pass.part = low ? PartOfFrame::low : PartOfFrame::picture;
  readSeam(pass);
  if (p_.exact()) {
    pass.lists = listsOf(p_, stage) | (solids || stage == PLD_STAGE_LAYERS ? marksOf(p_) : 0u);
    pass.emptiesLists = true;
  } else {
    attach(pass, planes, PLD_LOAD_CLEAR, !solids);
    if (solids) attach(pass, solidMarks_, PLD_LOAD_CLEAR, false);
    if (stage == PLD_STAGE_LAYERS) attach(pass, marks_, PLD_LOAD_CLEAR, true);
  }
  if (solids && !p_.exact()) {
    pass.depthImage = solidDepth_;
    pass.compare = PLD_COMPARE_GREATER;
    pass.writesDepth = true;
  } else if (!solids && !low && p_.depth != PLD_DEPTH_LINEAR) {
    pass.depthImage = depth_;
    pass.compare = p_.depth == PLD_DEPTH_REVERSED ? PLD_COMPARE_GREATER_OR_EQUAL : PLD_COMPARE_LESS_OR_EQUAL;
  }
  if (p_.exact() && stage == PLD_STAGE_LAYERS && (!marks_.empty() || !listedDepths_.empty())) addListedMarks();
  if (p_.exact()) addFold(stage, name, planes);
}

void PlanBuilder::addFold(pld_stage stage, const char* name, const Planes& planes) {
  const bool low = stage == PLD_STAGE_LOW, solids = stage == PLD_STAGE_SOLIDS;
  const char* const file = solids ? "gl/exact_solids.frag" : p_.sorted() ? "gl/exact_over.frag" : "gl/exact_fold.frag";
  PlannedPass& pass =
      addPass((std::string(name) + " folded").c_str(), stage, file, foldDefines(low ? lowPermutation(p_) : p_, stage));
  pass.part = low ? PartOfFrame::low : PartOfFrame::picture;
  pass.lists = listsOf(p_, stage);
  pass.numbers = {StageNumber::rowLength};
  if (!solids && !p_.sorted()) pass.numbers.push_back(StageNumber::weight);
  if (!solids && p_.sorted() && !solids_.empty()) read(pass, solids_[0].image, kSolidUnit, "solidHere");
  attach(pass, planes, PLD_LOAD_ANY, false);
  if (solids && !solidMarks_.empty()) addSolidMarks();
}

void PlanBuilder::addSolidMarks() {
  PlannedPass& pass = addPass("solids marked", PLD_STAGE_SOLIDS, "gl/exact_solid_marks.frag", {marksPlace(p_)});
  pass.lists = listsOf(p_, PLD_STAGE_SOLIDS) | marksOf(p_);
  pass.numbers = {StageNumber::rowLength};
  attach(pass, solidMarks_, PLD_LOAD_ANY, false);
}

// Before the fold, of which that of PLD_METHOD_OVER leaves no list whose beginning is known.
void PlanBuilder::addListedMarks() {
  PlannedPass& pass = addPass("layers marked", PLD_STAGE_LAYERS, "gl/exact_marks.frag", marksDefines(p_));
  pass.lists = listsOf(Permutation{}, PLD_STAGE_LAYERS) | marksOf(p_);
  pass.numbers = {StageNumber::rowLength};
  attach(pass, marks_, PLD_LOAD_ANY, false);
  if (listedDepths_.empty()) return;
  pass.numbers.push_back(StageNumber::depthOpacity);
  if (!solids_.empty()) read(pass, solids_[0].image, kSolidUnit, "solidHere");
  attach(pass, listedDepths_, PLD_LOAD_ANY, false);
}

void PlanBuilder::addStages() {
  addStage(PLD_STAGE_SOLIDS, "solids", solids_);
  addStage(PLD_STAGE_FRONT, "front", front_);
  addStage(PLD_STAGE_LAYERS, "layers", layers_);
  addStage(PLD_STAGE_RIMS, "rims", rims_);
}

void PlanBuilder::addRimsApplied() {
  if (!p_.rimsApart()) return;
  constexpr int firstUnit = 0;
  std::vector<std::string> defines = resolveDefines(p_, false);
  defines.push_back(rimSamplers(firstUnit));
  PlannedPass& pass = addPass("rims darkened", PLD_STAGE_RIMS, "gl/rims_apply.frag", std::move(defines));
  for (const PlacedPlane& plane : rims_) read(pass, plane.image, firstUnit + plane.spec.target, plane.spec.name);
  read(pass, planarZ_, 3, "opaqueZ");
  read(pass, occlusion_, 4, "opaqueOpen");
  if (!solids_.empty()) read(pass, solids_[0].image, 5, "solid");
  constexpr pld_factor one = PLD_FACTOR_ONE;
  for (const PlacedPlane& plane : layers_)
    if (plane.spec.sum == PlaneSum::radiance || plane.spec.sum == PlaneSum::light)
      pass.attachments.push_back({plane.image,
                                  static_cast<uint32_t>(plane.spec.target),
                                  0,
                                  PLD_LOAD_KEEP,
                                  kColours,
                                  {1, one, one, PLD_BLEND_TAKE, one, one, PLD_BLEND_TAKE}});
  pass.numbers = {StageNumber::pictureSize, StageNumber::form};
}

void PlanBuilder::addLowResolution() {
  if (!p_.low()) return;
  const Permutation low = lowPermutation(p_);
  std::vector<std::string> noSolids;
  if (solids_.empty()) noSolids.emplace_back("NO_SOLIDS");
  PlannedPass& depth = addPass("farthest depth", PLD_STAGE_LOW, "gl/low_depth.frag", noSolids);
  depth.moment = Moment::begin;
  depth.part = PartOfFrame::low;
  read(depth, planarZ_, 0, "opaqueZ");
  if (!solids_.empty()) read(depth, solids_[0].image, 1, "solid");
  attachWhole(depth, farthestZ_);
  depth.numbers = {StageNumber::pictureSize, StageNumber::factor};

  addStage(PLD_STAGE_LOW, "low resolution", low_);

  // A texel's own light: what it bends and spreads is taken from its sums.
  PlannedPass& texel =
      addPass("low resolution resolved", PLD_STAGE_LOW, "gl/low_texel.frag", resolveDefines(low, false));
  texel.part = PartOfFrame::low;
  for (const PlacedPlane& plane : low_)
    if (isPacked(plane.spec.sum) || plane.spec.sum == PlaneSum::nearestZ)
      read(texel, plane.image, plane.spec.unit, plane.spec.name);
  read(texel, farthestZ_, kFarthestUnit, "farthestZ");
  for (std::size_t i = 0; i < texels_.size(); ++i) attachWhole(texel, texels_[i], static_cast<uint32_t>(i));
  texel.numbers = {StageNumber::texelSize};

  PlannedPass& upsampled = addPass("low resolution upsampled", PLD_STAGE_LOW, "gl/upsample.frag",
                                   upsampleDefines(modelOf(p_), modelOf(low)));
  for (std::size_t i = 0; i < texels_.size(); ++i) read(upsampled, texels_[i], static_cast<int>(i), kTexels[i]);
  read(upsampled, planarZ_, 3, "opaqueZ");
  if (!solids_.empty()) read(upsampled, solids_[0].image, 4, "solid");
  if (p_.fronts()) read(upsampled, front_[0].image, 5, "frontZ");
  upsampled.numbers = {StageNumber::texelCount, StageNumber::texelsAPixel};
  if (p_.scatters()) {
    upsampled.numbers.push_back(StageNumber::factorAsFloat);
    for (const PlacedPlane& plane : low_)
      if (isOfScattering(plane.spec.sum) || plane.spec.sum == PlaneSum::light || plane.spec.sum == PlaneSum::nearestZ)
        read(upsampled, plane.image, plane.spec.unit, std::string(plane.spec.name) + "Texels");
  }
  // In place of the nearest layer what lies before it.
  attach(upsampled, over_, PLD_LOAD_CLEAR, true);
  Planes sums;
  for (const PlacedPlane& plane : layers_)
    if (over_.empty() || (plane.spec.sum != PlaneSum::frontRadiance && plane.spec.sum != PlaneSum::frontDepth))
      sums.push_back(plane);
  attach(upsampled, sums, PLD_LOAD_KEEP, true);
}

RecipePlan recipePlan(const Permutation& permutation, const PlanShape& shape) {
  PlanBuilder builder(permutation, shape);
  builder.addImages();
  builder.addPlanarDepth();
  builder.addStages();
  builder.addRimsApplied();
  builder.addLowResolution();
  builder.addSpread();
  builder.addPicture();
  builder.addMasks();
  builder.addOutputs();
  builder.addDebugViews();
  return builder.plan;
}

}  // namespace pellucid::c
