#include "samples/engine/engine_scene.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <limits>
#include <sstream>
#include <utility>

#include "samples/engine/engine_shading.h"

namespace engine {
namespace {

void addBox(Scene& scene, glm::vec3 centre, glm::vec3 half, glm::vec3 colour) {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  for (int face = 0; face < 6; ++face) {
    glm::vec3 normal(0.0f), u(0.0f), v(0.0f);
    normal[face / 2] = face % 2 ? 1.0f : -1.0f;
    u[(face / 2 + 1) % 3] = 1.0f;
    v = glm::cross(normal, u);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const auto& corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)})
      vertices.push_back(
          {centre + half * (normal + corner.x * u + corner.y * v), normal, glm::vec4(1.0f), glm::vec2(0.0f)});
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + i);
  }
  Material material;
  material.base = glm::vec4(colour, 1.0f);
  addMesh(scene, vertices, indices, glm::mat4(1.0f), material);
}

}  // namespace

void addMesh(Scene& scene, const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices,
             const glm::mat4& worldFromObject, const Material& material) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  scene.meshes.push_back({static_cast<std::uint32_t>(scene.indices.size()), static_cast<std::uint32_t>(indices.size()),
                          worldFromObject, material});
  scene.vertices.insert(scene.vertices.end(), vertices.begin(), vertices.end());
  for (const std::uint32_t i : indices) scene.indices.push_back(first + i);
}

void addRoom(Scene& scene) {
  const glm::vec3 centre = 0.5f * (scene.least + scene.most), size = scene.most - scene.least;
  const float r = std::max(size.x, std::max(size.y, size.z));
  const glm::vec3 eye = glm::vec3(glm::inverse(scene.viewFromWorld)[3]);
  const glm::vec3 away = glm::normalize((centre - eye) * glm::vec3(1, 0, 1));
  const glm::vec3 side = glm::normalize(glm::cross(away, glm::vec3(0, 1, 0)));
  const float floor = scene.least.y - 1e-3f * r;
  const auto block = [&](float across, float behind, float half, float high, glm::vec3 colour) {
    addBox(scene, glm::vec3(centre.x, floor + high, centre.z) + side * across * r + away * behind * r,
           glm::vec3(half * r, high, half * r), colour);
  };
  addBox(scene, {centre.x, floor - 0.05f * r, centre.z}, {6 * r, 0.05f * r, 6 * r}, {0.6f, 0.55f, 0.45f});
  for (int i = -4; i <= 4; ++i)
    block(0.35f * static_cast<float>(i), 1.6f, 0.1f, (i % 2 ? 0.5f : 0.9f) * size.y,
          {0.15f + 0.08f * static_cast<float>(i + 4), 0.3f, 0.8f - 0.08f * static_cast<float>(i + 4)});
  block(-0.3f, 0.7f, 0.07f, 0.25f * size.y, {0.8f, 0.65f, 0.1f});
  block(0.15f, -0.75f, 0.02f, 0.2f * size.y, {0.75f, 0.1f, 0.1f});  // stands in front
}

void stop(const std::string& why) {
  std::fprintf(stderr, "engine: %s\n", why.c_str());
  std::exit(1);
}

glm::mat4 clipFromView(const Scene& scene, int width, int height) {
  const float f = 1.0f / std::tan(0.5f * scene.yfov);
  const float across = f * static_cast<float>(height) / static_cast<float>(width);
  return glm::mat4(across, 0, 0, 0, 0, f, 0, 0, 0, 0, 0, -1, 0, 0, kNear, 0);
}

SceneNumbers sceneNumbers(const Scene& scene, int width, int height, bool rowsUp) {
  const glm::vec3 toSun = glm::normalize(glm::mat3(scene.viewFromWorld) * scene.toSun);
  const float rows = rowsUp ? 1.0f : -1.0f;
  SceneNumbers numbers{clipFromView(scene, width, height), glm::vec4(toSun, 0.0f), glm::vec4(scene.sun, 0.0f),
                       glm::vec4(kAmbient, rows)};
  numbers.clipFromView[1][1] *= rows;
  return numbers;
}

MeshNumbers meshNumbers(const glm::mat4& viewFromWorld, const Mesh& mesh) {
  const Material& material = mesh.material;
  return {viewFromWorld * mesh.worldFromObject,
          material.base,
          {material.roughness, material.transmission, material.ior, material.thickness},
          material.cutoff,
          material.unlit,
          material.texture,
          static_cast<std::int32_t>(mesh.firstIndex)};
}

Asked askedFor(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream all(text);
  for (std::string word; std::getline(all, word, ',');) words.push_back(word);
  const std::string first = words.empty() ? "" : words[0], method = first.substr(0, first.find(':')),
                    tier = method == first ? "float" : first.substr(method.size() + 1);
  const char* const methods[] = {"phenomenological", "weighted", "front+tail"};
  const char* const tiers[] = {"float", "half", "published", "exact"};
  const auto numberOf = [](const char* const* begin, const char* const* end, const std::string& name) {
    const auto place = std::find(begin, end, name);
    if (place == end) stop("no method, tier or feature " + name);
    return static_cast<int>(place - begin);
  };
  Asked asked{};
  asked.method = static_cast<pld_method>(numberOf(std::begin(methods), std::end(methods), method));
  asked.tier = static_cast<pld_tier>(numberOf(std::begin(tiers), std::end(tiers), tier));
  asked.features = PLD_FEATURE_COLOURED;
  if (asked.tier != PLD_TIER_PUBLISHED) asked.features |= PLD_FEATURE_LIGHT;
  if (asked.method == PLD_METHOD_PHENOMENOLOGICAL) asked.features |= PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION;
  const char* const features[] = {"rims", "low", "shadows"};
  constexpr uint32_t bits[] = {PLD_FEATURE_RIMS, PLD_FEATURE_LOW_RESOLUTION, 0};  // shadow maps are no feature
  for (std::size_t i = 1; i < words.size(); ++i) {
    const int feature = numberOf(std::begin(features), std::end(features), words[i]);
    asked.features |= bits[feature];
    asked.shadows |= feature == 2;
  }
  return asked;
}

Arguments argumentsOf(int count, char** arguments, const std::string& usage) {
  if (count < 3 || count > 6) stop(usage);
  Arguments found;
  found.glass = arguments[1], found.folder = arguments[2];
  if (count > 5) found.last = arguments[5];
  if (count > 3 &&
      (std::sscanf(arguments[3], "%dx%d", &found.width, &found.height) != 2 || found.width < 1 || found.height < 1))
    stop("expected WIDTHxHEIGHT");
  found.asked = askedFor(count > 4 ? arguments[4] : "phenomenological");
  return found;
}

bool isDrawnIn(pld_stage stage, const Material& material, uint32_t features) {
  const bool low = material.lowResolution && features & PLD_FEATURE_LOW_RESOLUTION;
  if (stage == PLD_STAGE_LOW) return low;
  if (stage == PLD_STAGE_CASTERS) return !material.opaque();
  if (stage == PLD_STAGE_RIMS) return material.cutoff > 0.0f;
  return !low && (!material.opaque() || material.cutoff > 0.0f);
}

pld_shadow_info shadowMaps() {
  pld_shadow_info maps = pld_shadow_info_init(1024, 1, 1);
  maps.uniform_binding = kShadowTableBinding;
  maps.texture_unit = kShadowMapsBinding;
  return maps;
}

SunView sunViewOf(const Scene& scene) {
  const glm::vec3 centre = 0.5f * (scene.least + scene.most);
  const float r = 0.5f * glm::length(scene.most - scene.least);
  const glm::vec3 up = std::abs(scene.toSun.y) > 0.99f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  SunView sun{glm::lookAt(centre + 2.0f * r * scene.toSun, centre, up), pld_shadow_view_init(PLD_LIGHT_DIRECTIONAL)};
  sun.view.near_depth = r, sun.view.far_depth = 3.0f * r;
  const glm::mat4 lightFromView = sun.lightFromWorld * glm::inverse(scene.viewFromWorld);
  glm::mat4 clipFromLight(1.0f / r);  // orthographic; reversed depth
  clipFromLight[2][2] = 0.5f / r;
  clipFromLight[3] = glm::vec4(0.0f, 0.0f, 1.5f, 1.0f);
  std::memcpy(sun.view.light_from_scene, glm::value_ptr(lightFromView), sizeof(sun.view.light_from_scene));
  std::memcpy(sun.view.projection, glm::value_ptr(clipFromLight), sizeof(sun.view.projection));
  return sun;
}

SceneNumbers sceneNumbers(const SunView& sun) {
  SceneNumbers numbers{};
  numbers.clipFromView = glm::make_mat4(sun.view.projection);
  return numbers;
}

pld_frame frameOf(const Scene& scene, int width, int height) {
  pld_frame frame = pld_frame_init();
  frame.width = width;
  frame.height = height;
  const glm::mat4 projection = clipFromView(scene, width, height);
  std::memcpy(frame.projection, glm::value_ptr(projection), sizeof(frame.projection));
  frame.weight_far = 100.0f;
  frame.refract = PLD_REFRACT_AT_DEPTH;
  return frame;
}

void writePicture(const std::string& path, int width, int height, const std::vector<float>& colour,
                  const std::vector<float>& depth, bool fromTop) {
  std::vector<float> rows;
  const auto across = static_cast<std::size_t>(width), down = static_cast<std::size_t>(height);
  for (std::size_t row = 0; row < down; ++row) {
    const std::size_t y = fromTop ? row : down - 1 - row;
    for (std::size_t i = y * across; i < (y + 1) * across; ++i) {
      for (std::size_t c = 0; c < 4; ++c) rows.push_back(colour[4 * i + c]);
      rows.push_back(depth[i] > 0.0f ? kNear / depth[i] : std::numeric_limits<float>::infinity());
    }
  }
  OIIO::ImageSpec spec(width, height, 5, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"R", "G", "B", "A", "Z"};
  spec.alpha_channel = 3;
  spec.z_channel = 4;
  const auto file = OIIO::ImageOutput::create(path);
  if (!file || !file->open(path, spec) || !file->write_image(OIIO::TypeDesc::FLOAT, rows.data()) || !file->close())
    stop(path + ": could not be written");
}

}  // namespace engine
