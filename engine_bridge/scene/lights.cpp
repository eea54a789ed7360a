// KHR_lights_punctual to radiometric lights in the world.
#include <fmt/format.h>

#include <cmath>

#include "engine_bridge/scene/nodes.h"

namespace pellucid::gltf {

namespace {

constexpr const char* kExtension = "KHR_lights_punctual";
constexpr float kMostIntensity = 1e15f;  // leaves room for products in float
constexpr float kHalfPi = 1.57079633f;

// Empty for a kind that the extension does not have.
std::optional<LightKind> kindOf(const std::string& name) {
  if (name == "directional") return LightKind::directional;
  if (name == "point") return LightKind::point;
  if (name == "spot") return LightKind::spot;
  return std::nullopt;
}

}  // namespace

void readLights(const GltfFile& file, const std::vector<PlacedNode>& nodes, const SceneOptions& options, Notes& notes,
                std::vector<Light>& lights) {
  for (const PlacedNode& placed : nodes) {
    if (!placed.visible) continue;
    const std::optional<JsonView> use = file.item("nodes", placed.index).extension(kExtension);
    if (!use) continue;
    const JsonView reference = use->at("light");
    const std::optional<JsonView> all = file.root().extension(kExtension);
    if (!all) reference.refuse("points at a light, and the file has none");
    const JsonView available = all->at("lights");
    const JsonView source = available.at(reference.index(available.size(), "lights"));
    Light light;
    light.name = source.string("name", placed.name);
    const std::string& type = source.at("type").string();
    const std::optional<LightKind> kind = kindOf(type);
    if (!kind) {
      notes.add(fmt::format("light {}: is {}, which is none of directional, point and spot, and is left out",
                            light.name, type));
      continue;
    }
    light.kind = *kind;
    light.colour = source.colour("color", glm::vec3(1.0f), 0.0f, kMostIntensity, notes);
    const float photometric = source.number("intensity", 1.0f, 0.0f, kMostIntensity, notes);
    light.intensity = static_cast<float>(static_cast<double>(photometric) / options.lumensPerWatt);
    light.range = static_cast<float>(static_cast<double>(source.number("range", 0.0f, 0.0f, kMostIntensity, notes)) *
                                     options.metresPerUnit);
    if (light.kind == LightKind::spot) {
      const JsonView spot = source.at("spot");
      light.outerCone = spot.number("outerConeAngle", light.outerCone, 1e-3f, kHalfPi, notes);
      light.innerCone = spot.number("innerConeAngle", 0.0f, 0.0f, kHalfPi, notes);
      if (light.innerCone >= light.outerCone) {
        notes.add(
            fmt::format("light {}: its inner cone is not inside its outer cone; it gets a hard edge", light.name));
        light.innerCone = 0.999f * light.outerCone;  // a falloff of no width would divide by zero
      }
    }
    const glm::dmat4& world = placed.worldFromObject;
    light.position = glm::dvec3(world[3]);
    const double length = glm::length(glm::dvec3(world[2]));
    if (light.kind != LightKind::point && !(length > 0.0)) {
      file.item("nodes", placed.index).refuse("carries a light and has a transform without direction");
    }
    if (length > 0.0) light.direction = glm::dvec3(world[2]) / -length;
    lights.push_back(std::move(light));
  }
}

}  // namespace pellucid::gltf
