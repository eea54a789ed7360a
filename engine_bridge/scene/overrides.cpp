#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine_bridge/scene/materials.h"
#include "engine_bridge/scene/set_keys.h"
#include "gbuffer/errors.h"

namespace pellucid::gltf {

namespace {

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

// "MATERIAL.key=value", taken apart.
struct Override {
  std::string material, key, value;
};

Override takeApart(const std::string& text) {
  // From the right: names of materials may hold dots and equals signs, keys and values do not.
  const std::size_t equals = text.rfind('=');
  const std::size_t dot = equals == std::string::npos ? equals : text.rfind('.', equals);
  if (dot == std::string::npos || dot == 0)
    throw UsageError(fmt::format("--set {}: expected MATERIAL.key=value", text));
  // A value may hold a dot (0.5), so the key's dot is the last one before the equals sign.
  return {text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), text.substr(equals + 1)};
}

void put(const Override& each, const std::string& text, Material& material) {
  const SetResult result = setKey(material, each.key, each.value);
  if (result == SetResult::unknownKey)
    throw UsageError(fmt::format("--set {}: unknown key {}; the keys are {}", text, each.key, setKeyForms()));
  if (result == SetResult::badValue)
    throw UsageError(fmt::format("--set {}: found the value {}; the keys are {}", text, each.value, setKeyForms()));
}

}  // namespace

void checkOverrides(const std::vector<std::string>& overrides) {
  Material none;
  for (const std::string& text : overrides) put(takeApart(text), text, none);
}

void applyOverrides(const std::vector<std::string>& overrides, Material& material) {
  for (const std::string& text : overrides)
    if (const Override each = takeApart(text); each.material == material.name) put(each, text, material);
}

void applyOverrides(const std::vector<std::string>& overrides, std::vector<Material>& materials) {
  for (const std::string& text : overrides) {
    const Override each = takeApart(text);
    bool found = false;
    for (Material& material : materials) {
      if (material.name != each.material) continue;
      found = true;
      put(each, text, material);
    }
    if (!found)
      throw UsageError(fmt::format("--set {}: no material is named {}; the materials are {}", text, each.material,
                                   materialNames(materials)));
  }
}

}  // namespace pellucid::gltf
