// What --set MATERIAL.key=value and glTF's extras.pellucid may say of a material: one table, a row a key.
#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine_bridge/scene/scene.h"

namespace pellucid::gltf {

struct SetKey {
  const char* name;
  // What it sets; without a key an optional is what glTF itself says.
  std::variant<bool Material::*, std::optional<bool> Material::*, float Material::*, std::optional<float> Material::*>
      field;
  float least, most;  // of numbers
  const char* unit;   // of numbers, "" for plain ones
  const char* help;
};

const std::vector<SetKey>& setKeys();

enum class SetResult { done, unknownKey, badValue };
SetResult setKey(Material& material, const std::string& key, const std::string& value);

// What needs no scene: the form, the keys and the values of --set MATERIAL.key=value. Throws UsageError.
void checkOverrides(const std::vector<std::string>& overrides);

std::string setKeyNames();  // "thin, collimation, ...", for help
std::string setKeyForms();  // "thin (true or false), collimation (0 to 1), ...", for messages
std::string setKeysHelp();  // a line for every row

}  // namespace pellucid::gltf
