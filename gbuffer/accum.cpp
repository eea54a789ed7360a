#include "gbuffer/accum.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

void expectSame(const char* what, const std::string& found, const std::string& expected) {
  if (found != expected)
    throw MeaningError(
        fmt::format("OIT planes: {}: found {}, expected {} as in the planes before", what, found, expected));
}

std::string windowText(const Window& window) {
  return fmt::format("({} {}) - ({} {})", window.x0, window.y0, window.x1 - 1, window.y1 - 1);
}

bool sameProjection(const Camera& a, const Camera& b) {
  return a.viewFromWorld == b.viewFromWorld && a.orthographic == b.orthographic && a.focal == b.focal &&
         a.centre == b.centre;
}

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
  expectSame("display window", windowText(b.display), windowText(a.display));
  expectSame("data window", windowText(b.data), windowText(a.data));
  expectSame("method", b.info.method, a.info.method);
  expectSame("weight", weightText(b.info.weight), weightText(a.info.weight));
  expectSame("normalisation", std::to_string(b.info.normalisation), std::to_string(a.info.normalisation));
  expectSame("tier", b.info.tier, a.info.tier);
  expectSame("solid hash", b.info.solidHash, a.info.solidHash);
  if (!sameProjection(a.camera, b.camera))
    throw MeaningError("OIT planes: camera: found another position or lens, expected that of the planes before");
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
