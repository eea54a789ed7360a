#include "composite/cli/stochastic_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "composite/cli/number_checks.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {

using Variant = StochasticSettings::Variant;

namespace {

constexpr int kDefaultSamples = 64;

}  // namespace

std::optional<Variant> stochasticVariant(const std::string& method) {
  if (method == "stochastic" || method == "stochastic:depth") return Variant::depth;
  if (method == "stochastic:basic") return Variant::basic;
  if (method == "stochastic:alpha") return Variant::alpha;
  return std::nullopt;
}

void StochasticFlags::addTo(CLI::App& verb) {
  samplesOption_ = verb.add_option("--samples", samples,
                                   fmt::format("Of --method stochastic: samples S of a pixel, in all --aa passes "
                                               "together; without it the first multiple of --aa from {}",
                                               kDefaultSamples))
                       ->check(CLI::Range(1, StochasticSettings::kMostSamples));
  adaptiveOption_ =
      verb.add_option("--samples-adaptive", adaptive,
                      "Of --method stochastic: more sets of --samples where they are needed, until the standard "
                      "error of a pixel's layers is E times the larger of 1 and their light")
          ->check(CLI::Range(1e-6, 1.0))
          ->check(isNumber());
  seedOption_ =
      verb.add_option("--seed", seed, "Of --method stochastic and --shadows stochastic: another seed, other noise")
          ->check(notBelowZero())
          ->capture_default_str();
  noiseOption_ = verb.add_option("--noise", noise,
                                 "Of --method stochastic: where noise stays from frame to frame; on object it moves, "
                                 "turns and bends with the triangles, on screen it belongs to pixels")
                     ->check(CLI::IsMember({"screen", "object"}))
                     ->capture_default_str();
  masksOption_ = verb.add_option("--masks", masks, "Of --method stochastic: naive flips a coin per sample")
                     ->check(CLI::IsMember({"stratified", "naive"}))
                     ->capture_default_str();
  correctionOption_ = verb.add_option("--correction", correction,
                                      "Of --method stochastic:depth: scale to the exact net opacity; off is unbiased")
                          ->check(CLI::IsMember({"on", "off"}))
                          ->capture_default_str();
  sampledOption_ =
      verb.add_option("--sampled-on", sampledOn,
                      "Of --method stochastic: the CPU samples lists of every fragment, gl draws the samples "
                      "in two passes, three but for stochastic:depth; the same picture but for rounding")
          ->check(CLI::IsMember({"cpu", "gl"}))
          ->capture_default_str();
}

void StochasticFlags::expectRead(const std::vector<std::string>& methods, const char* verbFlag,
                                 const ShadowRequest& shadows) const {
  std::vector<Variant> variants;
  for (const std::string& method : methods)
    if (const std::optional<Variant> variant = stochasticVariant(method)) variants.push_back(*variant);
  for (const CLI::Option* option :
       {samplesOption_, adaptiveOption_, seedOption_, noiseOption_, masksOption_, correctionOption_, sampledOption_})
    if (variants.empty() && option && option->count() > 0 && !(shadows.byMaps() && option == seedOption_))
      throw UsageError(fmt::format("{}: {} {} draws no random numbers, expected {}", option->get_name(), verbFlag,
                                   fmt::join(methods, ","), kStochasticNames));
  const bool corrects = std::find(variants.begin(), variants.end(), Variant::depth) != variants.end();
  if (correctionOption_ && correctionOption_->count() > 0 && !corrects)
    throw UsageError(fmt::format("--correction: {} {} is {} corrected, expected stochastic:depth", verbFlag,
                                 fmt::join(methods, ","), variants[0] == Variant::alpha ? "always" : "never"));
}

void StochasticFlags::into(Request& request) const {
  request.shadows.seed = static_cast<std::uint32_t>(seed);
  if (const std::optional<Variant> variant = stochasticVariant(request.method))
    request.paint = PaintSamples{settings(*variant, request.passes), sampledOn == "gl"};
}

StochasticSettings StochasticFlags::settings(Variant variant, int passes) const {
  StochasticSettings settings;
  settings.variant = variant;
  settings.corrected = correction == "on";
  settings.stratified = masks == "stratified";
  settings.adaptive = adaptive;
  settings.onObjects = noise == "object";
  settings.seed = static_cast<std::uint32_t>(seed);
  const bool given = samplesOption_ && samplesOption_->count() > 0;
  settings.samples = given ? samples : (std::max(kDefaultSamples, passes) + passes - 1) / passes * passes;
  return settings;
}

}  // namespace pellucid::cli
