#include "composite/pipeline/system_weights.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "composite/pipeline/fit.h"
#include "composite/pipeline/pass_picture.h"
#include "gbuffer/errors.h"
#include "gbuffer/weight_text.h"

namespace pellucid {
namespace {

// A system of several files' nodes is called "file: node".
bool isCalled(const LayerSystem& system, const std::string& name) {
  if (system.name == name || std::filesystem::path(system.name).filename() == name) return true;
  const auto node = system.name.find(": ");
  return node != std::string::npos && system.name.substr(node + 2) == name;
}

}  // namespace

SystemWeight readSystemWeight(const std::string& text) {
  const auto equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0)
    throw UsageError(fmt::format("--system-weight: found '{}', expected NAME=WEIGHT", text));
  const std::string weight = text.substr(equals + 1);
  SystemWeight made{text.substr(0, equals), std::nullopt, false};
  if (weight != "auto") made.weight = parseWeight(weight, PassSettings().weight);
  return made;
}

std::string systemWeightsText(const std::vector<SystemWeight>& weights) {
  std::string text;
  for (const SystemWeight& each : weights)
    if (each.weight) text += (text.empty() ? "" : "\n") + each.system + "=" + weightText(*each.weight);
  return text;
}

std::optional<std::vector<SystemWeight>> readSystemWeightsText(const std::string& text) {
  std::vector<SystemWeight> weights;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto equals = line.rfind('=');
    if (equals == std::string::npos || equals == 0) return std::nullopt;
    const auto weight = readWeightText(line.substr(equals + 1));
    if (!weight) return std::nullopt;
    weights.push_back({line.substr(0, equals), weight, true});
  }
  return weights;
}

const SystemWeight* weightOf(const PaintSystems& systems, const LayerSystem& system) {
  const auto found = std::find_if(systems.weights.begin(), systems.weights.end(),
                                  [&](const SystemWeight& each) { return isCalled(system, each.system); });
  return found == systems.weights.end() ? nullptr : &*found;
}

void checkSystemNames(const PaintSystems& asked, const std::vector<LayerSystem>& systems) {
  for (const SystemWeight& each : asked.weights) {
    const auto called = [&](const LayerSystem& system) { return isCalled(system, each.system); };
    if (std::any_of(systems.begin(), systems.end(), called)) continue;
    std::string names;
    for (const LayerSystem& system : systems) names += (names.empty() ? "" : ", ") + system.name;
    throw UsageError(fmt::format("--system-weight: found no system '{}', expected one of: {}", each.system, names));
  }
}

PaintSystems fittedSystems(const PaintContext& context, const PassSettings& sample, const DepthPlanes* planes,
                           const EdgePasses* edges) {
  PaintSystems fitted = *context.plan.as<PaintSystems>();
  Journal unsaid;  // the painter says where the systems are
  const std::vector<LayerSystem> systems = splitSystems(fitted.rule, context.shot, context.device, unsaid);
  checkSystemNames(fitted, systems);
  PassSettings alone = sample;
  alone.fog = nullptr;
  for (const LayerSystem& system : systems) {
    const SystemWeight* asked = weightOf(fitted, system);
    if (!asked || asked->weight) continue;
    Plan plan = context.plan;
    plan.fog = false;
    plan.deepFiles = system.deep != nullptr;
    if (system.deep) plan.lowResolution = 1;
    LayerSources sources(system.pass.get());
    if (system.deep) sources.join(deepFiles({system.deep, 1}));
    PassPicture moving(context.picture, planes, edges, system.pass.get(), context.shot.camera,
                       context.picture.gbuffer->data);
    RunCounts unused;
    const PaintContext part{plan, context.shot, moving.picture(), sources, context.device, context.journal, unused};
    const shading::WeightSettings weight =
        fittedWeight(part, moving, alone, fmt::format("--system-weight {}=auto", asked->system));
    for (SystemWeight& each : fitted.weights)
      if (&each == asked) each = {each.system, weight, true};
  }
  return fitted;
}

}  // namespace pellucid
