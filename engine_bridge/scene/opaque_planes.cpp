#include "engine_bridge/scene/opaque_planes.h"

#include <algorithm>
#include <limits>

#include "engine_bridge/scene/blocks.h"

namespace pellucid {
namespace {

constexpr std::size_t kLongestName = 200;  // EXR channel names hold 255 bytes

template <class Vector>
Image<float> component(const Image<Vector>& image, int c) {
  Image<float> plane(image.width(), image.height());
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = image[i][c];
  return plane;
}

ExtraLayer colourLayer(const std::string& name, const Image<glm::vec3>& image) {
  return {name, {{"R", component(image, 0)}, {"G", component(image, 1)}, {"B", component(image, 2)}}};
}

// Channel names are printable, and dots part layers.
std::string channelSafe(std::string name) {
  for (char& c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x21 || byte == 0x7f || c == '.') c = '_';
  }
  if (name.size() > kLongestName) name.resize(kLongestName);
  return name.empty() ? "light" : name;
}

}  // namespace

OpaquePlanes emptyOpaquePlanes(const Window& window, const std::vector<std::string>& lights, bool occlusion,
                               bool indirect, bool emission) {
  const int width = window.width(), height = window.height();
  OpaquePlanes planes;
  planes.window = window;
  planes.beauty = Image<glm::vec4>(width, height, glm::vec4(0.0f));
  planes.viewZ = Image<float>(width, height, std::numeric_limits<float>::infinity());
  planes.normal = planes.albedo = Image<glm::vec3>(width, height, glm::vec3(0.0f));
  if (occlusion) planes.occlusion = Image<float>(width, height, 1.0f);
  for (const std::string& name : lights)
    planes.lights.push_back({name, Image<glm::vec3>(width, height, glm::vec3(0.0f))});
  if (indirect) planes.indirect = Image<glm::vec3>(width, height, glm::vec3(0.0f));
  if (emission) planes.emission = Image<glm::vec3>(width, height, glm::vec3(0.0f));
  return planes;
}

std::vector<std::string> lightLayerNames(const std::vector<Light>& lights) {
  std::vector<std::string> names;
  for (const Light& light : lights) {
    if (!shines(light)) continue;
    const std::string stem = channelSafe(light.name);
    std::string name = stem;
    for (int copy = 2; std::find(names.begin(), names.end(), name) != names.end(); ++copy)
      name = stem + "_" + std::to_string(copy);
    names.push_back(name);
  }
  return names;
}

bool opaqueEmits(const Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    const Primitive& primitive = scene.primitives.at(static_cast<std::size_t>(instance.primitive));
    const Material& material = scene.materials.at(static_cast<std::size_t>(primitive.material));
    return !material.transparent() && (material.unlit || material.emission != glm::vec3(0.0f));
  });
}

void sumBeauty(OpaquePlanes& planes, std::size_t i, glm::vec3 behind, float alpha) {
  glm::vec3 sum = planes.emission.empty() ? glm::vec3(0.0f) : planes.emission[i];
  for (const LightPlane& light : planes.lights) sum += light.radiance[i];
  if (!planes.indirect.empty()) sum += planes.indirect[i];
  planes.beauty[i] = glm::vec4(sum + behind, alpha);
}

std::vector<ExtraLayer> layersOf(const OpaquePlanes& planes) {
  ExtraLayer main{"", {}};
  const char* names[] = {"R", "G", "B", "A"};
  for (int c = 0; c < 4; ++c) main.channels.emplace_back(names[c], component(planes.beauty, c));
  main.channels.emplace_back("Z", planes.viewZ);
  if (!planes.occlusion.empty()) main.channels.emplace_back("AO", planes.occlusion);
  std::vector<ExtraLayer> layers{std::move(main)};
  layers.push_back(
      {"N",
       {{"X", component(planes.normal, 0)}, {"Y", component(planes.normal, 1)}, {"Z", component(planes.normal, 2)}}});
  layers.push_back(colourLayer("albedo", planes.albedo));
  for (const LightPlane& light : planes.lights) layers.push_back(colourLayer("light." + light.name, light.radiance));
  if (!planes.indirect.empty()) layers.push_back(colourLayer("indirect", planes.indirect));
  if (!planes.emission.empty()) layers.push_back(colourLayer("emission", planes.emission));
  return layers;
}

}  // namespace pellucid
