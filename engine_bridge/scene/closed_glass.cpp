#include "engine_bridge/scene/closed_glass.h"

#include <fmt/format.h>

#include <algorithm>

#include "shaders/closed_body_text.h"

namespace pellucid::gltf {
namespace {

bool writesNoVolumes(const GltfFile& file) {
  const std::optional<JsonView> asset = file.root().find("asset");
  if (!asset || asset->string("generator", "").find("Blender I/O") == std::string::npos) return false;
  return !file.uses("KHR_materials_volume");
}

bool isThinGlass(const Material& material) {
  return material.transmission > 0.0f && material.ior != 1.0f && !material.unlit && !material.thin && !material.volume;
}

std::string shapesOf(const std::set<int>& kinds) {
  if (kinds.size() > 1) return "balls and boxes";
  return kinds.count(shading::PLD_BODY_BALL) > 0 ? "a ball" : "a box";
}

}  // namespace

ClosedGlass::ClosedGlass(const GltfFile& file, bool asked) : asked_(asked && writesNoVolumes(file)) {}

void ClosedGlass::apply(Scene& scene, std::size_t first, std::size_t end, const std::set<int>& readNow, Notes& notes) {
  if (!asked_) return;
  for (const int primitive : readNow) bodies_.erase(primitive);
  for (std::size_t m = first; m < end; ++m) {
    Material& material = scene.materials[m];
    if (!isThinGlass(material)) continue;
    std::vector<int> owners;
    std::set<int> kinds;
    bool all = true;
    for (std::size_t i = 0; i < scene.primitives.size() && all; ++i) {
      if (scene.primitives[i].material != static_cast<int>(m)) continue;
      const int number = static_cast<int>(i);
      const auto known = bodies_.find(number);
      const std::optional<SolidBody>& body =
          known != bodies_.end() ? known->second
                                 : bodies_.emplace(number, closedBodyOf(scene.primitives[i])).first->second;
      all = body.has_value();
      if (!all) break;
      owners.push_back(number);
      kinds.insert(body->kind);
    }
    if (!all || owners.empty()) continue;
    material.thin = false;
    for (const int number : owners) scene.primitives[static_cast<std::size_t>(number)].body = bodies_[number];
    notes.add(
        fmt::format("material {} is glass of index {:g} and fills {}, and the exporter writes no volumes: light bends "
                    "where it enters and where it leaves; --thin file leaves it a thin sheet",
                    material.name, material.ior, shapesOf(kinds)));
  }
}

}  // namespace pellucid::gltf
