#include "composite/pipeline/systems.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "composite/pipeline/layer_span.h"

namespace pellucid {
namespace {

// Which system each instance belongs to, and their names.
std::vector<std::size_t> groupInstances(SystemRule rule, const Shot& shot, std::vector<std::string>& names) {
  const std::vector<Instance>& instances = shot.scene.instances;
  std::vector<std::size_t> group;
  if (rule == SystemRule::file) {
    names = shot.geometry;
    for (const Instance& instance : instances) group.push_back(static_cast<std::size_t>(instance.file));
    return group;
  }
  for (const Instance& instance : instances) {
    const std::string& file = shot.geometry[static_cast<std::size_t>(instance.file)];
    const std::string name = shot.geometry.size() > 1 ? file + ": " + instance.node : instance.node;
    const auto known = std::find(names.begin(), names.end(), name);
    group.push_back(static_cast<std::size_t>(known - names.begin()));
    if (known == names.end()) names.push_back(name);
  }
  return group;
}

void keepTexture(const TextureRef& ref, const Scene& from, Scene& to) {
  if (ref.texture < 0) return;
  const auto i = static_cast<std::size_t>(ref.texture);
  to.textures[i] = from.textures[i];
}

// The instances of one group, and what they need; other primitives and textures stay as empty places.
Scene partOf(const Scene& scene, const std::vector<std::size_t>& group, std::size_t wanted) {
  Scene part;
  part.materials = scene.materials;
  part.lights = scene.lights;
  part.textures.resize(scene.textures.size());
  for (Texture& texture : part.textures) texture.texels = Image<glm::vec4>(1, 1, glm::vec4(1.0f));
  part.primitives.resize(scene.primitives.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (group[i] != wanted) continue;
    part.instances.push_back(scene.instances[i]);
    const auto number = static_cast<std::size_t>(scene.instances[i].primitive);
    part.primitives[number] = scene.primitives[number];
    const Material& material = scene.materials[static_cast<std::size_t>(scene.primitives[number].material)];
    for (const TextureRef* ref : material.textures()) keepTexture(*ref, scene, part);
  }
  return part;
}

// Planar distance to the middle of what is transparent; nothing where nothing is.
std::optional<double> middleOf(const DepthSpan& span) {
  if (span.empty()) return std::nullopt;
  return 0.5 * (span.low + span.high);
}

}  // namespace

std::vector<LayerSystem> splitSystems(SystemRule rule, const Shot& shot, Device& device, Journal& journal) {
  std::vector<std::string> names;
  const std::vector<std::size_t> group = groupInstances(rule, shot, names);
  std::vector<LayerSystem> systems;
  for (std::size_t i = 0; i < names.size(); ++i) {
    LayerSystem system{names[i], 0.0, partOf(shot.scene, group, i), nullptr, nullptr};
    const std::optional<double> z = middleOf(layerSpanOf(system.scene, shot.camera));
    if (!z) continue;
    system.z = *z;
    systems.push_back(std::move(system));
  }
  for (const std::unique_ptr<DeepSource>& file : shot.deep)
    if (const std::optional<double> z = middleOf(layerSpanOf(file, shot.opaque.gbuffer)))
      systems.push_back({file->path(), *z, {}, nullptr, &file});
  std::stable_sort(systems.begin(), systems.end(),
                   [](const LayerSystem& a, const LayerSystem& b) { return a.z > b.z; });
  for (LayerSystem& system : systems) {
    if (!system.deep)
      system.pass =
          std::make_unique<TransparentPass>(device.context(journal), system.scene, shot.opaque.gbuffer, shot.camera);
    journal.note(fmt::format("system {}: at {:.4g} m", system.name, system.z));
  }
  return systems;
}

}  // namespace pellucid
