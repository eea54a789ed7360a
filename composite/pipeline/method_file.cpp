#include "composite/pipeline/method_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "composite/pipeline/refusals.h"
#include "composite/pipeline/system_weights.h"
#include "composite/pipeline/weight_file.h"
#include "gbuffer/errors.h"
#include "gbuffer/exr_document.h"
#include "gbuffer/weight_text.h"

namespace pellucid {
namespace {

constexpr const char *kToleranceAttribute = "pellucid:tolerance", *kSystemsAttribute = "pellucid:systems",
                     *kSystemWeightsAttribute = "pellucid:systemWeights";
constexpr const char* kExpected = "what composite writes";

[[noreturn]] void refuse(const std::string& path, const char* attribute, const std::string& found) {
  throw MeaningError(
      fmt::format("{}: --method-from: attribute {}: found '{}', expected {}", path, attribute, found, kExpected));
}

double toleranceIn(const std::string& path, const std::string& text) {
  char* end = nullptr;
  const double tolerance = std::strtod(text.c_str(), &end);
  if (text.empty() || *end || !std::isfinite(tolerance) || tolerance < 0.0) refuse(path, kToleranceAttribute, text);
  return tolerance;
}

Paint paintOf(const std::string& path, const std::string& name) {
  const Method* row = methodNamed(name);
  if (!row) refuse(path, kMethodAttribute, name);
  if (row->kind == MethodKind::stochastic)
    throw MeaningError(
        fmt::format("{}: --method-from: found a picture by {}, whose samples its header does not say, expected one by "
                    "another method",
                    path, name));
  if (row->kind == MethodKind::sorted) return PaintSorted{};
  if (const std::optional<ChosenMethod> listed = chooseMethod(name)) return PaintListed{*listed};
  return PaintSums{};
}

}  // namespace

std::map<std::string, std::string> methodAttributes(const Plan& plan) {
  std::map<std::string, std::string> attributes{{kMethodAttribute, plan.method},
                                                {kWeightAttribute, weightText(plan.pass.weight)}};
  if (const auto* within = plan.as<PaintWithin>())
    attributes[kToleranceAttribute] = fmt::format("{}", within->tolerance);
  if (const auto* systems = plan.as<PaintSystems>()) {
    attributes[kSystemsAttribute] = systems->rule == SystemRule::file ? "file" : "node";
    if (!systems->weights.empty()) attributes[kSystemWeightsAttribute] = systemWeightsText(systems->weights);
  }
  return attributes;
}

Request methodByFile(const Request& request) {
  const std::string& path = request.methodFrom;
  if (path.empty()) return request;
  const std::optional<std::string> name = exrText(path, kMethodAttribute);
  if (!name)
    throw MeaningError(
        fmt::format("{}: --method-from: found no attribute {}, expected {}", path, kMethodAttribute, kExpected));
  Request taken = request;
  taken.methodFrom.clear();
  taken.method = *name;
  taken.decided = MethodDecision{*name, "as " + path + " has it", ""};
  taken.paint = paintOf(path, *name);
  const auto* listed = std::get_if<PaintListed>(&taken.paint);
  if (const auto systems = exrText(path, kSystemsAttribute)) {
    if (*systems != "file" && *systems != "node") refuse(path, kSystemsAttribute, *systems);
    PaintSystems painted{*systems == "file" ? SystemRule::file : SystemRule::node, std::nullopt, {}};
    if (listed) painted.method = listed->method;
    if (const auto text = exrText(path, kSystemWeightsAttribute)) {
      const auto weights = readSystemWeightsText(*text);
      if (!weights) refuse(path, kSystemWeightsAttribute, *text);
      painted.weights = *weights;
    }
    taken.paint = painted;
  } else if (const auto tolerance = exrText(path, kToleranceAttribute)) {
    taken.paint = PaintWithin{toleranceIn(path, *tolerance)};
  }
  if (const auto weight = exrText(path, kWeightAttribute)) {
    const std::optional<shading::WeightSettings> known = readWeightText(*weight);
    if (!known) refuse(path, kWeightAttribute, *weight);
    setWeight(taken, *known);
  }
  return taken;
}

}  // namespace pellucid
