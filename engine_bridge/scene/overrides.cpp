// extras.pellucid and --set share their keys.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "engine_bridge/scene/materials.h"
#include "gbuffer/errors.h"

namespace pellucid::gltf {

namespace {

std::optional<bool> parseBool(const std::string& text) {
  if (text == "true" || text == "on" || text == "1") return true;
  if (text == "false" || text == "off" || text == "0") return false;
  return std::nullopt;
}

std::optional<float> parseWithin(const std::string& text, float least, float most) {
  float value = 0.0f;
  const char* const end = text.data() + text.size();
  const auto [stopped, problem] = std::from_chars(text.data(), end, value);
  if (problem != std::errc() || stopped != end || !(value >= least && value <= most)) return std::nullopt;
  return value;
}

std::string materialNames(const std::vector<Material>& materials) {
  constexpr std::size_t kMost = 40;
  std::set<std::string> names;
  for (const Material& material : materials) names.insert(material.name);
  std::string list;
  std::size_t listed = 0;
  for (const std::string& name : names) {
    if (listed++ == kMost) return list + fmt::format(" and {} more", names.size() - kMost);
    list += (list.empty() ? "" : ", ") + name;
  }
  return list.empty() ? "none" : list;
}

}  // namespace

const char* const kSetKeys =
    "collimation and coverage (0 to 1), additive, lowResolution, castsShadow, thin and billboard (true or false), "
    "softness (metres) and pointScale (0 to 1e6), phase (-0.98 to 0.98)";

SetResult setKey(Material& material, const std::string& key, const std::string& value) {
  const bool isLength = key == "softness" || key == "pointScale", isPhase = key == "phase";
  const bool isNumber = key == "collimation" || key == "coverage" || isLength || isPhase;
  const bool isFlag =
      key == "additive" || key == "lowResolution" || key == "castsShadow" || key == "thin" || key == "billboard";
  if (!isNumber && !isFlag) return SetResult::unknownKey;
  const std::optional<float> unit = isNumber ? parseWithin(value, isPhase ? -0.98f : 0.0f,
                                                           isLength  ? 1e6f
                                                           : isPhase ? 0.98f
                                                                     : 1.0f)
                                             : std::nullopt;
  const std::optional<bool> flag = isFlag ? parseBool(value) : std::nullopt;
  if (!unit && !flag) return SetResult::badValue;
  if (key == "collimation") material.collimation = unit;
  if (key == "coverage") material.coverage = unit;
  if (key == "additive") material.additive = *flag;
  if (key == "lowResolution") material.lowResolution = *flag;
  if (key == "castsShadow") material.castsShadow = *flag;
  if (key == "thin") material.thin = flag;
  if (key == "billboard") material.billboard = *flag;
  if (key == "softness") material.softness = *unit;
  if (key == "pointScale") material.pointScale = *unit;
  if (isPhase) material.phase = *unit;
  return SetResult::done;
}

void applyOverrides(const std::vector<std::string>& overrides, std::vector<Material>& materials) {
  for (const std::string& text : overrides) {
    // From the right: names of materials may hold dots and equals signs, keys and values do not.
    const std::size_t equals = text.rfind('=');
    const std::size_t dot = equals == std::string::npos ? equals : text.rfind('.', equals);
    if (dot == std::string::npos || dot == 0) {
      throw UsageError(fmt::format("--set {}: expected MATERIAL.key=value", text));
    }
    // A value may hold a dot (0.5), so the key's dot is the last one before the equals sign.
    const std::string name = text.substr(0, dot), key = text.substr(dot + 1, equals - dot - 1);
    bool found = false;
    for (Material& material : materials) {
      if (material.name != name) continue;
      found = true;
      const SetResult result = setKey(material, key, text.substr(equals + 1));
      if (result == SetResult::unknownKey) {
        throw UsageError(fmt::format("--set {}: unknown key {}; the keys are {}", text, key, kSetKeys));
      }
      if (result == SetResult::badValue) {
        throw UsageError(
            fmt::format("--set {}: found the value {}; the keys are {}", text, text.substr(equals + 1), kSetKeys));
      }
    }
    if (!found) {
      throw UsageError(
          fmt::format("--set {}: no material is named {}; the materials are {}", text, name, materialNames(materials)));
    }
  }
}

}  // namespace pellucid::gltf
