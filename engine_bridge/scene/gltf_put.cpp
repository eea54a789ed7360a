// Values that animations put into a document.
#include <fmt/format.h>

#include <algorithm>

#include "engine_bridge/scene/gltf_file.h"

namespace pellucid::gltf {

namespace {

// glTF's one object of a material that may be absent as a whole while its numbers have defaults.
constexpr const char* kDefaulted = "pbrMetallicRoughness";
constexpr const char* kFlag = "visible";
constexpr const char* kMany = "weights";

// All names of "/materials/3/alphaCutoff". Names of ours hold no escapes.
std::vector<std::string> namesOf(const std::string& pointer) {
  std::vector<std::string> names;
  for (std::size_t at = 1; at <= pointer.size();) {
    const std::size_t slash = std::min(pointer.find('/', at), pointer.size());
    names.push_back(pointer.substr(at, slash - at));
    at = slash + 1;
  }
  return names;
}

// The child of that name; null where there is none.
const nlohmann::json* childOf(const nlohmann::json& parent, const std::string& name) {
  if (parent.is_array()) {
    const bool digits = !name.empty() && name.size() < 10 && name.find_first_not_of("0123456789") == std::string::npos;
    const std::size_t index = digits ? std::stoul(name) : parent.size();
    return index < parent.size() ? &parent[index] : nullptr;
  }
  const auto found = parent.is_object() ? parent.find(name) : parent.end();
  return parent.is_object() && found != parent.end() ? &*found : nullptr;
}

}  // namespace

bool GltfFile::holds(const std::string& pointer) const {
  const std::vector<std::string> names = namesOf(pointer);
  const nlohmann::json* at = &json_;
  for (std::size_t i = 0; i + 1 < names.size(); ++i) {
    const nlohmann::json* next = childOf(*at, names[i]);
    if (!next) return at->is_object() && names[i] == kDefaulted && i + 2 == names.size();
    at = next;
  }
  return at->is_object();
}

void GltfFile::put(const std::string& pointer, const std::vector<double>& values) {
  const std::vector<std::string> names = namesOf(pointer);
  const JsonView whole = root();
  if (!holds(pointer)) whole.refuse(fmt::format("animates {}, which is not there", pointer));
  nlohmann::json* at = &json_;
  for (std::size_t i = 0; i + 1 < names.size(); ++i) {
    const nlohmann::json* next = childOf(*at, names[i]);
    at = next ? const_cast<nlohmann::json*>(next) : &((*at)[names[i]] = nlohmann::json::object());
  }
  const std::string& name = names.back();
  nlohmann::json value = values;
  if (values.size() == 1 && name != kMany) value = values[0];
  if (name == kFlag) value = values[0] != 0.0;
  const auto old = at->find(name);
  const bool fits = old == at->end() || (old->is_number() && value.is_number()) ||
                    (old->is_boolean() && value.is_boolean()) ||
                    (old->is_array() && value.is_array() && old->size() == value.size());
  if (!fits) whole.refuse(fmt::format("animates {} by {} numbers, unlike what stands there", pointer, values.size()));
  (*at)[name] = std::move(value);
}

}  // namespace pellucid::gltf
