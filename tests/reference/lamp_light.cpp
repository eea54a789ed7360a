// What a place of a mesh shows of lamps, and what other meshes and solids leave of their light.
#include <algorithm>
#include <cmath>

#include "tests/reference/traced_picture.h"
#include "tests/reference/triangles.h"

namespace pellucid::reference {
namespace {

constexpr double kTilt = 2e-6;  // of normals and directions that are floats
// Nearer to a place, as a part of its distance from the eye, whether something stands before it floats do not tell.
constexpr double kUnsure = 3e-5;

}  // namespace

// Of light on its way to a place, what a mesh leaves.
Picture::Left Picture::leftBy(const Mesh& mesh, const Ray& towards, const Place& place, double metres,
                              double unsure) const {
  struct Hit {
    Vec3 left;
    bool facesLamp, sure;
  };
  std::vector<Hit> hits;
  for (const auto& triangle : mesh.triangles) {
    if (&triangle == &place.triangle) continue;
    const auto at = [&](std::size_t k) { return mesh.corners[static_cast<std::size_t>(triangle[k])].at; };
    const Vec3 corners[3] = {at(0), at(1), at(2)};
    const auto within = meet(towards, corners);
    if (!within || within->z > metres) continue;
    const Vec4 colour = colourOf(scene_, mesh, triangle, within->shares);
    const bool cut = mesh.coat.covering == Covering::mask;
    const double covered = cut ? (colour.a >= mesh.coat.cutoff ? 1.0 : 0.0) : std::clamp(colour.a, 0.0, 1.0);
    const double cosine = std::abs(within->facing);
    const bool facesLamp = within->facing > 0.0;
    Vec3 through(0.0);
    if (mesh.coat.glass) through = passedPart(finishedOf(mesh.coat, colour), cosine);
    if (facesLamp) through *= leftByFilling(mesh.coat.filling);
    const double index = mesh.coat.filling.thickness > 0.0 ? mesh.coat.filling.index : 1.0;
    hits.push_back({leftByCaster(covered * (1.0 - through), cosine, index), facesLamp,
                    within->z > unsure && within->z < metres - unsure});
  }
  const auto leftBy = [&](bool all) {
    // Of a closed mesh with one side, light that has entered by a face is not counted again where it leaves.
    const bool faced =
        std::any_of(hits.begin(), hits.end(), [&](const Hit& hit) { return (hit.sure || all) && hit.facesLamp; });
    Vec3 left(1.0);
    for (const Hit& hit : hits)
      if ((hit.sure || all) && (hit.facesLamp || !faced || hasBothSides(mesh.coat))) left *= hit.left;
    return left;
  };
  return {leftBy(false), leftBy(true)};
}

Picture::Reflected Picture::arriving(const Place& place, const Sent& sent) const {
  const double unsure = kUnsure * glm::length(place.at - scene_.eye.at);
  const Ray towards{place.at, sent.towards};
  const Met solid = nearestSolid(scene_, towards);
  Vec3 most(1.0), least(1.0);
  if (solid.z < sent.metres) {
    least = Vec3(0.0);
    if (solid.z > unsure && solid.z < sent.metres - unsure) most = Vec3(0.0);
  }
  for (std::size_t m = 0; m < scene_.meshes.size() && most != Vec3(0.0); ++m) {
    if (glm::length(glm::cross(around_[m].centre - place.at, sent.towards)) > around_[m].radius) continue;
    const Left left = leftBy(scene_.meshes[m], towards, place, sent.metres, unsure);
    most *= glm::max(left.surely, left.perhaps);
    least *= glm::min(left.surely, left.perhaps);
  }
  return {0.5 * (most + least), 0.5 * (most - least)};
}

Picture::Reflected Picture::lampLight(const Place& place, const Vec3& toEye) const {
  const Finished surface = finishedOf(place.mesh.coat, place.colour);
  const Vec3 normal = glm::dot(place.normal, toEye) > 0.0 ? place.normal : -place.normal;
  Reflected sum;
  for (const PunctualLamp& lamp : scene_.lamps) {
    const Sent sent = sentBy(lamp, place.at);
    const Vec3 light = reflectedTowards(surface, normal, toEye, sent.towards) * sent.irradiance;
    Vec3 off(0.0);
    for (glm::length_t axis = 0; axis < 3; ++axis)
      for (const double side : {-kTilt, kTilt}) {
        Vec3 tilt(0.0);
        tilt[axis] = side;
        const Vec3 tilted = glm::normalize(normal + tilt);
        off = glm::max(off, glm::abs(reflectedTowards(surface, tilted, toEye, sent.towards) * sent.irradiance - light));
      }
    const bool shadowed = scene_.shadows && sent.irradiance != Vec3(0.0) && light != Vec3(0.0);
    const Reflected part = shadowed ? arriving(place, sent) : Reflected{Vec3(1.0), Vec3(0.0)};
    sum.light += part.light * light;
    sum.off += part.off * (light + off) + part.light * off;
  }
  return sum;
}

}  // namespace pellucid::reference
