#include "composite/pipeline/drawn_probes.h"

#include <algorithm>
#include <cmath>

#include "composite/over.h"
#include "composite/pipeline/low_layers.h"
#include "composite/pipeline/sums.h"
#include "composite/resolve.h"

namespace pellucid {
namespace {

// Some thousand probes fix a mean error to about a percent; of layers at low resolution, which are drawn for every try,
// fewer passes have to do.
constexpr std::size_t kProbes = 16384;
constexpr int kMostPasses = 4, kMostLowPasses = 2;

int passesProbed(const Plan& plan) {
  return std::min(plan.passes, plan.lowResolution > 1 ? kMostLowPasses : kMostPasses);
}

std::size_t probesOf(const Plan& plan) {
  return passesProbed(plan) == 1 ? kProbes : 2 * kProbes / static_cast<std::size_t>(passesProbed(plan));
}

// The method that mixes a plan's lists, or whose error a plan's certificate bounds.
ChosenMethod methodOf(const Plan& plan) {
  if (const auto* listed = plan.as<PaintListed>()) return listed->method;
  if (const auto* systems = plan.as<PaintSystems>(); systems && systems->method) return *systems->method;
  return *chooseMethod("weighted");
}

// Texels of low resolution by that method; by default sorted.
class TexelMixer : public Mixer {
 public:
  explicit TexelMixer(const std::optional<ChosenMethod>& method) : method_(method) {}
  void mix(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override {
    if (method_)
      compositeBy(*method_, {0, mixed.sample.weight, mixed.sample.normalisation}, lists, mixed.data, veil);
    else
      compositeSorted(lists, mixed.data, veil);
  }
  void mixTexels(const Mixed& mixed, const FragmentLists& lists, Veil& veil) override { mix(mixed, lists, veil); }

 private:
  std::optional<ChosenMethod> method_;
};

}  // namespace

DrawnProbes::DrawnProbes(const PaintContext& context, const PassSettings& sample)
    : context_(context), grid_(context.picture.gbuffer->data, probesOf(context.plan)) {
  const int probed = passesProbed(context.plan);
  for (int i = 0; i < probed; ++i) passes_.push_back(passOf(sample, i * context.plan.passes / probed));
}

DrawnProbes::Pass DrawnProbes::passOf(const PassSettings& sample, int number) {
  const GBuffer& gbuffer = *context_.picture.gbuffer;
  Pass pass;
  pass.sample = samplePass(sample, context_.plan, number);
  pass.number = number;
  pass.drawn = listed(pass.sample, VolumeRule::midDepth);
  pass.truth = truthOf(pass);
  if (passes_.empty()) depths_ = depthsIn(pass);
  const Fog* fog = pass.sample.fog.get();
  if (fog && ofSums())
    pass.fog.emplace(*fog, gbuffer, pass.sample.sample, grid_.places(), pass.drawn.solid);
  else if (fog)
    pass.drawn = withFog(*fog, gbuffer, pass.sample.sample, pass.drawn, grid_.places());
  if (hasLow() && ofSums())
    pass.view =
        lowViewOf(gbuffer, solidsOf(*context_.sources.triangles(), fullResolutionPart(context_.plan, pass.sample)),
                  context_.shot.camera, context_.plan.lowResolution);
  return pass;
}

FragmentLists DrawnProbes::listed(const PassSettings& sample, VolumeRule rule) const {
  PassSettings probed = fullResolutionPart(context_.plan, sample);
  probed.probeCell = grid_.cell();
  probed.fog = nullptr;  // the probes alone are marched
  ProbeLists lists(grid_);
  context_.sources.each({probed, context_.picture, rule}, [&](const FragmentLists& part) { lists.add(part); });
  return lists.finish();
}

std::vector<glm::dvec3> DrawnProbes::truthOf(const Pass& pass) const {
  FragmentLists lists = context_.plan.deepFiles ? listed(pass.sample, VolumeRule::split) : pass.drawn;
  if (pass.sample.fog)
    lists = withFog(*pass.sample.fog, *context_.picture.gbuffer, pass.sample.sample, lists, grid_.places());
  if (hasLow()) {
    PassStatistics unused;
    TexelMixer sorted(std::nullopt);
    lists = lowLayersOf(context_, pass.sample, pass.number, sorted, unused).among(lists, grid_.places());
  }
  Veil veil(lists.window.width(), lists.window.height());
  compositeSorted(lists, lists.window, veil);
  return shown(veil);
}

Veil DrawnProbes::veilOf(const Pass& pass, const shading::WeightSettings& weight) const {
  PassSettings sample = pass.sample;
  sample.weight = weight;
  return ofSums() ? veilOfSums(pass, sample) : veilOfLists(pass, sample);
}

Veil DrawnProbes::veilOfSums(const Pass& pass, const PassSettings& sample) const {
  const Window window = grid_.window();
  PublishedClamps unused;
  OitPlanes planes = emptySums(context_.plan, sample, window, window);
  foldInto(context_.plan, pass.drawn, sample, planes, unused);
  if (pass.view)
    addLowResolution(lowSums(context_, *pass.view, sample), *pass.view, sample.sample, grid_.places(), planes, unused);
  if (pass.fog) pass.fog->addTo(planes, unused);
  return resolve(planes, context_.plan.resolve);
}

Veil DrawnProbes::veilOfLists(const Pass& pass, const PassSettings& sample) const {
  const ChosenMethod method = methodOf(context_.plan);
  FragmentLists lists;
  if (hasLow()) {
    PassStatistics unused;
    TexelMixer mixer(method);
    lists = lowLayersOf(context_, sample, pass.number, mixer, unused).among(pass.drawn, grid_.places());
  }
  const FragmentLists& mixed = hasLow() ? lists : pass.drawn;
  Veil veil(mixed.window.width(), mixed.window.height());
  compositeBy(method, {0, sample.weight, sample.normalisation}, mixed, mixed.window, veil);
  return veil;
}

std::vector<glm::dvec3> DrawnProbes::shown(const Veil& veil) const {
  std::vector<glm::dvec3> pictures;
  for (std::size_t i = 0; i < count(); ++i) {
    const glm::dvec3 behind(context_.picture.gbuffer->beauty.at(grid_.places()[i].x, grid_.places()[i].y));
    pictures.push_back(veil.touched[i] ? glm::dvec3(veil.light[i]) + glm::dvec3(veil.transmission[i]) * behind
                                       : behind);
  }
  return pictures;
}

double DrawnProbes::errorOf(const shading::WeightSettings& weight, std::size_t passes) const {
  std::vector<glm::dvec3> difference(count(), glm::dvec3(0.0));
  for (std::size_t k = 0; k < passes; ++k) {
    const std::vector<glm::dvec3> got = shown(veilOf(passes_[k], weight));
    for (std::size_t i = 0; i < count(); ++i) difference[i] += got[i] - passes_[k].truth[i];
  }
  double sum = 0.0;
  std::size_t known = 0;
  for (const glm::dvec3& d : difference) {
    const double size = std::abs(d.r) + std::abs(d.g) + std::abs(d.b);
    if (!std::isfinite(size)) continue;  // of a background that is not
    sum += size;
    ++known;
  }
  return sum / (3.0 * static_cast<double>(std::max<std::size_t>(known, 1) * passes));
}

WeighedDepths DrawnProbes::depthsIn(const Pass& pass) const {
  const WeighedDepths found = depthsOf(pass.drawn);
  if (found.nearest > 0.0f) return found;
  // Layers of low resolution alone: powers weigh 1 where they begin.
  const float reference = pass.sample.weight.reference;
  return {reference, 2.0f * reference, 4.0f * reference};
}

}  // namespace pellucid
