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

}  // namespace

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
        throw UsageError(fmt::format("--set {}: unknown key {}; the keys are {}", text, key, setKeyForms()));
      }
      if (result == SetResult::badValue) {
        throw UsageError(
            fmt::format("--set {}: found the value {}; the keys are {}", text, text.substr(equals + 1), setKeyForms()));
      }
    }
    if (!found) {
      throw UsageError(
          fmt::format("--set {}: no material is named {}; the materials are {}", text, name, materialNames(materials)));
    }
  }
}

}  // namespace pellucid::gltf
