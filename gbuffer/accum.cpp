#include "gbuffer/accum.h"

#include <algorithm>
#include <limits>

#include "gbuffer/planes_match.h"

namespace pellucid {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

void add(Image<glm::vec4>& to, const Image<glm::vec4>& from) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
}

}  // namespace

OitPlanes emptyPlanes(const Window& display, const Window& data) {
  OitPlanes planes;
  planes.display = display;
  planes.data = data;
  const int width = data.width(), height = data.height();
  for (Image<glm::vec4>* sums : {&planes.radiance, &planes.weight, &planes.opacity, &planes.depth, &planes.light})
    *sums = Image<glm::vec4>(width, height, glm::vec4(0.0f));
  planes.frontZ = Image<float>(width, height, kNothing);
  planes.solid = Image<glm::vec4>(width, height, glm::vec4(0.0f, 0.0f, 0.0f, kNothing));
  return planes;
}

OitPlanes emptyPublishedPlanes(const Window& display, const Window& data) {
  OitPlanes planes = emptyPlanes(display, data);
  planes.info.tier = "published";
  planes.info.normalisation = shading::PLD_NORMALISE_PUBLISHED;
  planes.depth = Image<glm::vec4>(data.width(), data.height(), glm::vec4(1.0f, 1.0f, 1.0f, 0.0f));
  return planes;
}

void addScatterPlanes(OitPlanes& planes) {
  if (planes.scatters()) return;
  const int width = planes.data.width(), height = planes.data.height();
  planes.refraction = Image<glm::vec4>(width, height, glm::vec4(0.0f));
  planes.diffuseZ = Image<float>(width, height, kNothing);
}

void addDispersionPlane(OitPlanes& planes) {
  addScatterPlanes(planes);
  if (!planes.disperses())
    planes.dispersion = Image<glm::vec4>(planes.data.width(), planes.data.height(), glm::vec4(0.0f));
}

void mergePlanes(OitPlanes& a, const OitPlanes& b) {
  mergePlanes(a, b, "the planes before", "OIT planes");
}

void mergePlanes(OitPlanes& a, const OitPlanes& b, const std::string& fileA, const std::string& fileB) {
  expectSamePlanes(b, fileB, a, fileA);
  add(a.radiance, b.radiance);
  add(a.weight, b.weight);
  add(a.opacity, b.opacity);
  if (a.published())
    for (std::size_t i = 0; i < a.depth.size(); ++i) a.depth[i] *= b.depth[i];
  else
    add(a.depth, b.depth);
  add(a.light, b.light);
  if (b.scatters()) {
    addScatterPlanes(a);
    add(a.refraction, b.refraction);
    if (a.published())  // offsets are summed there, and their weight only says whether there is one
      for (std::size_t i = 0; i < a.refraction.size(); ++i) a.refraction[i].z = std::min(a.refraction[i].z, 1.0f);
    for (std::size_t i = 0; i < a.diffuseZ.size(); ++i) a.diffuseZ[i] = std::min(a.diffuseZ[i], b.diffuseZ[i]);
  }
  if (b.disperses()) {
    addDispersionPlane(a);
    add(a.dispersion, b.dispersion);
  }
  for (std::size_t i = 0; i < a.frontZ.size(); ++i) a.frontZ[i] = std::min(a.frontZ[i], b.frontZ[i]);
  for (std::size_t i = 0; i < a.solid.size(); ++i)
    if (b.solid[i].a < a.solid[i].a) a.solid[i] = b.solid[i];
}

}  // namespace pellucid
