#include "composite/cli/scatter_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

float positive(const std::string& text, const std::string& flag, const std::string& form, bool zero = false) {
  double value = 0;
  const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = error == std::errc() && next == text.data() + text.size() && std::isfinite(value) && value < 1e30 &&
                    (zero ? value >= 0 : value > 0);
  if (!good) throw UsageError(fmt::format("{}: found '{}', expected {}", flag, text, form));
  return static_cast<float>(value);
}

}  // namespace

void LookupFlags::addTo(CLI::App& verb) {
  verb.add_option("--diffusion-kernel", kernel, "Shape of the spread: gaussian, or the published disc of 16 px at most")
      ->check(CLI::IsMember({"gaussian", "disc"}))
      ->capture_default_str();
  verb.add_option("--gather", gather, "exact takes every tap of the spread: slow where it is wide")
      ->check(CLI::IsMember({"fast", "exact"}))
      ->capture_default_str();
}

void LookupFlags::addResolverTo(CLI::App& verb) {
  verb.add_option("--resolve", resolver, "What resolves the sums: cpu, or gl as an engine would")
      ->check(CLI::IsMember({"cpu", "gl"}))
      ->capture_default_str();
}

LookupSettings LookupFlags::settings() const {
  LookupSettings settings;
  settings.kernel = kernel == "disc" ? shading::PLD_DIFFUSE_DISC : shading::PLD_DIFFUSE_GAUSSIAN;
  settings.exact = gather == "exact";
  return settings;
}

void LookupFlags::into(Request& request) const {
  request.lookup = settings();
  request.resolveOnDevice = onDevice();
}

void SelfModulationFlag::addTo(CLI::App& verb) {
  option = verb.add_flag("--self-modulation,!--no-self-modulation", asked,
                         "PT17 eq. 14, a heuristic for --normalisation published; on with --precision published");
}

void ScatterFlags::addTo(CLI::App& verb) {
  verb.add_option("--refract", refract,
                  "Where refracted rays meet the background: fixed:METRES, depth, thickness or off")
      ->capture_default_str();
  verb.add_option("--dispersion", dispersion, "on: materials that disperse bend each channel by its own index")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  verb.add_option("--diffusion", diffusion, "What a layer's spread is proportional to; netCoverage loses clear glass")
      ->check(CLI::IsMember({"coverage", "netCoverage", "off"}))
      ->capture_default_str();
  verb.add_option("--diffusion-scale", diffusionScale, "K0:K1 in metres: size of the spread, and the distance of half")
      ->capture_default_str();
  verb.add_flag("--no-prune", noPrune, "Run the full model, also what no material of the scene needs: for tests");
}

void ScatterFlags::into(Request& request) const {
  ScatterSettings& scatter = request.scatter;
  const std::string form = "fixed:METRES, depth, thickness or off", fixed = "fixed:";
  if (refract.rfind(fixed, 0) == 0) {
    scatter.refract = shading::PLD_REFRACT_FIXED;
    scatter.refractDistance = positive(refract.substr(fixed.size()), "--refract", form);
  } else if (refract == "depth" || refract == "thickness" || refract == "off") {
    scatter.refract = refract == "depth"       ? shading::PLD_REFRACT_DEPTH
                      : refract == "thickness" ? shading::PLD_REFRACT_THICKNESS
                                               : shading::PLD_REFRACT_OFF;
  } else {
    throw UsageError(fmt::format("--refract: found '{}', expected {}", refract, form));
  }
  const auto colon = diffusionScale.find(':');
  const std::string pair = "K0:K1 in metres";
  if (colon == std::string::npos)
    throw UsageError(fmt::format("--diffusion-scale: found '{}', expected {}", diffusionScale, pair));
  scatter.k0 = positive(diffusionScale.substr(0, colon), "--diffusion-scale", pair);
  scatter.k1 = positive(diffusionScale.substr(colon + 1), "--diffusion-scale", pair);
  if (diffusion == "off") scatter.k0 = 0.0f;
  scatter.netCoverage = diffusion == "netCoverage";
  scatter.dispersion = dispersion == "on";
  scatter.prune = !noPrune;
}

}  // namespace pellucid::cli
