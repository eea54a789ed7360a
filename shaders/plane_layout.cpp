#include "shaders/plane_layout.h"

#include <algorithm>
#include <limits>

namespace pellucid {
namespace {

using Wanted = bool (*)(const LayerModel&);

constexpr int kNext = -1;  // the first target that is free
enum class Width { one, two, four };

// A plane of PlaneStage::layers.
struct Row {
  PlaneSum sum;
  const char* name;
  int unit, target;
  Wanted kept;
  Width (*width)(const LayerModel&);
  std::array<int, 4> pixelPower;
};

constexpr std::array<int, 4> kNoPixels = {0, 0, 0, 0};
Width four(const LayerModel&) {
  return Width::four;
}

// One optical depth for all channels leaves half a plane, unless what scatters fills it.
Width widthOfDepth(const LayerModel& m) {
  return m.grey() && !(m.averagedOnly() && m.scatters()) ? Width::two : Width::four;
}

const Row kRows[] = {
    {PlaneSum::radiance, "radianceSum", 1, 0, [](const LayerModel&) { return true; }, four, kNoPixels},
    {PlaneSum::weight, "weightSum", 2, kNext, [](const LayerModel& m) { return !m.published() && !m.grey(); }, four,
     kNoPixels},
    {PlaneSum::opacity, "opacitySum", 3, kNext, [](const LayerModel& m) { return !m.published() && !m.averagedOnly(); },
     four, kNoPixels},
    {PlaneSum::depth, "depthSum", 4, kNext, [](const LayerModel& m) { return !m.published(); }, widthOfDepth,
     kNoPixels},
    {PlaneSum::beta, "betaProduct", 2, kNext, [](const LayerModel& m) { return m.published(); }, four, kNoPixels},
    {PlaneSum::delta, "deltaSum", 8, kNext, [](const LayerModel& m) { return m.published() && m.scatters(); },
     [](const LayerModel&) { return Width::two; }, kNoPixels},
    // Beside the other sums it also holds the depth of the layers that refract.
    {PlaneSum::light, "lightSum", 7, 4,
     [](const LayerModel& m) { return !m.published() && (m.addsLight || (m.scatters() && !m.averagedOnly())); }, four,
     kNoPixels},
    {PlaneSum::nearestZ, "nearestZ", 9, 5, [](const LayerModel& m) { return !m.published() && m.nearestDepths; },
     [](const LayerModel& m) { return m.scatters() ? Width::two : Width::one; }, kNoPixels},
    {PlaneSum::refraction,
     "refractionSum",
     8,
     6,
     [](const LayerModel& m) { return !m.published() && m.scatters(); },
     four,
     {1, 1, 0, 2}},
    {PlaneSum::dispersion,
     "dispersionSum",
     10,
     7,
     [](const LayerModel& m) { return !m.published() && m.disperses; },
     four,
     {1, 1, 1, 1}},
    // Front and tail do not scatter: the places of those planes are free.
    {PlaneSum::frontRadiance, "frontRadiance", 8, 6, [](const LayerModel& m) { return m.front; }, four, kNoPixels},
    {PlaneSum::frontDepth, "frontDepth", 10, 7, [](const LayerModel& m) { return m.front; },
     [](const LayerModel& m) { return m.grey() ? Width::one : Width::four; }, kNoPixels},
};

PlaneFormat formatOf(Width width, bool half) {
  switch (width) {
    case Width::one:
      return half ? PlaneFormat::r16f : PlaneFormat::r32f;
    case Width::two:
      return half ? PlaneFormat::rg16f : PlaneFormat::rg32f;
    default:
      return half ? PlaneFormat::rgba16f : PlaneFormat::rgba32f;
  }
}

PlaneFormat formatOf(const Row& row, const LayerModel& m) {
  if (row.sum == PlaneSum::beta) return PlaneFormat::rgba8;
  if (row.sum == PlaneSum::delta) return PlaneFormat::rg8snorm;
  const bool depth = row.sum == PlaneSum::nearestZ;  // never rounded: what lies behind a layer must not come before it
  return formatOf(row.width(m), !depth && (m.tier == PlaneTier::half || m.published()));
}

PlaneBlend blendOf(PlaneSum sum, const LayerModel& m) {
  if (sum == PlaneSum::nearestZ) return PlaneBlend::minimum;
  if (sum == PlaneSum::beta) return PlaneBlend::product;
  return m.diffuseInAlpha() && sum == diffuseZPlace(m).sum ? PlaneBlend::alphaMinimum : PlaneBlend::add;
}

std::array<float, 4> clearOf(PlaneBlend blend, int components) {
  constexpr float far = std::numeric_limits<float>::infinity();
  switch (blend) {
    case PlaneBlend::minimum:
      return {far, components > 1 ? far : 0.0f, 0, 0};
    case PlaneBlend::alphaMinimum:
      return {0, 0, 0, far};
    case PlaneBlend::product:
      return {1, 1, 1, 0};
    default:
      return {0, 0, 0, 0};
  }
}

// Written once when the stage ends, never blended.
std::vector<PlaneSpec> sortedPlanes() {
  constexpr float far = std::numeric_limits<float>::infinity();
  return {{PlaneSum::sortedLight, "sortedLight", 0, PlaneFormat::rgba32f, PlaneBlend::add, 1, {0, 0, 0, 0}, kNoPixels},
          {PlaneSum::sortedTransmission,
           "sortedTransmission",
           1,
           PlaneFormat::rgba32f,
           PlaneBlend::add,
           2,
           {1, 1, 1, far},
           kNoPixels}};
}

std::vector<PlaneSpec> layerPlanes(const LayerModel& model) {
  if (model.sorted) return sortedPlanes();
  std::vector<PlaneSpec> planes;
  int next = 1;
  for (const Row& row : kRows) {
    if (!row.kept(model)) continue;
    const PlaneFormat format = formatOf(row, model);
    const PlaneBlend blend = blendOf(row.sum, model);
    planes.push_back({row.sum, row.name, row.target == kNext ? next++ : row.target, format, blend, row.unit,
                      clearOf(blend, componentsOf(format)), row.pixelPower});
  }
  return planes;
}

PlaneSpec added(PlaneSum sum, const char* name, int target, PlaneFormat format, int unit) {
  return {sum, name, target, format, PlaneBlend::add, unit, {0, 0, 0, 0}, kNoPixels};
}

constexpr int kOverUnit = 11, kRimUnit = 11;  // where the spread pyramid lies, which neither looks up

std::vector<PlaneSpec> overPlanes(const LayerModel& model) {
  if (!model.over()) return {};
  const PlaneFormat depth = model.grey() ? PlaneFormat::r32f : PlaneFormat::rgba32f;
  return {added(PlaneSum::frontRadiance, "overRadiance", 6, PlaneFormat::rgba32f, kOverUnit),
          added(PlaneSum::frontDepth, "overDepth", 7, depth, kOverUnit + 1)};
}

// The last target that the layers leave free; below 0: none.
int marksTarget(const LayerModel& model) {
  if (model.tier == PlaneTier::exact) return 0;  // in a pass of its own
  const std::vector<PlaneSpec> planes = layerPlanes(model);
  const auto isTaken = [&](int target) {
    return std::any_of(planes.begin(), planes.end(), [&](const PlaneSpec& plane) { return plane.target == target; });
  };
  int target = kMostTargets - 1;
  while (target >= 0 && isTaken(target)) --target;
  return target;
}

// Never rounded: identities are whole numbers up to 2^24.
std::vector<PlaneSpec> marksPlanes(const LayerModel& model) {
  if (!model.marked()) return {};
  const bool alone = !model.moves && model.tier != PlaneTier::exact;
  const PlaneBlend blend = alone ? PlaneBlend::minimum : model.named ? PlaneBlend::alphaMinimum : PlaneBlend::add;
  const PlaneFormat format = alone ? PlaneFormat::r32f : PlaneFormat::rgba32f;
  return {{PlaneSum::marks, "layerMarks", marksTarget(model), format, blend, kMarksUnit,
           clearOf(blend, componentsOf(format)), kNoPixels}};
}

}  // namespace

bool hasRoomForMarks(const LayerModel& model) {
  return marksTarget(model) >= 0;
}

bool isOfScattering(PlaneSum sum) {
  const auto place = static_cast<std::size_t>(sum);
  return place >= kFirstScatterSum && place < kAddedSums;
}

int componentsOf(PlaneFormat format) {
  switch (format) {
    case PlaneFormat::r16f:
    case PlaneFormat::r32f:
      return 1;
    case PlaneFormat::rg16f:
    case PlaneFormat::rg32f:
    case PlaneFormat::rg8snorm:
      return 2;
    default:
      return 4;
  }
}

int bitsOf(PlaneFormat format) {
  switch (format) {
    case PlaneFormat::rgba8:
    case PlaneFormat::rg8snorm:
      return 8 * componentsOf(format);
    case PlaneFormat::r16f:
    case PlaneFormat::rg16f:
    case PlaneFormat::rgba16f:
      return 16 * componentsOf(format);
    default:
      return 32 * componentsOf(format);
  }
}

int bitsOf(const std::vector<PlaneSpec>& planes) {
  int bits = 0;
  for (const PlaneSpec& plane : planes) bits += plane.bits();
  return bits;
}

bool holds(const LayerModel& model, PlaneSum sum) {
  for (const PlaneSpec& plane : planesOf(model))
    if (plane.sum == sum) return true;
  return false;
}

int usedBits(const LayerModel& model) {
  return bitsOf(planesOf(model)) - (model.published() && !model.scatters() ? 8 : 0);
}

std::vector<PlaneSpec> planesOf(const LayerModel& model, PlaneStage stage) {
  constexpr float far = std::numeric_limits<float>::infinity();
  switch (stage) {
    case PlaneStage::front:
      return {
          {PlaneSum::frontZ, "frontZ", 0, PlaneFormat::r32f, PlaneBlend::minimum, 0, {far, far, far, far}, kNoPixels}};
    case PlaneStage::solids:  // of those at the nearest depth the brightest: their own blending is GL's
      return {{PlaneSum::solid,
               "solidRadiance",
               0,
               PlaneFormat::rgba32f,
               PlaneBlend::add,
               kSolidUnit,
               {0, 0, 0, far},
               kNoPixels}};
    case PlaneStage::rims:
      return {added(PlaneSum::rimAveraged, "averagedRim", 0, PlaneFormat::rgba32f, kRimUnit),
              added(PlaneSum::rimAdded, "addedRim", 1, PlaneFormat::rgba32f, kRimUnit + 1),
              added(PlaneSum::rimGradient, "rimGradient", 2, PlaneFormat::rg32f, kRimUnit + 2)};
    case PlaneStage::over:
      return overPlanes(model);
    case PlaneStage::marks:
      return marksPlanes(model);
    case PlaneStage::solidMarks:
      return {added(PlaneSum::solidMarks, "solidMarks", model.tier == PlaneTier::exact ? 0 : 1, PlaneFormat::rgba32f,
                    kSolidMarksUnit)};
    case PlaneStage::listedDepths:
      return {added(PlaneSum::listedDepths, "layerDepths", 1, PlaneFormat::rg32f, kMarksUnit)};
    default:
      return layerPlanes(model);
  }
}

LayerModel atLowResolution(LayerModel model) {
  model.nearestDepths = true;
  model.front = model.solids = model.rims = model.lowResolution = false;
  return model;
}

PlacedNumber refractionZPlace(const LayerModel& m) {
  if (!m.averagedOnly()) return {PlaneSum::light, 3};
  return m.grey() ? PlacedNumber{PlaneSum::depth, 2} : PlacedNumber{PlaneSum::weight, 3};
}

PlacedNumber diffuseZPlace(const LayerModel& m) {
  if (m.nearestDepths) return {PlaneSum::nearestZ, 1};
  return {m.averagedOnly() ? PlaneSum::depth : PlaneSum::opacity, 3};
}

LayerConflict conflictOf(const LayerModel& m) {
  const struct {
    bool meet;
    LayerConflict conflict;
  } rules[] = {
      {m.sorted && m.tier != PlaneTier::exact,
       {LayerPart::sorted, LayerPart::exact, true, "which lists the layers that are to be sorted"}},
      {m.sorted && m.scatters(),
       {LayerPart::sorted, LayerPart::scattering, false, "which look up one background for all layers together"}},
      {m.sorted && m.lowResolution, {LayerPart::sorted, LayerPart::lowResolution, false, "whose layers come as sums"}},
      {m.front && m.published(), {LayerPart::front, LayerPart::published, false, "which keeps no nearest layer"}},
      {m.disperses && m.published(),
       {LayerPart::dispersion, LayerPart::published, false, "which holds one offset for all channels"}},
      {m.disperses && !m.refracts, {LayerPart::dispersion, LayerPart::refraction, true, ""}},
      {m.scatters() && m.front,
       {LayerPart::scattering, LayerPart::front, false, "whose planes have the place of those that scatter"}},
      {m.lowResolution && m.published(),
       {LayerPart::lowResolution, LayerPart::published, false, "which keeps no depths to upsample by"}},
      {m.over() && m.tier == PlaneTier::exact,
       {LayerPart::lowResolution, LayerPart::exact, false, "which with front+tail keeps no nearest depth for it"}},
  };
  for (const auto& rule : rules)
    if (rule.meet) return rule.conflict;
  return {};
}

const std::vector<PlaneChannel>& channelsOf(ChannelGroup group, bool published) {
  using S = PlaneSum;
  static const std::vector<PlaneChannel> none;
  static const std::vector<PlaneChannel> sums = {
      {"oit.A.R", S::radiance, 0, true},  {"oit.A.G", S::radiance, 1, true},   {"oit.A.B", S::radiance, 2, true},
      {"oit.Wz", S::radiance, 3, true},   {"oit.W.R", S::weight, 0, true},     {"oit.W.G", S::weight, 1, true},
      {"oit.W.B", S::weight, 2, true},    {"oit.count", S::weight, 3, true},   {"oit.O.R", S::opacity, 0, true},
      {"oit.O.G", S::opacity, 1, true},   {"oit.O.B", S::opacity, 2, true},    {"oit.Oz", S::opacity, 3, true},
      {"oit.tau.R", S::depth, 0, true},   {"oit.tau.G", S::depth, 1, true},    {"oit.tau.B", S::depth, 2, true},
      {"oit.E.W", S::depth, 3, true},     {"oit.E.R", S::light, 0, true},      {"oit.E.G", S::light, 1, true},
      {"oit.E.B", S::light, 2, true},     {"oit.solid.R", S::solid, 0, true},  {"oit.solid.G", S::solid, 1, true},
      {"oit.solid.B", S::solid, 2, true}, {"oit.solid.Z", S::solid, 3, false}, {"oit.front.Z", S::nearestZ, 0, false}};
  static const std::vector<PlaneChannel> scattering = {
      {"oit.delta.X", S::refraction, 0, true}, {"oit.delta.Y", S::refraction, 1, true},
      {"oit.delta.W", S::refraction, 2, true}, {"oit.D2", S::refraction, 3, true},
      {"oit.delta.Z", S::light, 3, true},      {"oit.diffuse.Z", S::nearestZ, 1, false}};
  static const std::vector<PlaneChannel> dispersion = {{"oit.dispersion.RX", S::dispersion, 0, true},
                                                       {"oit.dispersion.RY", S::dispersion, 1, true},
                                                       {"oit.dispersion.BX", S::dispersion, 2, true},
                                                       {"oit.dispersion.BY", S::dispersion, 3, true}};
  static const std::vector<PlaneChannel> rims = {
      {"oit.rim.R", S::rimAveraged, 0, true}, {"oit.rim.G", S::rimAveraged, 1, true},
      {"oit.rim.B", S::rimAveraged, 2, true}, {"oit.rim.W", S::rimAveraged, 3, true},
      {"oit.rim.E.R", S::rimAdded, 0, true},  {"oit.rim.E.G", S::rimAdded, 1, true},
      {"oit.rim.E.B", S::rimAdded, 2, true},  {"oit.rim.Z", S::rimAdded, 3, true},
      {"oit.rim.X", S::rimGradient, 0, true}, {"oit.rim.Y", S::rimGradient, 1, true}};
  // PT17 table 2, decoded, and the solid plane.
  static const std::vector<PlaneChannel> publishedSums = {
      {"oit.A.R", S::radiance, 0, true},  {"oit.A.G", S::radiance, 1, true},  {"oit.A.B", S::radiance, 2, true},
      {"oit.W", S::weight, 0, true},      {"oit.beta.R", S::depth, 0, true},  {"oit.beta.G", S::depth, 1, true},
      {"oit.beta.B", S::depth, 2, true},  {"oit.solid.R", S::solid, 0, true}, {"oit.solid.G", S::solid, 1, true},
      {"oit.solid.B", S::solid, 2, true}, {"oit.solid.Z", S::solid, 3, false}};
  static const std::vector<PlaneChannel> publishedScattering = {{"oit.delta.X", S::refraction, 0, true},
                                                                {"oit.delta.Y", S::refraction, 1, true},
                                                                {"oit.D2", S::refraction, 3, true}};
  switch (group) {
    case ChannelGroup::sums:
      return published ? publishedSums : sums;
    case ChannelGroup::scattering:
      return published ? publishedScattering : scattering;
    case ChannelGroup::dispersion:
      return published ? none : dispersion;
    default:
      return published ? none : rims;
  }
}

}  // namespace pellucid
