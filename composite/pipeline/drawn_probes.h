// Probe pixels of the picture that a plan draws, with one weight after another, and the truth of them.
#pragma once
#include <optional>
#include <vector>

#include "composite/fog.h"
#include "composite/low_resolution.h"
#include "composite/pipeline/painter.h"
#include "composite/pipeline/pass_picture.h"
#include "composite/probe_lists.h"
#include "composite/study/fit_weight.h"

namespace pellucid {

// What is drawn is what is probed: fog as the plan's sums or lists have it, layers at low resolution, the tier's
// numbers, and the mean of jittered passes with their footprint, each over the depth that it meets and, at edges of the
// picture, with the weight that it has there. Only --systems is probed as one system, and a deep picture as the flat
// one that it makes.
class DrawnProbes {
 public:
  //   moving  the picture of `context`, which is moved from pass to pass
  //   sample  with the light
  DrawnProbes(const PaintContext& context, PassPicture& moving, const PassSettings& sample);
  std::size_t count() const { return grid_.places().size(); }
  WeighedDepths depths() const { return depths_; }
  // Mean error of the plan's picture, over the probes and channels.
  double error(const shading::WeightSettings& weight) { return errorOf(weight, passes_.size()); }
  // The same of the first pass alone.
  double roughError(const shading::WeightSettings& weight) { return errorOf(weight, 1); }
  // What floats round by, in the mean.
  double rounding() const;
  // Layers in the mean of all pixels of the picture, those without any among them; of the first pass, without fog and
  // low resolution.
  double layers() const;
  // Largest error of a probe, as a part of what a tolerance promises of it.
  double brokenPart(const shading::WeightSettings& weight, double tolerance);

 private:
  struct Pass {
    PassSettings sample;
    int number;                      // among the plan's passes
    std::vector<float> weight;       // of the probes in the mean of all passes, 1 but at edges
    FragmentLists drawn;             // what is weighed; of lists, with the fog between them
    std::optional<MarchedFog> fog;   // of sums
    std::optional<LowView> view;     // of sums
    std::vector<FragmentLists> low;  // of the view: listed once, for one weight after another
    std::vector<glm::dvec3> truth;   // picture of the probes
  };
  // Lists of the probes of a pass: as they are weighed, and as the truth has them where that differs.
  struct Gathered {
    PassSettings sample;
    int number;
    ProbeLists drawn;
    std::optional<ProbeLists> split;
  };
  // The number of passes that are probed.
  //   known  is given the first of them where the probes stay where they were gathered
  int placeProbes(const PassSettings& sample, std::vector<Gathered>& known);
  Gathered gathered(const PassSettings& sample, int number);
  Pass passOf(const Gathered& from);
  ProbeLists listed(const PassSettings& sample, VolumeRule rule) const;
  void listLow(Pass& pass) const;
  OitPlanes lowSumsOf(const Pass& pass, const PassSettings& sample) const;
  WeighedDepths depthsIn(const Pass& pass) const;
  std::vector<glm::dvec3> truthOf(const Gathered& from, const Pass& pass) const;
  Veil veilOf(const Pass& pass, const shading::WeightSettings& weight);
  Veil veilOfSums(const Pass& pass, const PassSettings& sample) const;
  Veil veilOfLists(const Pass& pass, const PassSettings& sample);
  std::vector<glm::dvec3> shown(const Veil& veil) const;
  // The picture less the truth, added over passes.
  std::vector<glm::dvec3> differences(const shading::WeightSettings& weight, std::size_t passes);
  double errorOf(const shading::WeightSettings& weight, std::size_t passes);
  bool ofSums() const { return context_.plan.as<PaintSums>() != nullptr; }
  bool hasLow() const { return context_.plan.lowResolution > 1; }
  bool touchesAll() const { return context_.plan.fog || hasLow(); }

  PaintContext context_;
  PassPicture& moving_;
  ProbeGrid grid_;
  WeighedDepths depths_;  // of the first pass
  std::vector<Pass> passes_;
};

}  // namespace pellucid
