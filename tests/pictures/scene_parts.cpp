#include "tests/pictures/scene_parts.h"

#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "tests/reference/texels.h"

namespace pellucid::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegrees = kPi / 180.0;

// Numbers that a mesh's own coordinates are multiplied with; the nodes undo it.
glm::dmat4 drawnStretch(Random& random, bool proportioned) {
  Vec3 by(1.0);
  if (chance(random, 0.5))
    for (int k = 0; k < 3; ++k) by[k] = std::exp2(random.between(-6.0, 6.0));
  if (proportioned) by = Vec3(by.x);
  for (int k = 0; k < 3; ++k)
    if (chance(random, 0.25)) by[k] = -by[k];
  return glm::scale(glm::dmat4(1.0), by);
}

}  // namespace

double logBetween(Random& random, double low, double high) {
  return low * std::pow(high / low, random.uniform());
}
bool chance(Random& random, double part) {
  return random.uniform() < part;
}
Vec3 drawnColour(Random& random) {
  const auto one = [&] { return (1.0 + random.below(96)) / 64.0; };
  const double r = one(), g = one();
  return {r, g, one()};
}

glm::dmat3 facing(const Vec3& normal, double spin) {
  const Vec3 n = glm::normalize(normal), other = std::abs(n.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 a = glm::normalize(glm::cross(other, n)), b = glm::cross(n, a);
  return {std::cos(spin) * a + std::sin(spin) * b, std::cos(spin) * b - std::sin(spin) * a, n};
}
glm::dmat3 turned(Random& random) {
  const double z = random.between(-1.0, 1.0), angle = random.between(0.0, 2.0 * kPi), r = std::sqrt(1.0 - z * z);
  return facing({r * std::cos(angle), r * std::sin(angle), z}, random.between(0.0, 2.0 * kPi));
}

Sheet quadSheet(double halfWidth, double halfHeight) {
  Sheet sheet;
  for (const Vec2 at : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)}) {
    sheet.points.emplace_back((2.0 * at.x - 1.0) * halfWidth, (2.0 * at.y - 1.0) * halfHeight, 0.0);
    sheet.uv.emplace_back(at.x, 1.0 - at.y);
  }
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  return sheet;
}

Sheet polygonSheet(Random& random, double radius) {
  Sheet sheet;
  const int corners = 3 + static_cast<int>(random.below(12));
  sheet.points.emplace_back(0.0);
  sheet.uv.emplace_back(0.5);
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * kPi * (i + 0.4 * random.uniform()) / corners, r = radius * random.between(0.3, 1.0);
    sheet.points.emplace_back(r * std::cos(angle), r * std::sin(angle), 0.0);
    sheet.uv.emplace_back(0.5 + 0.5 * r / radius * std::cos(angle), 0.5 - 0.5 * r / radius * std::sin(angle));
    sheet.triangles.push_back({0, i + 1, i + 1 < corners ? i + 2 : 1});
  }
  return sheet;
}

Sheet gridSheet(Random& random, int across, double half, double bumps) {
  Sheet sheet;
  for (int j = 0; j <= across; ++j)
    for (int i = 0; i <= across; ++i) {
      const Vec2 at(static_cast<double>(i) / across, static_cast<double>(j) / across);
      sheet.points.emplace_back((2.0 * at.x - 1.0) * half, (2.0 * at.y - 1.0) * half,
                                bumps * random.between(-1.0, 1.0));
      sheet.uv.emplace_back(at.x, 1.0 - at.y);
    }
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < across; ++i) {
      const int a = j * (across + 1) + i, b = a + 1, c = a + across + 2, d = a + across + 1;
      const bool other = chance(random, 0.5);
      sheet.triangles.push_back({a, b, other ? d : c});
      sheet.triangles.push_back({other ? b : a, c, d});
    }
  return sheet;
}

Sheet ballSheet(int across, double radius) {
  Sheet sheet;
  for (int j = 0; j <= across; ++j)
    for (int i = 0; i < 2 * across; ++i) {
      const double up = kPi * j / across, around = kPi * i / across;
      sheet.points.emplace_back(radius * std::sin(up) * std::cos(around), radius * std::cos(up),
                                -radius * std::sin(up) * std::sin(around));
      sheet.uv.emplace_back(i / (2.0 * across), static_cast<double>(j) / across);
    }
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < 2 * across; ++i) {
      const int next = (i + 1) % (2 * across), a = j * 2 * across + i, b = j * 2 * across + next;
      const int c = a + 2 * across, d = b + 2 * across;
      if (j + 1 < across) sheet.triangles.push_back({a, c, d});
      if (j > 0) sheet.triangles.push_back({a, d, b});
    }
  return sheet;
}

Vec3 tilted(Random& random, double most) {
  const double tilt = random.between(0.0, most) * kDegrees, way = random.between(0.0, 360.0) * kDegrees;
  return {std::sin(tilt) * std::cos(way), std::sin(tilt) * std::sin(way), std::cos(tilt)};
}
double drawnSpin(Random& random) {
  return random.between(0.0, 2.0 * std::numbers::pi);
}
double widthAt(const SceneMaker& maker, double z) {
  return maker.half(0) * (maker.parallel() ? 1.0 : z);
}

Sheet drawnSheet(Random& random, double half) {
  switch (random.below(3)) {
    case 0:
      return quadSheet(half * random.between(0.3, 1.0), half * random.between(0.3, 1.0));
    case 1:
      return polygonSheet(random, half);
    default:
      return gridSheet(random, 2 + static_cast<int>(random.below(3)), half, 0.0);
  }
}

SceneMaker::SceneMaker(const std::string& kind, Random& random, double size, double farOff) : random_(random) {
  scene_.kind = kind;
  scene_.size = size;
  scene_.oneColour = chance(random, 0.35);
  one_ = drawnColour(random);
  drawEye(farOff);
}

void SceneMaker::drawEye(double farOff) {
  reference::Eye& eye = scene_.numbers.eye;
  eye.width = 24 + static_cast<int>(random_.below(25));
  eye.height = 16 + static_cast<int>(random_.below(17));
  eye.displayWidth = eye.width;
  eye.displayHeight = eye.height;
  if (chance(random_, 0.2)) {  // a part of the picture, or more than all of it
    eye.firstX = static_cast<int>(random_.below(21)) - 8;
    eye.firstY = static_cast<int>(random_.below(15)) - 6;
    eye.width += static_cast<int>(random_.below(9)) - 4;
    eye.height += static_cast<int>(random_.below(9)) - 4;
  }
  eye.parallel = chance(random_, 0.12);
  const double half = eye.parallel ? 0.5 * scene_.size : std::tan(random_.between(0.1, 0.6));
  eye.half = {half * eye.displayWidth / eye.displayHeight, half};
  eye.axes = chance(random_, 0.2) ? glm::dmat3(1.0) : turned(random_);
  eye.at = Vec3(random_.between(-3, 3), random_.between(-3, 3), random_.between(-3, 3)) * scene_.size;
  if (farOff > 0.0) eye.at += farOff * turned(random_)[0];
  worldFromEye_ = glm::dmat4(eye.axes);
  worldFromEye_[3] = glm::dvec4(eye.at, 1.0);
}

void SceneMaker::look(int width, int height, double half, bool parallel) {
  reference::Eye& eye = scene_.numbers.eye;
  eye.width = eye.displayWidth = width;
  eye.height = eye.displayHeight = height;
  eye.firstX = eye.firstY = 0;
  eye.parallel = parallel;
  eye.half = {half * width / height, half};
}

Vec3 SceneMaker::at(double x, double y, double z) const {
  const double scale = parallel() ? 1.0 : z;
  return {x * half(0) * scale, y * half(1) * scale, -z};
}

int SceneMaker::plane(const Vec3& point, const Vec3& normal) {
  scene_.numbers.solids.push_back(
      {reference::Plane{Vec3(worldFromEye_ * Vec4(point, 1.0)), glm::dmat3(worldFromEye_) * normal},
       drawnColour(random_)});
  return static_cast<int>(scene_.numbers.solids.size()) - 1;
}
int SceneMaker::ball(const Vec3& centre, double radius) {
  scene_.numbers.solids.push_back(
      {reference::Ball{Vec3(worldFromEye_ * Vec4(centre, 1.0)), radius}, drawnColour(random_)});
  return static_cast<int>(scene_.numbers.solids.size()) - 1;
}
int SceneMaker::box(const Vec3& centre, const glm::dmat3& axes, const Vec3& half) {
  scene_.numbers.solids.push_back(
      {reference::Box{Vec3(worldFromEye_ * Vec4(centre, 1.0)), glm::dmat3(worldFromEye_) * axes, half},
       drawnColour(random_)});
  return static_cast<int>(scene_.numbers.solids.size()) - 1;
}

Vec3 SceneMaker::colourOf() {
  return scene_.oneColour ? one_ : drawnColour(random_);
}

reference::Coat SceneMaker::drawnCoat() {
  reference::Coat coat;
  const double alpha = chance(random_, 0.1) ? 1.0 : (1.0 + random_.below(62)) / 64.0;
  coat.colour = Vec4(glm::min(colourOf(), Vec3(1.0)), alpha);
  coat.bothSides = chance(random_, 0.75);
  return coat;
}

PlacedMesh& SceneMaker::place(const Sheet& sheet, const Vec3& origin, const glm::dmat3& axes, bool baked) {
  PlacedMesh mesh;
  // So far out floats do not hold shapes of this size.
  baked = baked && glm::length(scene_.numbers.eye.at) < 100.0 * scene_.size;
  glm::dmat4 worldFromSheet(axes);
  worldFromSheet[3] = glm::dvec4(origin, 1.0);
  worldFromSheet = worldFromEye_ * worldFromSheet;
  const glm::dmat4 stretch = baked ? worldFromSheet : drawnStretch(random_, proportioned_);
  for (const Vec3& point : sheet.points) mesh.points.emplace_back(Vec3(stretch * Vec4(point, 1.0)));
  for (const Vec2& uv : sheet.uv) mesh.uv.emplace_back(uv);
  mesh.triangles = sheet.triangles;
  // A stretch that mirrors turns the order of the corners; glTF turns it back where the nodes mirror.
  if (glm::determinant(glm::dmat3(stretch)) < 0.0)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  if (!baked) {
    glm::dmat4 rest = worldFromSheet * glm::inverse(stretch);
    if (chance(random_, 0.4)) {
      const glm::dmat4 parent = glm::dmat4(turned(random_)) * drawnStretch(random_, proportioned_);
      mesh.nodes.push_back(parent);
      rest = glm::inverse(parent) * rest;
    }
    mesh.nodes.push_back(rest);
  }
  mesh.coat = drawnCoat();
  scene_.placed.push_back(std::move(mesh));
  return scene_.placed.back();
}

PlacedMesh& SceneMaker::placeOn(const reference::Face& face, const Sheet& sheet, const Vec3& origin,
                                const glm::dmat3& axes) {
  PlacedMesh& mesh = place(sheet, origin, axes, chance(random_, 0.2));
  mesh.on = face;
  return mesh;
}

DrawnScene SceneMaker::finish() {
  for (const StoredTexture& stored : scene_.stored) {
    reference::Texels texels{stored.width, stored.height, {}, stored.wrapS, stored.wrapT, stored.nearest};
    for (std::size_t i = 0; i < stored.rgba.size(); i += 4)
      texels.values.emplace_back(reference::lightOf(stored.rgba[i]), reference::lightOf(stored.rgba[i + 1]),
                                 reference::lightOf(stored.rgba[i + 2]), stored.rgba[i + 3] / 255.0);
    scene_.numbers.textures.push_back(std::move(texels));
  }
  for (const PlacedMesh& placed : scene_.placed) {
    glm::dmat4 world(1.0);
    for (const glm::dmat4& node : placed.nodes) world = world * node;
    reference::Mesh mesh;
    for (std::size_t i = 0; i < placed.points.size(); ++i) {
      reference::Corner corner;
      corner.at = Vec3(world * Vec4(Vec3(placed.points[i]), 1.0));
      if (!placed.uv.empty()) corner.uv = Vec2(placed.uv[i]);
      if (!placed.colours.empty()) corner.colour = Vec4(placed.colours[i]);
      mesh.corners.push_back(corner);
    }
    mesh.triangles = placed.triangles;
    // glTF: where the nodes mirror, triangles are seen from their front in the other order.
    if (glm::determinant(glm::dmat3(world)) < 0.0)
      for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    mesh.coat = placed.coat;
    mesh.on = placed.on;
    scene_.numbers.meshes.push_back(std::move(mesh));
  }
  return std::move(scene_);
}

}  // namespace pellucid::test
