// Reads what a small engine draws from a glTF of the binary kind.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "samples/engine/engine_scene.h"

namespace engine {
namespace {

using nlohmann::json;

struct Gltf {
  json root;
  std::vector<char> bytes;

  const char* at(std::size_t bufferView) const {
    return bytes.data() + root.at("bufferViews").at(bufferView).value("byteOffset", std::size_t{0});
  }
  const char* at(const json& accessor) const {
    return at(accessor.at("bufferView").get<std::size_t>()) + accessor.value("byteOffset", std::size_t{0});
  }
  // An attribute of a primitive, which has `count` vertices; `none` for each where it has no such attribute.
  template <class Vector>
  std::vector<Vector> attribute(const json& primitive, const char* name, std::size_t count, const Vector& none) const {
    std::vector<Vector> values(count, none);
    if (!primitive.at("attributes").contains(name)) return values;
    const json& accessor = root.at("accessors").at(primitive.at("attributes").at(name).get<std::size_t>());
    if (accessor.at("componentType") != 5126 || accessor.at("type") != "VEC" + std::to_string(Vector::length()))
      stop(std::string(name) + " is no float vector of the length that is read here");
    std::memcpy(values.data(), at(accessor), values.size() * sizeof(Vector));
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
  if (source.value("alphaMode", "OPAQUE") == "MASK") material.cutoff = source.value("alphaCutoff", 0.5f);
  if (pbr.contains("baseColorTexture")) material.texture = pbr.at("baseColorTexture").at("index");
  material.lowResolution = source.value("extras", none).value("pellucid", none).value("lowResolution", false);
  material.unlit = more.contains("KHR_materials_unlit");
  material.transmission = more.value("KHR_materials_transmission", none).value("transmissionFactor", 0.0f);
  material.ior = more.value("KHR_materials_ior", none).value("ior", 1.5f);
  material.thickness = more.value("KHR_materials_volume", none).value("thicknessFactor", 0.0f);
  // Light meets a volume's boundary twice, whatever doubleSided says.
  material.bothSides = material.thickness > 0.0f || source.value("doubleSided", false);
  return material;
}

float linearOf(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

// One level smaller: the mean of four texels each.
std::vector<glm::vec4> halved(const std::vector<glm::vec4>& texels, std::size_t edge) {
  std::vector<glm::vec4> half;
  for (std::size_t y = 0; y < edge; y += 2)
    for (std::size_t x = 0; x < edge; x += 2) {
      const glm::vec4* at = &texels[y * edge + x];
      half.push_back(0.25f * (at[0] + at[1] + at[edge] + at[edge + 1]));
    }
  return half;
}

// Reads an image in a bufferView, straight alpha, and appends it to every level of the scene's textures.
void addTexture(Scene& scene, const Gltf& gltf, const json& image) {
  const auto index = image.at("bufferView").get<std::size_t>();
  OIIO::Filesystem::IOMemReader file(const_cast<char*>(gltf.at(index)),
                                     gltf.root.at("bufferViews").at(index).at("byteLength").get<std::size_t>());
  OIIO::ImageSpec straight, found;
  straight["oiio:UnassociatedAlpha"] = 1;
  const auto input = OIIO::ImageInput::create("png");
  if (!input || !input->set_ioproxy(&file) || !input->open("texture.png", found, straight)) stop("a texture is no PNG");
  const OIIO::ImageSpec spec(found.width, found.height, 4, OIIO::TypeDesc::FLOAT);
  std::vector<glm::vec4> texels(spec.image_pixels());
  if (found.nchannels != 4 || !input->read_image(0, 0, 0, 4, spec.format, texels.data()))
    stop("textures have red, green, blue and alpha here");
  for (glm::vec4& one : texels) one = {linearOf(one.r), linearOf(one.g), linearOf(one.b), one.a};
  std::size_t edge = kTextureEdge;
  const OIIO::ROI scaled(0, static_cast<int>(edge), 0, static_cast<int>(edge), 0, 1, 0, 4);
  const OIIO::ImageBuf resized = OIIO::ImageBufAlgo::resize(OIIO::ImageBuf(spec, texels.data()), "triangle", 0, scaled);
  texels.resize(edge * edge);
  if (!resized.get_pixels(scaled, spec.format, texels.data())) stop(resized.geterror());
  for (auto& level : scene.textureLevels) {
    for (const glm::vec4& one : texels) level.push_back(glm::packHalf4x16(one));
    if (edge > 1) texels = halved(texels, edge);
    edge /= 2;
  }
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
      const json& accessors = gltf.root.at("accessors");
      const std::size_t count = accessors.at(primitive.at("attributes").at("POSITION").get<std::size_t>()).at("count");
      const auto positions = gltf.attribute(primitive, "POSITION", count, glm::vec3(0.0f)),
                 normals = gltf.attribute(primitive, "NORMAL", count, glm::vec3(0.0f));
      const auto colours = gltf.attribute(primitive, "COLOR_0", count, glm::vec4(1.0f));
      const auto uvs = gltf.attribute(primitive, "TEXCOORD_0", count, glm::vec2(0.0f));
      std::vector<Vertex> vertices;
      const Material material = materialOf(gltf.root.at("materials").at(primitive.at("material").get<std::size_t>()));
      for (std::size_t i = 0; i < positions.size(); ++i) {
        vertices.push_back({positions[i], normals[i], colours[i], uvs[i]});
        const glm::vec3 place(world * glm::vec4(positions[i], 1.0f));
        scene.least = glm::min(scene.least, place);
        scene.most = glm::max(scene.most, place);
      }
      addMesh(scene, vertices, gltf.indices(accessors.at(primitive.at("indices").get<std::size_t>())), world, material);
    }
  for (const json& child : node.value("children", json::array())) addNode(scene, gltf, child.get<std::size_t>(), world);
}

}  // namespace

Scene readScene(const std::string& path) {
  Scene scene;
  const Gltf gltf = read(path);
  for (const json& root : gltf.root.at("scenes").at(0).at("nodes"))
    addNode(scene, gltf, root.get<std::size_t>(), glm::mat4(1.0f));
  for (const json& texture : gltf.root.value("textures", json::array()))
    addTexture(scene, gltf, gltf.root.at("images").at(texture.at("source").get<std::size_t>()));
  addRoom(scene);
  return scene;
}

}  // namespace engine
