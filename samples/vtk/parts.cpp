#include "samples/vtk/parts.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace pellucid::vtksample {
namespace {

using nlohmann::json;

constexpr double kPi = 3.14159265358979323846;

double dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The same on every machine.
class Numbers {
 public:
  double operator()() {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_ = 88172645463325252ull;
};

}  // namespace

Vec Part::corner(int i) const {
  const double a = i == 1 || i == 2 ? 1 : -1, b = i >= 2 ? 1 : -1;
  return centre + a * across + b * up;
}

Scene::Scene(int count, int wide, int high) : width(wide), height(high) {
  Numbers random;
  const double reach = std::tan(0.5 * degrees * kPi / 180), aspect = static_cast<double>(width) / height;
  wall = {{0, 0, -20}, {21 * reach * aspect, 0, 0}, {0, 21 * reach, 0}, {200, 180, 160, 255}};
  for (int i = 0; i < count; ++i) {
    Part part;
    const double z = 3 + 14 * random();
    part.centre = {(2 * random() - 1) * z * reach * aspect, (2 * random() - 1) * z * reach, -z};
    const double size = z * reach * (0.15 + 0.5 * random()), turn = 2 * kPi * random(), tilt = 0.3 * (random() - 0.5);
    part.across = {size * std::cos(turn), size * std::sin(turn), size * tilt};
    part.up = {-size * std::sin(turn), size * std::cos(turn), 0};
    for (std::size_t c = 0; c < 3; ++c) part.colour[c] = static_cast<unsigned char>(10 + 235 * random());
    part.colour[3] = static_cast<unsigned char>(25 + 150 * random());
    parts.push_back(part);
  }
  truth_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  struct Hit {
    double z;
    const Part* part;
  };
  std::vector<Hit> hits;
  std::size_t all = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vec ray{(2 * (x + 0.5) / width - 1) * reach * aspect, (2 * (y + 0.5) / height - 1) * reach, -1};
      hits.clear();
      for (const Part& part : parts) {
        const Vec normal = cross(part.across, part.up);
        const double t = dot(part.centre, normal) / dot(ray, normal);
        const Vec from = t * ray + -1.0 * part.centre;
        if (t > 0 && std::abs(dot(from, part.across)) <= dot(part.across, part.across) &&
            std::abs(dot(from, part.up)) <= dot(part.up, part.up))
          hits.push_back({t, &part});
      }
      all += hits.size();
      std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.z > b.z; });
      std::array<double, 3> pixel{wall.colour[0] / 255.0, wall.colour[1] / 255.0, wall.colour[2] / 255.0};
      for (const Hit& hit : hits)
        for (std::size_t c = 0; c < 3; ++c) {
          const double alpha = hit.part->colour[3] / 255.0;
          pixel[c] = pixel[c] * (1 - alpha) + alpha * hit.part->colour[c] / 255.0;
        }
      truth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = pixel;
    }
  layers_ = static_cast<double>(all) / static_cast<double>(truth_.size());
}

void Scene::writeGlb(const std::string& path) const {
  std::string bytes;
  json doc{{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"extensionsUsed", {"KHR_materials_unlit"}}};
  json nodes = json::array(), roots = json::array();
  const auto view = [&](const void* data, std::size_t size) {
    doc["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}});
    bytes.append(static_cast<const char*>(data), size);
    return doc["bufferViews"].size() - 1;
  };
  const std::uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
  doc["accessors"].push_back(
      {{"bufferView", view(indices, sizeof indices)}, {"componentType", 5125}, {"count", 6}, {"type", "SCALAR"}});
  for (const Part& part : parts) {
    float corners[4][3], least[3] = {1e9f, 1e9f, 1e9f}, most[3] = {-1e9f, -1e9f, -1e9f};
    for (int i = 0; i < 4; ++i) {
      const Vec at = part.corner(i);
      const double place[3] = {at.x, at.y, at.z};
      for (int k = 0; k < 3; ++k) {
        corners[i][k] = static_cast<float>(place[k]);
        least[k] = std::min(least[k], corners[i][k]), most[k] = std::max(most[k], corners[i][k]);
      }
    }
    doc["accessors"].push_back({{"bufferView", view(corners, sizeof corners)},
                                {"componentType", 5126},
                                {"count", 4},
                                {"type", "VEC3"},
                                {"min", {least[0], least[1], least[2]}},
                                {"max", {most[0], most[1], most[2]}}});
    json colour = json::array();
    for (const unsigned char c : part.colour) colour.push_back(c / 255.0);
    doc["materials"].push_back({{"alphaMode", "BLEND"},
                                {"doubleSided", true},
                                {"pbrMetallicRoughness", {{"baseColorFactor", colour}}},
                                {"extensions", {{"KHR_materials_unlit", json::object()}}}});
    doc["meshes"].push_back({{"primitives",
                              {{{"attributes", {{"POSITION", doc["accessors"].size() - 1}}},
                                {"indices", 0},
                                {"material", doc["materials"].size() - 1}}}}});
    roots.push_back(nodes.size());
    nodes.push_back({{"mesh", doc["meshes"].size() - 1}});
  }
  doc["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", degrees * kPi / 180}, {"znear", 0.5}}}}};
  roots.push_back(nodes.size());
  nodes.push_back({{"camera", 0}, {"name", "cam"}});
  doc["nodes"] = nodes;
  doc["scenes"] = {{{"nodes", roots}}};
  doc["buffers"] = {{{"byteLength", bytes.size()}}};
  std::string text = doc.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  const std::uint32_t header[5] = {0x46546c67, 2, static_cast<std::uint32_t>(28 + text.size() + bytes.size()),
                                   static_cast<std::uint32_t>(text.size()), 0x4e4f534a};
  const std::uint32_t binary[2] = {static_cast<std::uint32_t>(bytes.size()), 0x004e4942};
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(header), sizeof header);
  file << text;
  file.write(reinterpret_cast<const char*>(binary), sizeof binary);
  file << bytes;
  if (!file) throw std::runtime_error(path + ": could not be written");
}

void Scene::writeWall(const std::string& path) const {
  std::vector<float> texels;
  for (int i = 0; i < width * height; ++i)
    texels.insert(texels.end(),
                  {static_cast<float>(wall.colour[0]) / 255.0f, static_cast<float>(wall.colour[1]) / 255.0f,
                   static_cast<float>(wall.colour[2]) / 255.0f, 1.0f, 20.0f});
  OIIO::ImageSpec spec(width, height, 5, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"R", "G", "B", "A", "Z"};
  const auto file = OIIO::ImageOutput::create(path);
  if (!file || !file->open(path, spec) || !file->write_image(OIIO::TypeDesc::FLOAT, texels.data()) || !file->close())
    throw std::runtime_error(path + ": could not be written");
}

}  // namespace pellucid::vtksample
