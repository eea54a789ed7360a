// The planes of a pixel, said once: which sums the layers of a pass need, and how each lies on the device and in files.
// Targets, encoders, decoders, folds and files take their planes from here; a new plane is one row of plane_layout.cpp.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

namespace pellucid {

// What sums are kept in. `exact` has the planes of `float32`, made of fragment lists when a stage ends.
enum class PlaneTier { float32, half, published, exact };

// What the layers of a pass are, as far as their planes depend on it.
struct LayerModel {
  PlaneTier tier = PlaneTier::float32;
  int weight = 0;         // PLD_WEIGHT_* of shaders/shared/weight.glsl
  int normalisation = 0;  // PLD_NORMALISE_* of shaders/shared/accumulate.glsl
  bool coloured = true;   // some layer transmits colour; else all channels share one opacity
  bool addsLight = true;  // some layer adds light
  bool refracts = false, diffuses = false;
  bool disperses = false;      // refracts, by wavelength
  bool sorted = false;         // exact tier: composited in the order of depth when the stage ends; no sums at all
  bool front = false;          // front+tail: the nearest layer lies apart from the sums of the others
  bool nearestDepths = true;   // depth of the nearest layer and of the nearest that diffuses have a plane of their own
  bool solids = false;         // some fragment may hide everything
  bool rims = false;           // light of cut-out rims is summed apart, and darkened later
  bool lowResolution = false;  // layers drawn at a part of the resolution enter the sums
  bool moves = false, named = false;  // motion, and the nearest layer's identity, have a plane

  bool scatters() const { return refracts || diffuses; }
  bool published() const { return tier == PlaneTier::published; }
  bool grey() const { return !coloured && !published(); }
  // Every layer enters the average and none adds light, so the sums that weigh light are left out.
  bool averagedOnly() const { return !published() && !sorted && !addsLight && !nearestDepths; }
  // The nearest depth that diffuses is blended by MIN into the alpha of a sum, since it has no plane.
  bool diffuseInAlpha() const { return diffuses && !published() && !nearestDepths; }
  // Layers of low resolution that lie before the nearest layer have planes of their own.
  bool over() const { return lowResolution && front; }
  bool marked() const { return moves || named; }
};

// The layers of such a pass that are drawn at low resolution: nothing among them is solid or waits for its occlusion,
// and what stands before a pixel is told by their nearest depths.
LayerModel atLowResolution(LayerModel model);

// Parts of a model that exclude each other, and why: a clause about the second.
enum class LayerPart { published, exact, front, scattering, dispersion, refraction, lowResolution, sorted, none };
struct LayerConflict {
  LayerPart part = LayerPart::none, other = LayerPart::none;
  bool without = false;  // `other` is missing, not in the way
  const char* reason = "";
  explicit operator bool() const { return part != LayerPart::none; }
};
LayerConflict conflictOf(const LayerModel& model);

// Sums of MODEL section 3 by the names of shaders/shared. Those before `nearestZ` are vectors of four that add; of
// these, what scattering adds to a pixel beside its layers' sums stands from `refraction` on.
enum class PlaneSum {
  radiance,    // A; sum of w_z o
  weight,      // W; layers
  opacity,     // O; sum of o z
  depth,       // tau; sum of w_z E. Of the published tier: beta
  light,       // E; sum of W z over the refracting layers
  refraction,  // sums of W delta, W, s^2
  dispersion,  // sums of W times delta of red and of blue, minus delta
  nearestZ,    // of all layers; of those that diffuse
  solid,       // nearest fragment that hides everything: rgb, planar z
  beta,        // published tier: product of transmissions; sum of s^2
  delta,       // published tier: sum of o delta
  frontRadiance,
  frontDepth,  // of the nearest layer: light and layers; tau
  rimAveraged,
  rimAdded,
  rimGradient,         // gbuffer/rim_planes.h
  frontZ,              // what front+tail draws first: depth of the nearest layer
  sortedLight,         // light of all layers over what is solid; layers
  sortedTransmission,  // what they let through; depth of the nearest
  marks,               // sums of share times motion, of shares; identity of the nearest, which may be alone
  solidMarks,          // of the nearest solid: motion, 1, identity
  listedDepths         // exact tier: where opacity is reached; mean depth
};
constexpr std::size_t kAddedSums = static_cast<std::size_t>(PlaneSum::nearestZ);
constexpr std::size_t kFirstScatterSum = static_cast<std::size_t>(PlaneSum::refraction);
constexpr std::size_t kScatterSums = kAddedSums - kFirstScatterSum;
bool isOfScattering(PlaneSum sum);

enum class PlaneFormat { r16f, rg16f, rgba16f, r32f, rg32f, rgba32f, rgba8, rg8snorm };
int componentsOf(PlaneFormat format);
int bitsOf(PlaneFormat format);

// product: rgb by ZERO, ONE_MINUS_SRC_COLOR, alpha adds. alphaMinimum: rgb adds, alpha is the minimum.
enum class PlaneBlend { add, minimum, alphaMinimum, product };

// A texture that layers are blended into.
struct PlaneSpec {
  PlaneSum sum;
  const char* name;  // of its output and of its sampler in GLSL
  int target;        // colour attachment and draw buffer
  PlaneFormat format;
  PlaneBlend blend;
  int unit;  // where shaders/gl/resolve_here.glsl looks it up
  std::array<float, 4> clear;
  // A component counts pixels to this power: what is summed over texels of low resolution is scaled by it.
  std::array<int, 4> pixelPower;

  int components() const { return componentsOf(format); }
  int bits() const { return bitsOf(format); }
};

// Stages that draw planes. `over`: what front+tail keeps of layers that low resolution puts before the nearest one.
// `marks`: what layers tell besides what they look like; drawn with the layers, of the exact tier when the stage ends.
enum class PlaneStage { layers, front, solids, rims, over, marks, solidMarks, listedDepths };
std::vector<PlaneSpec> planesOf(const LayerModel& model, PlaneStage stage = PlaneStage::layers);
int bitsOf(const std::vector<PlaneSpec>& planes);
// Whether a target is left for PlaneStage::marks beside the layers'.
bool hasRoomForMarks(const LayerModel& model);
bool holds(const LayerModel& model, PlaneSum sum);
// Bits of a pixel that the layers use, as PT17 counts its targets: where nothing scatters the fourth byte of beta is
// there and holds nothing.
int usedBits(const LayerModel& model);

constexpr int kMostTargets = 8;
// Units of what is looked up beside the planes, and how many a resolve has.
constexpr int kBackgroundUnit = 0, kOpaqueZUnit = 5, kSolidUnit = 6, kSpreadUnit = 11, kSpreadPlanes = 5;
constexpr int kMarksUnit = 13, kSolidMarksUnit = 14;  // where the pyramid lies, which no reader of marks looks up
constexpr int kLookupUnits = kSpreadUnit + kSpreadPlanes;

// Where a stage finds a number that has no plane of its own.
struct PlacedNumber {
  PlaneSum sum;
  int component;
};
PlacedNumber refractionZPlace(const LayerModel& model);  // sum of W z over the refracting layers
PlacedNumber diffuseZPlace(const LayerModel& model);     // nearest depth that diffuses; models that diffuse

// Of an EXR file: a component of a plane, as gbuffer/accum.h and rim_planes.h hold it.
struct PlaneChannel {
  const char* name;
  PlaneSum sum;
  int component;
  bool finite;  // a sum, in which infinity means damage; else a distance above 0
};
// Groups of channels: the first is in every file, of the others all are there or none.
enum class ChannelGroup { sums, scattering, dispersion, rims };
constexpr ChannelGroup kChannelGroups[] = {ChannelGroup::sums, ChannelGroup::scattering, ChannelGroup::dispersion,
                                           ChannelGroup::rims};
const std::vector<PlaneChannel>& channelsOf(ChannelGroup group, bool published);  // empty: the tier has none

}  // namespace pellucid
