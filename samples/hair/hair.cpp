// A head of hair: ribbons of 20% coverage, as many as one likes. PT17 fig. 22.
#include <algorithm>
#include <cmath>

#include "samples/generate/hash.h"
#include "samples/generate/sample.h"
#include "samples/hair/strand.h"

namespace pellucid::samples {
namespace {

constexpr double kWidth = 1.3e-3;       // metres, at the root: each stands for some hairs
constexpr double kFineWidth = 4.5e-4;   // with --hairs
constexpr int kSegments = 40;           // of a hair of the shipped sample
constexpr int kFineSegments = 240;      // with --hairs: 480 triangles a hair, as in the paper's figure
constexpr std::uint32_t kHairs = 6000;  // of the shipped sample
constexpr std::uint32_t kHairsInMesh = 4096;
constexpr float kCoverage = 0.2f;

// Kajiya, Kay: Rendering Fur with Three Dimensional Textures, 1989, with a second, coloured highlight; baked, so that
// what the picture shows of transparency is transparency.
glm::dvec3 baked(const Strand& strand, double t, glm::dvec3 tangent, glm::dvec3 outward, glm::dvec3 toEye,
                 glm::dvec3 toSun) {
  const glm::dvec3 root(0.11, 0.04, 0.014), tip(0.36, 0.15, 0.05);
  const glm::dvec3 colour = glm::mix(root, tip, std::min(1.0, 0.15 + 0.9 * t)) * (1.0 + 0.3 * strand.shade);
  const auto sine = [&](glm::dvec3 v, double shift) {
    const double along = glm::dot(glm::normalize(tangent + shift * outward), v);
    return std::sqrt(std::max(0.0, 1.0 - along * along));
  };
  const glm::dvec3 half = glm::normalize(toSun + toEye);
  const double open = 0.35 + 0.65 * (1.0 - strand.depth);  // hair over hair
  const double facing = std::clamp(0.35 + 0.75 * glm::dot(outward, toSun), 0.0, 1.0) * open;
  const double diffuse = sine(toSun, 0.0) * facing;
  const double white = std::pow(sine(half, 0.06), 120.0) * facing;
  const double tinted = std::pow(sine(half, -0.1), 30.0) * facing;
  return colour * (0.5 * open + 1.7 * diffuse + 1.1 * tinted) + 0.5 * glm::dvec3(1.0, 0.93, 0.82) * white;
}

// A ribbon that faces the eye, thinner and clearer towards its tip.
void addHair(Mesh& mesh, const Strand& strand, double width, glm::dvec3 eye, glm::dvec3 toSun) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const std::size_t last = strand.points.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(last);
    const glm::dvec3 p = strand.points[i];
    const glm::dvec3 tangent = glm::normalize(strand.points[std::min(i + 1, last)] - strand.points[i ? i - 1 : 0]);
    const glm::dvec3 toEye = glm::normalize(eye - p), side = glm::normalize(glm::cross(tangent, toEye));
    const glm::dvec3 normal = glm::cross(side, tangent);
    const glm::dvec3 axis(0.0, std::clamp(p.y, 1.3, kSkull.centre.y), kSkull.centre.z);
    const glm::dvec3 light = baked(strand, t, tangent, glm::normalize(p - axis), toEye, toSun);
    const double half = 0.5 * width * (1.0 - 0.75 * t * t * t);
    for (const double sign : {-1.0, 1.0}) {
      mesh.positions.emplace_back(p + sign * half * side);
      mesh.normals.emplace_back(normal);
      mesh.colours.emplace_back(glm::clamp(light, 0.0, 1.0), 1.0 - t * t * t * t);
    }
    if (i == last) continue;
    const std::uint32_t a = first + 2 * static_cast<std::uint32_t>(i);
    mesh.indices.insert(mesh.indices.end(), {a, a + 1, a + 3, a, a + 3, a + 2});
  }
}

Sample headOf(std::uint32_t hairs, int segments, double width) {
  Sample sample;
  sample.view.eye = {0.85, 1.57, 0.75};
  sample.view.target = {0.0, 1.475, 0.0};
  sample.view.yfov = 0.42;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(0.75, 0.9, -0.1));
  studio.sunIrradiance = {3.0, 2.85, 2.6};
  studio.ambient = {0.3, 0.32, 0.36};
  studio.ambientReach = 0.2;
  const Albedo linen = plain({0.6, 0.52, 0.44}), wood = plain({0.3, 0.17, 0.09});
  for (const Ball& ball : kBody)
    studio.shapes.push_back({ShapeKind::sphere, ball.centre, glm::dvec3(ball.radius), 0.0, linen});
  // Under hair the skin is dark, as between so many of them.
  studio.shapes.front().albedo = [](glm::dvec3 p) {
    return growsHair((p - kSkull.centre) / kSkull.radius) ? glm::dvec3(0.1, 0.045, 0.02) : glm::dvec3(0.6, 0.52, 0.44);
  };
  studio.shapes.push_back({ShapeKind::cylinder, {0.0, 1.43, -0.01}, {0.045, 0.06, 0.0}, 0.0, linen});
  studio.shapes.push_back({ShapeKind::cylinder, {0.0, 1.35, -0.01}, {0.016, 0.08, 0.0}, 0.0, wood});
  studio.shapes.push_back({ShapeKind::cylinder, {0.0, 1.268, -0.01}, {0.09, 0.012, 0.0}, 0.0, wood});
  studio.shapes.push_back({ShapeKind::box, {0.0, 1.206, 0.0}, {3.0, 0.05, 3.0}, 0.0, plain({0.34, 0.36, 0.38})});
  studio.shapes.push_back({ShapeKind::box, {-0.9, 1.5, -0.8}, {4.0, 3.0, 0.05}, 0.85, [](glm::dvec3 p) {
                             return glm::dvec3(0.3, 0.36, 0.4) * (0.55 + 0.3 * (p.y - 1.0));
                           }});

  const int material = sample.glb.addMaterial(
      {{"name", "hair"},
       {"alphaMode", "BLEND"},
       {"doubleSided", true},
       {"pbrMetallicRoughness", {{"baseColorFactor", {1.0, 1.0, 1.0, kCoverage}}, {"metallicFactor", 0.0}}},
       {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}});
  for (std::uint32_t start = 0; start < hairs; start += kHairsInMesh) {
    Mesh mesh;
    for (std::uint32_t i = start; i < std::min(hairs, start + kHairsInMesh); ++i)
      addHair(mesh, growStrand(i, segments), width, sample.view.eye, studio.toSun);
    sample.glb.addMesh("hair " + std::to_string(start / kHairsInMesh), mesh, material);
  }
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace

Sample hair() {
  return headOf(kHairs, kSegments, kWidth);
}

Sample fineHair(std::uint32_t hairs) {
  return headOf(hairs, kFineSegments, kFineWidth);
}

}  // namespace pellucid::samples
