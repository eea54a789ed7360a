#include "tests/reference/traced_picture.h"

#include <algorithm>
#include <cmath>

#include "tests/reference/triangles.h"

namespace pellucid::reference {
namespace {

// Optical depth of the air between two depths on a ray.
//   farthest  metres, beyond which there is none
double airBetween(const EvenAir& air, double farthest, const Ray& ray, double first, double last) {
  const double metres = glm::length(ray.along);
  last = std::min(last, farthest / metres);
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

constexpr double kFarAway = 1e30;  // metres: farther than anything
constexpr double kOfClear = 0.05;  // of its coverage: what a clear surface weighs in the mean of displacements

bool bends(const PictureScene& scene, const Coat& coat) {
  const Filling& filling = coat.filling;
  return coat.glass && filling.thickness > 0.0 && filling.index != 1.0 && scene.bending.until != Bending::Until::never;
}

}  // namespace

bool hidesAll(const Layer& layer) {
  return layer.coverage >= 1.0 && layer.transmission == Rgb{};
}

Picture::Picture(const PictureScene& scene) : scene_(scene) {
  for (const Mesh& mesh : scene_.meshes) {
    anyBends_ = anyBends_ || bends(scene_, mesh.coat);
    Ball around{Vec3(0.0), 0.0};
    for (const Corner& corner : mesh.corners) around.centre += corner.at / static_cast<double>(mesh.corners.size());
    for (const Corner& corner : mesh.corners)
      around.radius = std::max(around.radius, 1.000001 * glm::length(corner.at - around.centre));
    around_.push_back(around);
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
      // Devices tell it by differences in the two by two pixels of which this is one.
      for (const double aside : {-1.0, 0.0, 1.0})
        for (const double first : {-1.0, 0.0}) {
          most = std::max(most, glm::length(placeAt(x + first + 1.0, y + aside) - placeAt(x + first, y + aside)));
          most = std::max(most, glm::length(placeAt(x + aside, y + first + 1.0) - placeAt(x + aside, y + first)));
        }
    });
  }
  return most;
}

Crossing Picture::crossingOf(const Place& place, const Ray& ray, double z) const {
  const Coat& coat = place.mesh.coat;
  const Vec3 toEye = -glm::normalize(ray.along);
  const double cosine = glm::dot(place.normal, toEye);
  Crossing crossing{{}, 1.0 / std::abs(cosine), place.mesh.on};
  Layer& layer = crossing.layer;
  layer.coverage = place.covered;
  layer.z = z;
  Vec3 shows(place.colour), through(0.0);
  if (coat.glass || coat.finish.lit) {
    const Finished surface = finishedOf(coat, place.colour);
    const Reflected lamps = lampLight(place, toEye);
    shows = coat.emission + reflectedEvenly(surface, std::abs(cosine)) * scene_.surroundings + lamps.light;
    crossing.lightOff = lamps.off;
    through = passedPart(surface, std::abs(cosine));
    if (cosine > 0.0) through *= leftByFilling(coat.filling);
  }
  if (cosine > 0.0 && bends(scene_, coat) && through != Vec3(0.0)) {
    const glm::dmat3 eyeFromWorld = glm::transpose(scene_.eye.axes);
    const double hidden = place.covered * (1.0 - (through.r + through.g + through.b) / 3.0);
    crossing.bend = Bend{eyeFromWorld * (place.at - scene_.eye.at),
                         eyeFromWorld * toEye,
                         eyeFromWorld * place.normal,
                         dispersedIndex(coat.filling.index, coat.filling.dispersion),
                         coat.filling.thickness,
                         hidden + kOfClear * place.covered};
  }
  layer.reflected = {shows.r, shows.g, shows.b};
  layer.transmission = {through.r, through.g, through.b};
  return crossing;
}

Column Picture::columnAt(double x, double y, const CutBand& band) const {
  Column column;
  column.ray = rayThrough(scene_.eye, x, y);
  column.opaque = nearestSolid(scene_, column.ray);
  for (std::size_t m = 0; m < scene_.meshes.size(); ++m) {
    const Mesh& mesh = scene_.meshes[m];
    eachNear(m, x, y, [&](const std::array<int, 3>& triangle, const Vec3(&corners)[3]) {
      const auto within = meet(column.ray, corners);
      if (!within || !(within->facing < 0.0 || hasBothSides(mesh.coat))) return;
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
      const Vec3 at = column.ray.from + within->z * column.ray.along;
      Crossing crossing = crossingOf({mesh, triangle, at, within->normal, colour, covered}, column.ray, within->z);
      crossing.mesh = static_cast<int>(m);
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
  const bool endsOnNothing =
      airEnd == kNothing && std::none_of(column.crossings.begin(), column.crossings.end(),
                                         [](const Crossing& crossing) { return hidesAll(crossing.layer); });
  const double farthest = scene_.air.farthest.value_or(endsOnNothing ? kAirBeforeNothing : kFarAway);
  const auto passAir = [&](double end) {
    const double through = std::exp(-airBetween(scene_.air, farthest, column.ray, reached, std::min(end, airEnd)));
    shown.light += shown.transmission * (1.0 - through) * scene_.air.light;
    shown.transmission *= through;
    reached = std::max(reached, end);
  };
  const auto isBefore = [&](const Crossing& crossing) {
    return (face.solid >= 0 && crossing.on == face) || crossing.layer.z <= z;
  };
  const auto solid = std::find_if(column.crossings.begin(), column.crossings.end(), [&](const Crossing& crossing) {
    return isBefore(crossing) && hidesAll(crossing.layer);
  });
  for (auto crossing = column.crossings.begin(); crossing != solid; ++crossing)
    if (crossing->bend && isBefore(*crossing)) shown.bends.push_back(*crossing->bend);
  const bool showsSolid = !shown.bends.empty() && solid != column.crossings.end();
  if (showsSolid) shown.solidZ = solid->layer.z;
  for (auto crossing = column.crossings.begin(); crossing != (showsSolid ? solid : column.crossings.end());
       ++crossing) {
    if (!isBefore(*crossing)) continue;
    passAir(crossing->layer.z);
    const Layer& layer = crossing->layer;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto channel = static_cast<glm::length_t>(c);
      shown.light[channel] += shown.transmission[channel] * (layer.coverage * layer.reflected[c] + layer.additive[c]);
      shown.lightOff[channel] += shown.transmission[channel] * layer.coverage * crossing->lightOff[channel];
      shown.transmission[channel] *= 1.0 - layer.coverage * (1.0 - layer.transmission[c]);
    }
  }
  passAir(std::min(airEnd, shown.solidZ));
  return shown;
}

Vec4 Picture::background(const Column& column) const {
  if (column.opaque.face.solid < 0) return Vec4(0.0);
  const Solid& solid = scene_.solids[static_cast<std::size_t>(column.opaque.face.solid)];
  const Vec3 point = column.ray.from + column.opaque.z * column.ray.along;
  return {solid.colour + std::sin(glm::dot(solid.across, point)) * solid.stripes, 1.0};
}

Vec4 Picture::at(const Column& column) const {
  const Shown shown = shownBefore(column);
  const Vec4 behind = background(column);
  const double passed = (shown.transmission.r + shown.transmission.g + shown.transmission.b) / 3.0;
  return {shown.over(Vec3(behind)), 1.0 - (1.0 - behind.a) * passed};
}

}  // namespace pellucid::reference
