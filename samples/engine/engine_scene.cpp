#include "samples/engine/engine_scene.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace engine {
namespace {

using nlohmann::json;

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
      vertices.push_back({centre + half * (normal + corner.x * u + corner.y * v), normal});
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + i);
  }
  Mesh mesh;
  mesh.vertices = std::move(vertices);
  mesh.indices = std::move(indices);
  mesh.material.base = glm::vec4(colour, 1.0f);
  scene.meshes.push_back(std::move(mesh));
}

// A floor, a wall and blocks around what is transparent: something to be seen through it.
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

struct Gltf {
  json root;
  std::vector<char> bytes;

  const char* at(const json& accessor) const {
    const json& view = root.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    return bytes.data() + view.value("byteOffset", std::size_t{0}) + accessor.value("byteOffset", std::size_t{0});
  }
  std::vector<glm::vec3> vectors(const json& accessor) const {
    if (accessor.at("componentType") != 5126 || accessor.at("type") != "VEC3")
      stop("positions and normals are float here");
    std::vector<glm::vec3> values(accessor.at("count").get<std::size_t>());
    std::memcpy(values.data(), at(accessor), values.size() * sizeof(glm::vec3));
    return values;
  }
  std::vector<std::uint32_t> indices(const json& accessor) const {
    std::vector<std::uint32_t> values(accessor.at("count").get<std::size_t>());
    const int kind = accessor.at("componentType");
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (kind == 5125) std::memcpy(&values[i], at(accessor) + 4 * i, 4);
      std::uint16_t two = 0;
      if (kind == 5123) std::memcpy(&two, at(accessor) + 2 * i, 2), values[i] = two;
      if (kind == 5121) values[i] = static_cast<unsigned char>(at(accessor)[i]);
    }
    return values;
  }
};

Gltf read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> all((std::istreambuf_iterator<char>(file)), {});
  std::uint32_t header[5] = {};
  if (all.size() >= 28) std::memcpy(header, all.data(), sizeof header);
  if (header[0] != 0x46546c67 || all.size() < 28 + std::size_t{header[3]}) stop(path + ": no GLB");
  Gltf gltf;
  gltf.root = json::parse(all.data() + 20, all.data() + 20 + header[3]);
  gltf.bytes.assign(all.begin() + 28 + header[3], all.end());
  return gltf;
}

glm::mat4 transformOf(const json& node) {
  if (node.contains("matrix")) return glm::make_mat4(node["matrix"].get<std::vector<float>>().data());
  const auto t = node.value("translation", std::vector<float>{0, 0, 0}),
             s = node.value("scale", std::vector<float>{1, 1, 1}),
             q = node.value("rotation", std::vector<float>{0, 0, 0, 1});
  return glm::translate(glm::mat4(1.0f), glm::vec3(t[0], t[1], t[2])) *
         glm::mat4_cast(glm::quat(q[3], q[0], q[1], q[2])) * glm::scale(glm::mat4(1.0f), glm::vec3(s[0], s[1], s[2]));
}

Material materialOf(const json& source) {
  Material material;
  const json none = json::object(), pbr = source.value("pbrMetallicRoughness", none),
             more = source.value("extensions", none);
  const auto base = pbr.value("baseColorFactor", std::vector<float>{1, 1, 1, 1});
  material.base = glm::vec4(base[0], base[1], base[2], base[3]);
  material.roughness = pbr.value("roughnessFactor", 1.0f);
  material.blend = source.value("alphaMode", "OPAQUE") == "BLEND";
  material.unlit = more.contains("KHR_materials_unlit");
  material.transmission = more.value("KHR_materials_transmission", none).value("transmissionFactor", 0.0f);
  material.ior = more.value("KHR_materials_ior", none).value("ior", 1.5f);
  material.thickness = more.value("KHR_materials_volume", none).value("thicknessFactor", 0.0f);
  // Light meets a volume's boundary twice, whatever doubleSided says.
  material.bothSides = material.thickness > 0.0f || source.value("doubleSided", false);
  return material;
}

void addNode(Scene& scene, const Gltf& gltf, std::size_t index, const glm::mat4& parent) {
  const json& node = gltf.root.at("nodes").at(index);
  const glm::mat4 world = parent * transformOf(node);
  if (node.contains("camera")) {
    scene.viewFromWorld = glm::inverse(world);
    scene.yfov = gltf.root.at("cameras").at(node["camera"].get<std::size_t>()).at("perspective").at("yfov");
  }
  if (node.contains("extensions") && node["extensions"].contains("KHR_lights_punctual")) {
    const json& lights = gltf.root.at("extensions").at("KHR_lights_punctual").at("lights");
    const json& light = lights.at(node["extensions"]["KHR_lights_punctual"].at("light").get<std::size_t>());
    const auto colour = light.value("color", std::vector<float>{1, 1, 1});
    scene.toSun = glm::normalize(glm::vec3(world[2]));
    scene.sun = glm::vec3(colour[0], colour[1], colour[2]) * (light.value("intensity", 1.0f) / 683.0f);  // lux
  }
  if (node.contains("mesh"))
    for (const json& primitive : gltf.root.at("meshes").at(node["mesh"].get<std::size_t>()).at("primitives")) {
      const json &accessors = gltf.root.at("accessors"), &attributes = primitive.at("attributes");
      const auto positions = gltf.vectors(accessors.at(attributes.at("POSITION").get<std::size_t>()));
      const auto normals = gltf.vectors(accessors.at(attributes.at("NORMAL").get<std::size_t>()));
      std::vector<Vertex> vertices;
      const Material material = materialOf(gltf.root.at("materials").at(primitive.at("material").get<std::size_t>()));
      for (std::size_t i = 0; i < positions.size(); ++i) {
        vertices.push_back({positions[i], normals[i]});
        const glm::vec3 place(world * glm::vec4(positions[i], 1.0f));
        scene.least = glm::min(scene.least, place);
        scene.most = glm::max(scene.most, place);
      }
      Mesh mesh;
      mesh.vertices = std::move(vertices);
      mesh.indices = gltf.indices(accessors.at(primitive.at("indices").get<std::size_t>()));
      mesh.worldFromObject = world;
      mesh.material = material;
      scene.meshes.push_back(std::move(mesh));
    }
  for (const json& child : node.value("children", json::array())) addNode(scene, gltf, child.get<std::size_t>(), world);
}

}  // namespace

void stop(const std::string& why) {
  std::fprintf(stderr, "engine: %s\n", why.c_str());
  std::exit(1);
}

Scene readScene(const std::string& path) {
  Scene scene;
  const Gltf gltf = read(path);
  for (const json& root : gltf.root.at("scenes").at(0).at("nodes"))
    addNode(scene, gltf, root.get<std::size_t>(), glm::mat4(1.0f));
  addRoom(scene);
  return scene;
}

glm::mat4 clipFromView(const Scene& scene, int width, int height) {
  const float f = 1.0f / std::tan(0.5f * scene.yfov);
  const float across = f * static_cast<float>(height) / static_cast<float>(width);
  return glm::mat4(across, 0, 0, 0, 0, f, 0, 0, 0, 0, 0, -1, 0, 0, kNear, 0);
}

Asked askedFor(const std::string& text) {
  const std::string method = text.substr(0, text.find(':')),
                    tier = method == text ? "float" : text.substr(method.size() + 1);
  const char* const methods[] = {"phenomenological", "weighted", "front+tail"};
  const char* const tiers[] = {"float", "half", "published", "exact"};
  const auto numberOf = [](const char* const* begin, const char* const* end, const std::string& name) {
    const auto place = std::find(begin, end, name);
    if (place == end) stop("no method or tier " + name);
    return static_cast<int>(place - begin);
  };
  Asked asked{};
  asked.method = static_cast<pld_method>(numberOf(std::begin(methods), std::end(methods), method));
  asked.tier = static_cast<pld_tier>(numberOf(std::begin(tiers), std::end(tiers), tier));
  asked.features = PLD_FEATURE_COLOURED;
  if (asked.tier != PLD_TIER_PUBLISHED) asked.features |= PLD_FEATURE_LIGHT;
  if (asked.method == PLD_METHOD_PHENOMENOLOGICAL) asked.features |= PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION;
  return asked;
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
