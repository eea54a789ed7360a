// Stochastic transparency (Enderton et al. 2010, ST10): every fragment hides a random share o of a pixel's samples, and
// the nearest of each sample wins. Right on the average in any order; the rest is noise, which S samples push down.
#pragma once
#include <atomic>
#include <memory>
#include <vector>

#include "composite/deep/deep_opaque.h"
#include "composite/methods/method.h"
#include "gbuffer/mask_table.h"
#include "gbuffer/stochastic_planes.h"

namespace pellucid {

struct StochasticSettings {
  enum class Variant {
    basic,  // section 3.1: colours of the winners; the background shows where a sample is empty
    alpha,  // section 3.3: the same, scaled to the exact net opacity over the exactly dimmed background
    depth,  // section 3.4: every fragment by its opacity and the share of samples that it is visible in
  };
  Variant variant = Variant::depth;
  bool corrected = true;   // of depth: scaled to the exact net opacity. basic never is, alpha always
  bool stratified = true;  // masks; otherwise a coin per sample
  int samples = 64;        // S of a pixel, in all passes together, [1, kMostSamples]
  std::uint32_t seed = 0;
  // Identities hold where they are, as PassSettings::pieces makes them: noise moves with its object. Else the pixel is
  // part of a layer's random numbers.
  bool onObjects = false;
  // Above 0: a pixel takes more sets of S samples, each with masks of its own, until the standard error of its layers'
  // light is this part of the larger of 1 and the light, or it holds kMostSamples. Of fragment lists alone.
  double adaptive = 0.0;

  static constexpr int kMostSamples = 4096;
};

bool isCorrected(const StochasticSettings& settings);  // its sums are scaled to the exact net opacity
// Of sums a pixel, as a rasteriser keeps them: a depth per sample and channel, and the planes that are divided.
int stochasticBits(const StochasticSettings& settings);
int stochasticPasses(const StochasticSettings& settings);  // of geometry

// What samples of one pixel add up to: averages over its samples, before ST10's division.
struct StochasticSums {
  glm::dvec3 light{0.0};  // F(B), or F(U): premultiplied radiance
  glm::dvec3 unit{0.0};   // F(B1), or F(U1): the same of white layers
  glm::dvec3 added{0.0};  // light of layers that hide nothing: by visibility under every variant, never scaled
  glm::dvec3 empty{1.0};  // share of samples that no fragment covers
  glm::dvec3 beta{1.0};   // exact net transmission
};

struct StochasticShare {
  int first = 0, step = 1;  // this pass holds the pixel's samples first, first + step, ...
};

// Samples one pixel. `layers` are sorted here, by depth and then identity: their order does not matter. No two may have
// one identity: they would share their mask.
//   pixel  display coordinates
StochasticSums samplePixel(std::vector<MethodLayer>& layers, glm::ivec2 pixel, const StochasticSettings& settings,
                           const MaskTable& masks, const StochasticShare& share);

// Averages sets of samples until the standard error is low, as StochasticSettings::adaptive says.
//   taken   how many sets
StochasticSums samplePixelAdaptively(std::vector<MethodLayer>& layers, glm::ivec2 pixel,
                                     const StochasticSettings& settings, const MaskTable& masks,
                                     const StochasticShare& share, int& taken);

// ST10 sections 3.3, 3.4 and 4: the layers' light after correction.
//   hidden  exact net opacity 1 - beta, filtered over the pixel's passes
glm::dvec3 stochasticLight(const StochasticSums& sums, const glm::dvec3& hidden, const StochasticSettings& settings);

// N jittered passes of one picture (ST10 section 3.5): masks are stratified across all of them, sums are filtered
// before the division, and the background is dimmed pass by pass.
class StochasticMean {
 public:
  StochasticMean(int width, int height, const StochasticSettings& settings, int passes);
  // For a deep picture, each of whose places holds layers out on its own: see composite/deep/deep_opaque.h.
  StochasticMean(const DeepOpaque& opaque, const StochasticSettings& settings, int passes);
  // Adds pass `pass`. Writes transmission, solids, front depth and touched of the lists' window to `veil`, whose light
  // still lacks the layers'.
  //   weights  of the pass in each pixel's mean, 1 for an equal one; null: equal everywhere
  void add(int pass, const FragmentLists& lists, const Window& data, Veil& veil, const Image<float>* weights = nullptr);
  // The same of the row of a deep picture; `veil` is the row's. Samples of a pixel share their masks.
  void add(int pass, const HeldOutRow& row, Veil& veil);
  // The same, sampled already.
  void add(const StochasticPlanes& planes, Veil& veil, const Image<float>* weights = nullptr);
  // Adds the layers' light to the mean of those veils.
  void finish(Veil& mean) const;
  // Samples of all pixels of lists that hold a layer, and those pixels, of all passes.
  std::uint64_t samplesTaken() const { return samplesTaken_; }
  std::uint64_t pixelsSampled() const { return pixelsSampled_; }

 private:
  bool exactBackground() const;
  StochasticSums sampled(int pass, glm::ivec2 pixel, std::vector<MethodLayer>& layers);
  //   place   in the sums of all passes
  //   at      in the veil
  void put(std::size_t place, const StochasticSums& sums, const glm::vec4& solid, float frontZ, float weight,
           std::size_t at, Veil& veil);

  StochasticSettings settings_;
  int passes_;
  std::shared_ptr<const MaskTable> masks_;
  const DeepOpaque* opaque_ = nullptr;  // of a deep picture
  Image<glm::vec3> light_, unit_, added_, hidden_;
  std::atomic<std::uint64_t> samplesTaken_ = 0, pixelsSampled_ = 0;
};

}  // namespace pellucid
