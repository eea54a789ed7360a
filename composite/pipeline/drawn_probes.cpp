#include "composite/pipeline/drawn_probes.h"

#include <algorithm>
#include <cmath>

#include "composite/list_order.h"
#include "composite/over.h"
#include "composite/pipeline/low_layers.h"
#include "composite/pipeline/sums.h"
#include "composite/resolve.h"
#include "gbuffer/finite_colour.h"

namespace pellucid {
namespace {

// Some thousand probes with layers fix a mean error to about a percent; of layers at low resolution, which are drawn
// for every try, fewer passes have to do.
constexpr std::size_t kProbes = 16384;
constexpr int kMostPasses = 4, kMostLowPasses = 2;

int passesProbed(const Plan& plan) {
  return std::min(plan.passes, plan.lowResolution > 1 ? kMostLowPasses : kMostPasses);
}

std::size_t probesOf(const Plan& plan) {
  const std::size_t probes = plan.fog ? kProbes / 4 : kProbes;
  return passesProbed(plan) == 1 ? probes : 2 * probes / static_cast<std::size_t>(passesProbed(plan));
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
  bool cutsTexels() const override { return !method_; }

 private:
  std::optional<ChosenMethod> method_;
};

// How far off a weight is whose sums overflow where the truth does not: farther than any that does not.
constexpr double kOverflow = 1e200;

// Over the channels, too, and without what a background that is not finite makes.
double meanSize(const std::vector<glm::dvec3>& colours) {
  double sum = 0.0;
  std::size_t known = 0;
  for (const glm::dvec3& colour : colours) {
    const double size = std::abs(colour.r) + std::abs(colour.g) + std::abs(colour.b);
    if (!std::isfinite(size)) continue;
    sum += size;
    ++known;
  }
  return sum / (3.0 * static_cast<double>(std::max<std::size_t>(known, 1)));
}

}  // namespace

DrawnProbes::DrawnProbes(const PaintContext& context, PassPicture& moving, const PassSettings& sample)
    : context_(context), moving_(moving), grid_(context.picture.gbuffer->data, probesOf(context.plan)) {
  std::vector<Gathered> all;
  const int probed = placeProbes(sample, all);
  for (int i = static_cast<int>(all.size()); i < probed; ++i)
    all.push_back(gathered(sample, i * context.plan.passes / probed));
  if (!touchesAll()) {
    std::vector<std::uint8_t> kept(count(), 0);
    for (const Gathered& pass : all) pass.drawn.mark(kept);
    grid_.keep(kept);
    for (Gathered& pass : all) {
      pass.drawn.keep(kept);
      if (pass.split) pass.split->keep(kept);
    }
  }
  for (const Gathered& pass : all) passes_.push_back(passOf(pass));
}

// Closer together where layers touch few of the pixels, so that as many probes have something to tell; where even all
// of those pixels are few, more of the passes are probed: highlights of one pass can be most of an error.
int DrawnProbes::placeProbes(const PassSettings& sample, std::vector<Gathered>& known) {
  const int least = passesProbed(context_.plan);
  if (touchesAll()) return least;
  Gathered first = gathered(sample, 0);
  std::vector<std::uint8_t> touched(count(), 0);
  first.drawn.mark(touched);
  const auto found = std::max<std::size_t>(static_cast<std::size_t>(std::count(touched.begin(), touched.end(), 1)), 1);
  const std::size_t wanted = probesOf(context_.plan) * count() / found, pixels = context_.picture.gbuffer->viewZ.size();
  std::size_t expected = found;
  if (grid_.cell() > 1 && wanted > 2 * probesOf(context_.plan)) {
    const std::size_t before = count();
    grid_ = ProbeGrid(context_.picture.gbuffer->data, std::min(wanted, pixels));
    expected = std::max<std::size_t>(found * count() / before, 1);
  } else {
    known.push_back(std::move(first));
  }
  return static_cast<int>(std::clamp<std::size_t>(2 * kProbes / expected, static_cast<std::size_t>(least),
                                                  static_cast<std::size_t>(context_.plan.passes)));
}

DrawnProbes::Gathered DrawnProbes::gathered(const PassSettings& sample, int number) {
  const PassSettings own = samplePass(sample, context_.plan, number);
  moving_.moveTo(own.sample, number);
  Gathered made{own, number, listed(own, VolumeRule::midDepth), std::nullopt};
  if (context_.plan.deepFiles) made.split.emplace(listed(own, VolumeRule::split));
  return made;
}

DrawnProbes::Pass DrawnProbes::passOf(const Gathered& from) {
  const GBuffer& gbuffer = *context_.picture.gbuffer;
  moving_.moveTo(from.sample.sample, from.number);
  Pass pass;
  pass.sample = from.sample;
  pass.number = from.number;
  for (const glm::ivec2& place : grid_.places())
    pass.weight.push_back(context_.picture.passWeight ? context_.picture.passWeight->at(place.x, place.y) : 1.0f);
  pass.drawn = from.drawn.finish();
  orderByDepthAndBits(pass.drawn);  // so that no order of submission chooses a weight
  pass.truth = truthOf(from, pass);
  if (passes_.empty()) depths_ = depthsIn(pass);
  const Fog* fog = pass.sample.fog.get();
  if (fog && ofSums())
    pass.fog.emplace(*fog, gbuffer, pass.sample.sample, grid_.places(), pass.drawn.solid);
  else if (fog && !hasLow())
    pass.drawn = withFog(*fog, gbuffer, pass.sample.sample, pass.drawn, grid_.places());
  if (hasLow() && ofSums()) listLow(pass);
  return pass;
}

ProbeLists DrawnProbes::listed(const PassSettings& sample, VolumeRule rule) const {
  PassSettings probed = fullResolutionPart(context_.plan, sample);
  probed.probeCell = grid_.cell();
  probed.fog = nullptr;  // the probes alone are marched
  ProbeLists lists(grid_);
  context_.sources.each({probed, context_.picture, rule}, [&](const FragmentLists& part) { lists.add(part); });
  return lists;
}

void DrawnProbes::listLow(Pass& pass) const {
  const GBuffer& gbuffer = *context_.picture.gbuffer;
  TransparentPass& triangles = *context_.sources.triangles();
  pass.view = lowViewOf(gbuffer, opaqueDepth(triangles, fullResolutionPart(context_.plan, pass.sample), gbuffer),
                        context_.shot.camera, context_.plan.lowResolution, context_.picture.planes);
  const DrawnOver over(triangles, *pass.view, gbuffer, context_.shot.camera);
  triangles.fragments(lowResolutionPart(pass.sample), [&](const FragmentLists& lists) {
    pass.low.push_back(lists);
    orderByDepthAndBits(pass.low.back());
  });
}

// What lowSums() draws, from the lists.
OitPlanes DrawnProbes::lowSumsOf(const Pass& pass, const PassSettings& sample) const {
  Plan floats = context_.plan;
  PassSettings part = sample;
  if (floats.isPublished()) {
    floats.tier = Tier::float32;
    part.normalisation = shading::PLD_NORMALISE_SPECTRAL;
  }
  PublishedClamps unused;
  OitPlanes planes = emptySums(floats, part, pass.view->gbuffer.display, pass.view->gbuffer.data);
  for (const FragmentLists& lists : pass.low) foldInto(floats, lists, part, planes, unused);
  return planes;
}

std::vector<glm::dvec3> DrawnProbes::truthOf(const Gathered& from, const Pass& pass) const {
  FragmentLists lists = from.split ? from.split->finish() : pass.drawn;
  if (hasLow()) {
    PassStatistics unused;
    TexelMixer sorted(std::nullopt);
    lists = lowLayersOf(context_, pass.sample, pass.number, sorted, unused).among(lists, grid_.places());
  }
  if (pass.sample.fog)
    lists = withFog(*pass.sample.fog, *context_.picture.gbuffer, pass.sample.sample, lists, grid_.places());
  Veil veil(lists.window.width(), lists.window.height());
  compositeSorted(lists, lists.window, veil);
  return shown(veil);
}

Veil DrawnProbes::veilOf(const Pass& pass, const shading::WeightSettings& weight) {
  PassSettings sample = pass.sample;
  sample.weight = weight;
  return ofSums() ? veilOfSums(pass, sample) : veilOfLists(pass, sample);
}

Veil DrawnProbes::veilOfSums(const Pass& pass, const PassSettings& sample) const {
  const Window window = grid_.window();
  PublishedClamps unused;
  OitPlanes planes = emptySums(context_.plan, sample, window, window);
  foldInto(context_.plan, pass.drawn, sample, planes, unused);
  if (pass.view) addLowResolution(lowSumsOf(pass, sample), *pass.view, sample.sample, grid_.places(), planes, unused);
  if (pass.fog) pass.fog->addTo(planes, unused);
  return resolve(planes, context_.plan.resolve);
}

Veil DrawnProbes::veilOfLists(const Pass& pass, const PassSettings& sample) {
  const ChosenMethod method = methodOf(context_.plan);
  FragmentLists lists;
  if (hasLow()) {
    moving_.moveTo(sample.sample, pass.number);
    PassStatistics unused;
    TexelMixer mixer(method);
    lists = lowLayersOf(context_, sample, pass.number, mixer, unused).among(pass.drawn, grid_.places());
    if (sample.fog)  // cut by them, too
      lists = withFog(*sample.fog, *context_.picture.gbuffer, sample.sample, lists, grid_.places());
  }
  const FragmentLists& mixed = hasLow() ? lists : pass.drawn;
  Veil veil(mixed.window.width(), mixed.window.height());
  compositeBy(method, {0, sample.weight, sample.normalisation}, mixed, mixed.window, veil);
  return veil;
}

std::vector<glm::dvec3> DrawnProbes::shown(const Veil& veil) const {
  std::vector<glm::dvec3> pictures;
  for (std::size_t i = 0; i < count(); ++i) {
    const glm::dvec3 behind(context_.picture.centres->beauty.at(grid_.places()[i].x, grid_.places()[i].y));
    pictures.push_back(veil.touched[i] ? glm::dvec3(veil.light[i]) + glm::dvec3(veil.transmission[i]) * behind
                                       : behind);
  }
  return pictures;
}

std::vector<glm::dvec3> DrawnProbes::differences(const shading::WeightSettings& weight, std::size_t passes) {
  std::vector<glm::dvec3> difference(count(), glm::dvec3(0.0));
  for (std::size_t k = 0; k < passes; ++k) {
    const std::vector<glm::dvec3> got = shown(veilOf(passes_[k], weight));
    for (std::size_t i = 0; i < count(); ++i) {
      const glm::dvec3 off = got[i] - passes_[k].truth[i];
      const bool overflows = !isFinite(off) && isFinite(passes_[k].truth[i]);
      difference[i] += static_cast<double>(passes_[k].weight[i]) * (overflows ? glm::dvec3(kOverflow) : off);
    }
  }
  return difference;
}

double DrawnProbes::errorOf(const shading::WeightSettings& weight, std::size_t passes) {
  return meanSize(differences(weight, passes)) / static_cast<double>(passes);
}

double DrawnProbes::brokenPart(const shading::WeightSettings& weight, double tolerance) {
  const auto passes = static_cast<double>(passes_.size());
  const std::vector<glm::dvec3> difference = differences(weight, passes_.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < count(); ++i)
    for (int c = 0; c < 3; ++c) {
      double truth = 0.0;
      for (const Pass& pass : passes_) truth += static_cast<double>(pass.weight[i]) * pass.truth[i][c];
      const double promised = tolerance * std::max(1.0, std::abs(truth) / passes);
      const double off = std::abs(difference[i][c]) / passes;
      if (std::isfinite(off) && off > 0.0) largest = std::max(largest, off / promised);
    }
  return largest;
}

double DrawnProbes::layers() const {
  const double cell = grid_.cell(), pixels = static_cast<double>(context_.picture.gbuffer->viewZ.size());
  return static_cast<double>(passes_[0].drawn.fragments.size()) * cell * cell / pixels;
}

double DrawnProbes::rounding() const {
  constexpr double kOfFloats = 0x1p-23;
  return kOfFloats * meanSize(passes_[0].truth);
}

WeighedDepths DrawnProbes::depthsIn(const Pass& pass) const {
  if (count() == 0) return {};
  const WeighedDepths found = depthsOf(pass.drawn);
  if (found.nearest > 0.0f) return found;
  // Layers of low resolution alone: powers weigh 1 where they begin.
  const float reference = pass.sample.weight.reference;
  return {reference, 2.0f * reference, 4.0f * reference};
}

}  // namespace pellucid
