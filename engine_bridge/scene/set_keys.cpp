#include "engine_bridge/scene/set_keys.h"

#include <fmt/format.h>

#include <charconv>

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

bool isFlag(const SetKey& key) {
  return std::holds_alternative<bool Material::*>(key.field) ||
         std::holds_alternative<std::optional<bool> Material::*>(key.field);
}

// "0 to 1", "true or false"
std::string takes(const SetKey& key) {
  if (isFlag(key)) return "true or false";
  return fmt::format("{:g} to {:g}{}{}", key.least, key.most, *key.unit ? " " : "", key.unit);
}

template <class Value>
SetResult put(Material& material, const SetKey& key, const std::optional<Value>& value) {
  if (!value) return SetResult::badValue;
  if (const auto* plain = std::get_if<Value Material::*>(&key.field)) material.** plain = *value;
  if (const auto* optional = std::get_if<std::optional<Value> Material::*>(&key.field)) material.** optional = *value;
  return SetResult::done;
}

}  // namespace

const std::vector<SetKey>& setKeys() {
  static const std::vector<SetKey> table{
      {"thin", &Material::thin, 0, 0, "", "a surface without thickness, which does not refract"},
      {"collimation", &Material::collimation, 0, 1, "", "share of light that passes straight; the rest diffuses"},
      {"coverage", &Material::coverage, 0, 1, "", "factor on alpha: how much of a pixel the material covers"},
      {"additive", &Material::additive, 0, 0, "", "it adds its light and hides nothing, as fire does"},
      {"lowResolution", &Material::lowResolution, 0, 0, "", "drawn at the part of the resolution that --low-res says"},
      {"castsShadow", &Material::castsShadow, 0, 0, "", "whether it dims the lights behind it"},
      {"billboard", &Material::billboard, 0, 0, "", "a card that stands for a ball of particles, lit as one"},
      {"softness", &Material::softness, 0, 1e6f, "metres", "depth over which it fades where it meets what is opaque"},
      {"pointScale", &Material::pointScale, 0, 1e6f, "", "factor on the radii of points"},
      {"phase", &Material::phase, -0.98f, 0.98f, "", "asymmetry of Henyey and Greenstein, > 0 scatters forward"},
  };
  return table;
}

SetResult setKey(Material& material, const std::string& key, const std::string& value) {
  for (const SetKey& row : setKeys())
    if (key == row.name)
      return isFlag(row) ? put(material, row, parseBool(value))
                         : put(material, row, parseWithin(value, row.least, row.most));
  return SetResult::unknownKey;
}

std::string setKeyNames() {
  std::string names;
  for (const SetKey& row : setKeys()) names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
  return names;
}

std::string setKeyForms() {
  std::string forms;
  for (const SetKey& row : setKeys())
    forms += fmt::format("{}{} ({})", forms.empty() ? "" : ", ", row.name, takes(row));
  return forms;
}

std::string setKeysHelp() {
  std::string text;
  for (const SetKey& row : setKeys()) text += fmt::format("{:<14} {}: {}\n", row.name, takes(row), row.help);
  return text;
}

}  // namespace pellucid::gltf
