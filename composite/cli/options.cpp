#include "composite/cli/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "composite/cli/budget.h"
#include "engine_bridge/scene/set_keys.h"
#include "gbuffer/errors.h"
#include "gbuffer/tiers.h"
#include "gbuffer/weight_text.h"

namespace pellucid::cli {
namespace {

std::vector<double> parseNumbers(const std::string& text, char separator, std::size_t count, const std::string& flag,
                                 const std::string& form) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* end = text.data() + text.size();
  while (at <= end) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) break;
    numbers.push_back(value);
    if (next == end && numbers.size() == count) return numbers;
    if (next == end || *next != separator) break;
    at = next + 1;
  }
  throw UsageError(fmt::format("{}: found '{}', expected {}", flag, text, form));
}

SubmissionOrder parseOrder(const std::string& text) {
  SubmissionOrder order;
  if (text == "file") return order;
  if (text == "reverse") {
    order.kind = SubmissionOrder::reverse;
    return order;
  }
  const std::string key = "shuffle:";
  if (text.rfind(key, 0) == 0 && text.size() > key.size()) {
    order.kind = SubmissionOrder::shuffle;
    const auto [next, error] = std::from_chars(text.data() + key.size(), text.data() + text.size(), order.seed);
    if (error == std::errc() && next == text.data() + text.size()) return order;
  }
  throw UsageError(fmt::format("--order: found '{}', expected file, reverse or shuffle:SEED", text));
}

}  // namespace

std::size_t parseBytes(const std::string& text, const std::string& flag) {
  std::size_t value = 0;
  const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(next, text.data() + text.size());
  const int shift = unit.empty() ? 0 : unit == "K" ? 10 : unit == "M" ? 20 : unit == "G" ? 30 : -1;
  if (error != std::errc() || shift < 0 || value == 0 || value > (SIZE_MAX >> shift))
    throw UsageError(fmt::format("{}: found '{}', expected bytes such as 64M or 2G", flag, text));
  return value << shift;
}

bool isColour(const std::string& text) {
  return text.find(',') != std::string::npos && text.find_first_not_of("0123456789+-.eE,") == std::string::npos;
}

glm::vec3 parseColour(const std::string& text, const std::string& flag) {
  const auto numbers = parseNumbers(text, ',', 3, flag, "three numbers R,G,B");
  for (const double number : numbers)
    if (number < 0) throw UsageError(fmt::format("{}: found '{}', expected no negative light", flag, text));
  return glm::vec3(static_cast<float>(numbers[0]), static_cast<float>(numbers[1]), static_cast<float>(numbers[2]));
}

std::pair<double, double> parseRange(const std::string& text, const std::string& flag) {
  const auto numbers = parseNumbers(text, ':', 2, flag, "NEAR:FAR in metres");
  if (numbers[0] <= 0 || numbers[1] <= numbers[0])
    throw UsageError(fmt::format("{}: found '{}', expected 0 < NEAR < FAR", flag, text));
  return {numbers[0], numbers[1]};
}

void ReadFlags::addTo(CLI::App& verb) {
  verb.add_option("--preset", preset, "Producer of the EXR")
      ->check(CLI::IsMember({"auto", "blender"}))
      ->capture_default_str();
  verb.add_option("--beauty", beauty, "Layer of the beauty, such as ViewLayer.Combined");
  verb.add_option("--depth", depth, "Channel of the depth, such as ViewLayer.Depth.Z");
  verb.add_option("--depth-kind", depthKind, "What the depth means")
      ->check(CLI::IsMember({"planar", "ray", "inverse", "device"}))
      ->capture_default_str();
  verb.add_option("--far", farValue, "Depth, in the file's unit, from which nothing was hit");
  verb.add_option("--unit", unit, "Metres in one scene unit")->check(CLI::PositiveNumber)->capture_default_str();
}

ReadOptions ReadFlags::options() const {
  ReadOptions options;
  options.preset = preset;
  options.beautyLayer = beauty;
  options.depthChannel = depth;
  options.depthKind = depthKind;
  options.farValue = farValue;
  options.metresPerUnit = unit;
  return options;
}

void SceneFlags::addTo(CLI::App& verb) {
  verb.add_option("--camera", camera, "glTF camera by name, or eye=X,Y,Z;look=X,Y,Z;up=X,Y,Z;fov=DEGREES (vertical)");
  verb.add_option("--environment", environment,
                  "Surroundings: radiance R,G,B or a lat-long EXR; without it the sky's median");
  verb.add_option("--set", overrides, "MATERIAL.key=value: " + gltf::setKeyNames())->allow_extra_args(false);
  verb.add_option("--lumens-per-watt", lumensPerWatt, "glTF lights are photometric, renders are not")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_option("--texture-filter", textureFilter)
      ->check(CLI::IsMember({"mipmap", "bilinear", "nearest"}))
      ->capture_default_str();
  verb.add_option("--mask", mask, "Edges of alpha-tested materials")
      ->check(CLI::IsMember({"smooth", "hard"}))
      ->capture_default_str();
  verb.add_option("--order", order, "Submission order: file, reverse or shuffle:SEED")->capture_default_str();
  verb.add_option("--budget", budget,
                  "Geometry resident at once, in bytes (64M, 2G; at least 1M): chunks, their GL buffers and pages of "
                  "the files. "
                  "--shadows exact decodes all triangles besides")
      ->capture_default_str();
  verb.add_option("--device", device, "EGL device by number, see inspect --devices");
}

SceneOptions SceneFlags::options(double metresPerUnit, bool traced) const {
  SceneOptions options;
  options.metresPerUnit = metresPerUnit;
  options.lumensPerWatt = lumensPerWatt;
  options.overrides = overrides;
  options.streamBytes = traced ? 0 : pageBytes();
  return options;
}

std::size_t SceneFlags::pageBytes() const {
  // More would only keep what has been drawn.
  constexpr std::size_t kShare = 4, kMost = std::size_t{16} << 20;
  return std::min(std::max(parseBytes(budget, "--budget"), kLeastBudget) / kShare, kMost);
}

void SceneFlags::applyTo(PassSettings& settings) const {
  settings.filter = textureFilter == "mipmap"     ? TextureFilter::mipmap
                    : textureFilter == "bilinear" ? TextureFilter::bilinear
                                                  : TextureFilter::nearest;
  settings.mask = mask == "smooth" ? MaskEdge::smooth : MaskEdge::hard;
  settings.order = parseOrder(order);
  settings.budgetBytes = parseBudget(budget) - pageBytes();
}

void MethodFlags::addTo(CLI::App& verb, bool listsToo) {
  const std::string names = listsToo ? allMethodNames() : "phenomenological";
  verb.add_option("--method", method, names)
      ->check([listsToo, names](const std::string& text) -> std::string {
        if (text == "phenomenological" || (listsToo && methodNamed(text))) return "";
        return fmt::format("--method: found '{}', expected {}", text, names);
      })
      ->capture_default_str();
  std::vector<std::string> tiers;
  std::string promises;
  for (const PrecisionTier& row : kTiers) {
    tiers.emplace_back(row.name);
    promises += fmt::format("{}{}: {}", promises.empty() ? "" : "; ", row.name, row.promise);
  }
  verb.add_option("--precision", precision, promises)->check(CLI::IsMember(tiers))->capture_default_str();
  addWeightTo(verb, listsToo);
}

void MethodFlags::addWeightTo(CLI::App& verb, bool takesAuto) {
  autoAllowed = takesAuto;
  normalisationOption = verb.add_option("--normalisation", normalisation)
                            ->check(CLI::IsMember({"spectral", "published"}))
                            ->capture_default_str();
  weightOption = verb.add_option("--weight", weight,
                                 weightNames() + (takesAuto ? ", or auto: fitted to the truth on probe pixels" : ""))
                     ->capture_default_str();
  verb.add_option("--weight-range", weightRange, "NEAR:FAR in metres, for " + rangedWeights());
}

std::optional<ChosenMethod> MethodFlags::listMethod() const {
  const Method& row = *methodNamed(method);
  if ((isPublished() && !row.takesPublished) || (isExact() && !row.takesExact))
    throw UsageError(fmt::format("--precision: found {} with --method {}, expected phenomenological{}", precision,
                                 method, isExact() ? " or over" : ""));
  // Of the sorted truth the flags are the fit's and the measured sums'.
  const bool refuses = row.kind != MethodKind::sorted;
  if (refuses && !row.weighs && weightOption && weightOption->count() > 0)
    throw UsageError(fmt::format("--weight: --method {} does not weigh its layers", method));
  if (refuses && !row.normalises && normalisationOption && normalisationOption->count() > 0)
    throw UsageError(fmt::format("--normalisation: --method {} {}", method,
                                 row.weighs ? "has one of its own" : "does not weigh its layers"));
  return chooseMethod(method);
}

void MethodFlags::applyTo(PassSettings& settings, const Camera& camera) const {
  if (isPublished()) {
    if (normalisationOption->count() > 0 && normalisation == "spectral")
      throw UsageError(
          "--normalisation: found spectral with --precision published, expected published: its targets have one "
          "denominator for all channels");
    settings.tier = SumsTier::published;
  }
  settings.normalisation = isPublished() || normalisation == "published" ? shading::PLD_NORMALISE_PUBLISHED
                                                                         : shading::PLD_NORMALISE_SPECTRAL;
  if (isAuto() && !autoAllowed)
    throw UsageError("--weight: found 'auto', expected a weight: this verb has no truth to fit it to");
  settings.weight = parseWeight(isAuto() ? "eq5" : weight, settings.weight);  // auto: until the fit
  double rangeNear = camera.rangeNear > 0 ? camera.rangeNear : 0.1;
  double rangeFar = camera.rangeFar > rangeNear ? camera.rangeFar : rangeNear * 1e4;
  if (!weightRange.empty()) std::tie(rangeNear, rangeFar) = parseRange(weightRange, "--weight-range");
  settings.weight.rangeNear = static_cast<float>(rangeNear);
  settings.weight.rangeFar = static_cast<float>(rangeFar);
}

void RunFlags::addTo(CLI::App& verb) {
  verb.add_option("--threads", threads, "0 uses every core")->check(CLI::NonNegativeNumber);
  verb.add_flag("--stats", stats, "Print counts and the time of every stage");
  verb.add_flag("--json", json, "Print results as JSON");
}

}  // namespace pellucid::cli
