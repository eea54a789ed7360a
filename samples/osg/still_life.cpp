#include "samples/osg/still_life.h"

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "samples/generate/glb.h"

namespace pellucid::osgsample {
namespace {

using samples::Mesh;

Mesh sphere(glm::dvec3 centre, double radius) {
  constexpr int kPoints = 25;
  std::vector<glm::dvec2> profile;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 3.14159265358979 * (i / (kPoints - 1.0) - 0.5);
    profile.emplace_back(std::max(radius * std::cos(angle), 0.0), radius * std::sin(angle));
  }
  Mesh mesh = samples::lathe(profile, 2, 64);
  for (glm::vec3& position : mesh.positions) position += glm::vec3(centre);
  return mesh;
}

// Its middle at the bottom edge; turned about y, radians.
Mesh pane(glm::dvec3 foot, double wide, double high, double turn) {
  Mesh mesh;
  const glm::dvec3 right = wide * glm::dvec3(std::cos(turn), 0.0, -std::sin(turn));
  samples::addQuad(mesh, foot - 0.5 * right, right, {0.0, high, 0.0});
  mesh.uvs.clear();
  return mesh;
}

Mesh box(glm::dvec3 low, glm::dvec3 high) {
  Mesh mesh;
  const glm::dvec3 size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  samples::addQuad(mesh, low + z, x, y);
  samples::addQuad(mesh, low + x, -x, y);
  samples::addQuad(mesh, low, z, y);
  samples::addQuad(mesh, high - y, -z, y);
  samples::addQuad(mesh, low + y + z, x, -z);
  samples::addQuad(mesh, low, x, z);
  mesh.uvs.clear();
  return mesh;
}

Part opaque(const Mesh& mesh, glm::vec3 colour) {
  Part part;
  part.mesh = mesh;
  part.colour = colour;
  return part;
}

Part glass(const std::string& name, const Mesh& mesh, glm::vec3 colour, float roughness = 0.0f,
           float thickness = 0.0f) {
  Part part = opaque(mesh, colour);
  part.name = name;
  part.transmission = 1.0f;
  part.roughness = roughness;
  part.thickness = thickness;
  return part;
}

}  // namespace

Scene stillLife(int width, int height) {
  Scene scene;
  scene.view.eye = {0.06, 0.42, 1.55};
  scene.view.target = {0.03, 0.17, 0.0};
  scene.view.yfov = 0.5;
  scene.view.width = width;
  scene.view.height = height;

  scene.opaque.push_back(opaque(box({-2.0, -0.05, -0.9}, {2.0, 0.0, 1.2}), {0.52f, 0.42f, 0.3f}));
  scene.opaque.push_back(opaque(box({-2.0, 0.0, -0.95}, {2.0, 1.2, -0.9}), {0.72f, 0.7f, 0.66f}));
  for (int i = -6; i <= 6; ++i) {
    const float t = static_cast<float>(i + 6) / 12.0f;
    const double x = 0.13 * i, high = i % 2 ? 0.42 : 0.6;
    scene.opaque.push_back(opaque(box({x - 0.035, 0.0, -0.8}, {x + 0.035, high, -0.73}),
                                  {0.75f - 0.6f * t, 0.18f + 0.35f * std::fabs(2 * t - 1), 0.12f + 0.6f * t}));
  }
  scene.opaque.push_back(opaque(box({0.26, 0.0, 0.23}, {0.4, 0.1, 0.37}), {0.2f, 0.22f, 0.26f}));
  scene.opaque.push_back(opaque(sphere({-0.06, 0.05, 0.3}, 0.05), {0.8f, 0.55f, 0.08f}));
  scene.opaque.push_back(opaque(sphere({0.02, 0.13, -0.1}, 0.05), {0.75f, 0.12f, 0.1f}));  // inside the bubbles

  // Bubbles that run through each other: no order of whole parts is right.
  scene.transparent.push_back(glass("red", sphere({-0.12, 0.2, -0.08}, 0.17), {0.95f, 0.35f, 0.3f}));
  scene.transparent.push_back(glass("green", sphere({0.06, 0.2, 0.02}, 0.17), {0.35f, 0.9f, 0.45f}));
  scene.transparent.push_back(glass("blue", sphere({0.0, 0.34, -0.12}, 0.16), {0.35f, 0.5f, 0.98f}));
  scene.transparent.push_back(glass("yellow", pane({-0.45, 0.001, 0.05}, 0.34, 0.36, 0.7), {0.98f, 0.85f, 0.2f}));
  scene.transparent.push_back(glass("cyan", pane({-0.45, 0.001, 0.05}, 0.34, 0.44, -0.5), {0.2f, 0.85f, 0.9f}));
  scene.transparent.push_back(
      glass("frosted", pane({0.52, 0.001, -0.25}, 0.42, 0.46, -0.25), {0.95f, 0.97f, 0.98f}, 0.5f));
  scene.transparent.push_back(glass("ball", sphere({0.33, 0.22, 0.3}, 0.12), {0.97f, 0.99f, 0.98f}, 0.0f, 0.2f));
  Part haze = opaque(pane({0.0, 0.001, 0.0}, 0.9, 0.14, 0.25), {0.9f, 0.88f, 0.84f});
  haze.name = "haze";
  haze.coverage = 0.45f;
  scene.transparent.push_back(haze);
  return scene;
}

void writeGlb(const std::string& path, const Scene& scene) {
  samples::Glb glb;
  for (const Part& part : scene.transparent) {
    nlohmann::json material = samples::glass(part.name, glm::dvec3(part.colour), static_cast<double>(part.ior),
                                             static_cast<double>(part.roughness));
    material["pbrMetallicRoughness"]["baseColorFactor"][3] = part.coverage;
    if (part.transmission == 0.0f) {
      material["extensions"].erase("KHR_materials_transmission");
      material["alphaMode"] = "BLEND";
    }
    if (part.thickness > 0.0f) {
      material["doubleSided"] = false;
      material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", part.thickness}};
    }
    glb.addMesh(part.name, part.mesh, glb.addMaterial(material));
  }
  glb.addCamera("camera", scene.view);
  const std::vector<unsigned char> bytes = glb.bytes();
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw std::runtime_error(path + ": could not be written");
}

}  // namespace pellucid::osgsample
