#include "tests/reference/traced_picture.h"

#include <algorithm>
#include <cmath>

#include "tests/reference/texels.h"

namespace pellucid::reference {
namespace {

// Where a ray meets a triangle: the shares of its corners, and planar depth.
struct Within {
  Vec3 shares;
  double z;
  double facing;  // cosine between ray and normal, below 0 from the front
};

// The volumes that a ray spans with a triangle's edges.
Vec3 volumesOf(const Ray& ray, const Vec3 (&corners)[3]) {
  const Vec3 p = corners[0] - ray.from, q = corners[1] - ray.from, r = corners[2] - ray.from;
  return {glm::dot(ray.along, glm::cross(q, r)), glm::dot(ray.along, glm::cross(r, p)),
          glm::dot(ray.along, glm::cross(p, q))};
}

// All of them have one sign where the ray passes between the edges.
std::optional<Within> meet(const Ray& ray, const Vec3 (&corners)[3]) {
  const Vec3 volumes = volumesOf(ray, corners);
  const bool above = volumes.x > 0.0 && volumes.y > 0.0 && volumes.z > 0.0;
  const bool below = volumes.x < 0.0 && volumes.y < 0.0 && volumes.z < 0.0;
  if (!above && !below) return std::nullopt;
  const Vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double z = glm::dot(normal, corners[0] - ray.from) / glm::dot(normal, ray.along);
  if (!(z > 0.0)) return std::nullopt;
  return Within{volumes / (volumes.x + volumes.y + volumes.z), z,
                glm::dot(normal, ray.along) / (glm::length(normal) * glm::length(ray.along))};
}

// Of the plane of a triangle, also beyond its edges.
Vec3 sharesOf(const Ray& ray, const Vec3 (&corners)[3]) {
  const Vec3 volumes = volumesOf(ray, corners);
  return volumes / (volumes.x + volumes.y + volumes.z);
}

// In the texture of a coat.
Vec2 placeOf(const Mesh& mesh, const std::array<int, 3>& triangle, const Vec3& shares) {
  Vec2 uv(0.0);
  for (int k = 0; k < 3; ++k)
    uv += shares[k] * mesh.corners[static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)])].uv;
  return Vec2(mesh.coat.fromUv * Vec3(uv, 1.0));
}

// Straight colour of a coat.
Vec4 colourOf(const PictureScene& scene, const Mesh& mesh, const std::array<int, 3>& triangle, const Vec3& shares) {
  Vec4 colour(0.0);
  for (int k = 0; k < 3; ++k)
    colour += shares[k] * mesh.corners[static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)])].colour;
  const Coat& coat = mesh.coat;
  colour *= coat.colour;
  if (coat.texture >= 0)
    colour *= texelAt(scene.textures[static_cast<std::size_t>(coat.texture)], placeOf(mesh, triangle, shares));
  return colour;
}

// Optical depth of the air between two depths on a ray.
double airBetween(const EvenAir& air, const Ray& ray, double first, double last) {
  const double metres = glm::length(ray.along);
  last = std::min(last, air.farthest / metres);
  for (int axis = 0; axis < 3 && air.inside; ++axis) {
    const double from = ray.from[axis] - air.inside->centre[axis], way = ray.along[axis], half = air.inside->half[axis];
    if (way == 0.0) {
      if (std::abs(from) > half) return 0.0;
      continue;
    }
    first = std::max(first, std::min((-half - from) / way, (half - from) / way));
    last = std::min(last, std::max((-half - from) / way, (half - from) / way));
  }
  return air.density * metres * std::max(last - first, 0.0);
}

}  // namespace

Picture::Picture(const PictureScene& scene) : scene_(scene) {
  for (const Mesh& mesh : scene_.meshes) {
    bounds_.emplace_back();
    for (const auto& triangle : mesh.triangles) bounds_.back().push_back(boundsOf(mesh, triangle));
  }
}

// Everything, where a corner is not clearly before the eye.
Picture::Bounds Picture::boundsOf(const Mesh& mesh, const std::array<int, 3>& triangle) const {
  const Eye& eye = scene_.eye;
  Bounds bounds{kNothing, kNothing, -kNothing, -kNothing};
  for (const int index : triangle) {
    const Vec3 at = glm::transpose(eye.axes) * (mesh.corners[static_cast<std::size_t>(index)].at - eye.at);
    if (!eye.parallel && !(-at.z > 1e-3 * glm::length(at))) return {-kNothing, -kNothing, kNothing, kNothing};
    const Vec2 part = Vec2(at) / (eye.parallel ? 1.0 : -at.z) / eye.half;
    const double x = 0.5 * (1.0 + part.x) * eye.displayWidth - eye.firstX;
    const double y = 0.5 * (1.0 - part.y) * eye.displayHeight - eye.firstY;
    bounds = {std::min(bounds.x0, x), std::min(bounds.y0, y), std::max(bounds.x1, x), std::max(bounds.y1, y)};
  }
  const double margin = 1e-6 * (eye.displayWidth + eye.displayHeight + std::abs(bounds.x1) + std::abs(bounds.y1));
  return {bounds.x0 - margin, bounds.y0 - margin, bounds.x1 + margin, bounds.y1 + margin};
}

template <class Take>
void Picture::eachNear(std::size_t mesh, double x, double y, const Take& take) const {
  const Mesh& it = scene_.meshes[mesh];
  for (std::size_t t = 0; t < it.triangles.size(); ++t) {
    const Bounds& in = bounds_[mesh][t];
    if (x < in.x0 || x > in.x1 || y < in.y0 || y > in.y1) continue;
    const auto at = [&](std::size_t k) { return it.corners[static_cast<std::size_t>(it.triangles[t][k])].at; };
    const Vec3 corners[3] = {at(0), at(1), at(2)};
    take(it.triangles[t], corners);
  }
}

double Picture::texelsAPixel(double x, double y) const {
  const Ray ray = rayThrough(scene_.eye, x, y);
  double most = 0.0;
  for (std::size_t m = 0; m < scene_.meshes.size(); ++m) {
    const Mesh& mesh = scene_.meshes[m];
    if (mesh.coat.texture < 0) continue;
    const Texels& texels = scene_.textures[static_cast<std::size_t>(mesh.coat.texture)];
    eachNear(m, x, y, [&](const std::array<int, 3>& triangle, const Vec3(&corners)[3]) {
      if (!meet(ray, corners)) return;
      const auto placeAt = [&](double u, double v) {
        return placeOf(mesh, triangle, sharesOf(rayThrough(scene_.eye, u, v), corners)) *
               Vec2(texels.width, texels.height);
      };
      for (const Vec2 half : {Vec2(0.5, 0.0), Vec2(0.0, 0.5)})
        most = std::max(most, glm::length(placeAt(x + half.x, y + half.y) - placeAt(x - half.x, y - half.y)));
    });
  }
  return most;
}

Column Picture::columnAt(double x, double y, const CutBand& band) const {
  Column column;
  column.ray = rayThrough(scene_.eye, x, y);
  column.opaque = nearestSolid(scene_, column.ray);
  for (std::size_t m = 0; m < scene_.meshes.size(); ++m) {
    const Mesh& mesh = scene_.meshes[m];
    eachNear(m, x, y, [&](const std::array<int, 3>& triangle, const Vec3(&corners)[3]) {
      const auto within = meet(column.ray, corners);
      if (!within || !(within->facing < 0.0 || mesh.coat.bothSides)) return;
      const Vec4 colour = colourOf(scene_, mesh, triangle, within->shares);
      double covered = std::clamp(colour.a, 0.0, 1.0);
      if (mesh.coat.covering == Covering::mask) {
        const auto alphaAt = [&](double u, double v) {
          return colourOf(scene_, mesh, triangle, sharesOf(rayThrough(scene_.eye, u, v), corners)).a;
        };
        // From pixel to pixel, in the row or column of the place or beside it.
        const auto change = [&](double dx, double dy) {
          double most = 0.0;
          for (const double k : {-1.0, 0.0, 1.0}) {
            const double u = x + k * dy, v = y + k * dx, here = alphaAt(u, v);
            most = std::max({most, std::abs(alphaAt(u + dx, v + dy) - here), std::abs(alphaAt(u - dx, v - dy) - here)});
          }
          return most;
        };
        const bool banded = band.side != 0 && (band.mesh < 0 || band.mesh == static_cast<int>(m));
        const double half = banded ? 0.5 * band.edge * (change(1.0, 0.0) + change(0.0, 1.0)) : 0.0;
        const int side = band.against == static_cast<int>(m) ? -band.side : band.side;
        covered = colour.a + side * half >= mesh.coat.cutoff ? 1.0 : 0.0;
      }
      if (!(covered > 0.0)) return;
      Crossing crossing{{}, 1.0 / std::abs(within->facing), mesh.on, static_cast<int>(m)};
      crossing.layer.coverage = covered;
      const Vec3 shows = mesh.coat.glass ? mesh.coat.emission : Vec3(colour);
      crossing.layer.reflected = {shows.r, shows.g, shows.b};
      if (mesh.coat.glass) crossing.layer.transmission = {colour.r, colour.g, colour.b};
      crossing.layer.z = within->z;
      column.crossings.push_back(crossing);
    });
  }
  std::sort(column.crossings.begin(), column.crossings.end(),
            [](const Crossing& a, const Crossing& b) { return a.layer.z < b.layer.z; });
  return column;
}

Shown Picture::shownBefore(const Column& column, const Face& face, double z, double airEnd) const {
  Shown shown;
  double reached = 0.0;
  const auto passAir = [&](double end) {
    const double through = std::exp(-airBetween(scene_.air, column.ray, reached, std::min(end, airEnd)));
    shown.light += shown.transmission * (1.0 - through) * scene_.air.light;
    shown.transmission *= through;
    reached = std::max(reached, end);
  };
  for (const Crossing& crossing : column.crossings) {
    const bool touches = face.solid >= 0 && crossing.on == face;
    if (!touches && crossing.layer.z > z) continue;
    passAir(crossing.layer.z);
    const Layer& layer = crossing.layer;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto channel = static_cast<glm::length_t>(c);
      shown.light[channel] += shown.transmission[channel] * (layer.coverage * layer.reflected[c] + layer.additive[c]);
      shown.transmission[channel] *= 1.0 - layer.coverage * (1.0 - layer.transmission[c]);
    }
  }
  passAir(airEnd);
  return shown;
}

Vec4 Picture::background(const Column& column) const {
  if (column.opaque.face.solid < 0) return Vec4(0.0);
  return {scene_.solids[static_cast<std::size_t>(column.opaque.face.solid)].colour, 1.0};
}

Vec4 Picture::at(const Column& column) const {
  const Shown shown = shownBefore(column);
  const Vec4 behind = background(column);
  const double passed = (shown.transmission.r + shown.transmission.g + shown.transmission.b) / 3.0;
  return {shown.over(Vec3(behind)), 1.0 - (1.0 - behind.a) * passed};
}

}  // namespace pellucid::reference
