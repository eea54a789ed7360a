#include "gbuffer/weight_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

// "power:K", or the name alone.
std::string form(const DepthWeight& row) {
  return row.parameter ? fmt::format("{}:{}", row.name, row.parameter) : row.name;
}

const DepthWeight* rowNamed(const std::string& name) {
  for (const DepthWeight& row : kDepthWeights)
    if (name == row.name) return &row;
  return nullptr;
}

std::optional<float> numberOf(const std::string& text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, problem] = std::from_chars(text.data(), end, value);
  if (problem != std::errc() || stopped != end || !std::isfinite(value)) return std::nullopt;
  return static_cast<float>(value);
}

const char* scaleText(WeightScale scale) {
  switch (scale) {
    case WeightScale::free:
      return "the same picture at every scale";
    case WeightScale::ranged:
      return "the same picture at every scale, where --weight-range grows with the scene";
    case WeightScale::metres:
      return "its constants are the paper's, in metres: a larger scene is another picture, unless --weight-reference "
             "says how many metres their unit is";
  }
  return "";
}

}  // namespace

std::string weightText(const shading::WeightSettings& weight) {
  const DepthWeight* row = depthWeightOf(weight.kind);
  const std::string text = fmt::format("{} {:.9g} {:.9g} {:.9g}", row ? row->name : fmt::format("kind{}", weight.kind),
                                       weight.rangeNear, weight.rangeFar, weight.exponent);
  return row && row->reference != WeightReference::none ? fmt::format("{} {:.9g}", text, weight.reference) : text;
}

std::optional<shading::WeightSettings> readWeightText(const std::string& text) {
  std::istringstream words(text);
  std::string name, word;
  words >> name;
  const DepthWeight* row = rowNamed(name);
  if (!row) return std::nullopt;
  shading::WeightSettings weight{row->kind, 0.0f, 0.0f, 0.0f, 1.0f};
  for (float* value : {&weight.rangeNear, &weight.rangeFar, &weight.exponent, &weight.reference}) {
    if (!(words >> word)) {
      if (value != &weight.reference) return std::nullopt;
      break;  // of before there were references: metres
    }
    const std::optional<float> number = numberOf(word);
    if (!number || (value == &weight.reference && (row->reference == WeightReference::none || !(*number > 0.0f))))
      return std::nullopt;
    *value = *number;
  }
  if (words >> word) return std::nullopt;
  return weight;
}

shading::WeightSettings parseWeight(const std::string& text, const shading::WeightSettings& given) {
  const std::size_t colon = text.find(':');
  const DepthWeight* row = rowNamed(text.substr(0, colon));
  if (!row || (colon == std::string::npos) != (row->parameter == nullptr))
    throw UsageError(fmt::format("--weight: found '{}', expected {}", text, weightNames()));
  shading::WeightSettings weight = given;
  weight.kind = row->kind;
  if (!row->parameter) return weight;
  const std::optional<float> parameter = numberOf(text.substr(colon + 1));
  if (!parameter)
    throw UsageError(
        fmt::format("--weight: found '{}', expected {} with a number {}", text, form(*row), row->parameter));
  if (!(*parameter >= row->least))
    throw UsageError(fmt::format("--weight: found '{}', expected {} >= {:g}: farther layers must not weigh more", text,
                                 row->parameter, row->least));
  weight.exponent = *parameter;
  return weight;
}

std::string weightName(const shading::WeightSettings& weight) {
  const DepthWeight* row = depthWeightOf(weight.kind);
  if (!row) return fmt::format("kind{}", weight.kind);
  return row->parameter ? fmt::format("{}:{}", row->name, weight.exponent) : row->name;
}

std::string weightNames() {
  std::string names;
  for (const DepthWeight& row : kDepthWeights) names += (names.empty() ? "" : ", ") + form(row);
  return names;
}

std::string rangedWeights() {
  std::string names;
  for (const DepthWeight& row : kDepthWeights)
    if (row.readsRange) names += (names.empty() ? "" : ", ") + form(row);
  return names;
}

std::string referenceWeights() {
  std::string names;
  for (const DepthWeight& row : kDepthWeights)
    if (row.reference != WeightReference::none) names += (names.empty() ? "" : ", ") + form(row);
  return names;
}

std::string weightsHelp() {
  std::string text;
  for (const DepthWeight& row : kDepthWeights)
    text += fmt::format("{:<10} {}; {}{}\n", form(row), row.help, scaleText(row.scale),
                        row.readsRange ? "; reads --weight-range"
                        : row.reference == WeightReference::depth
                            ? "; --weight-reference is where it weighs 1, which shows in no picture"
                            : "");
  return text;
}

}  // namespace pellucid
