#include "gbuffer/accum.h"

#include <algorithm>
#include <limits>

#include "gbuffer/plane_values.h"
#include "gbuffer/planes_match.h"
#include "gbuffer/weight_reference.h"

namespace pellucid {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

// Adds plane by plane, or takes the nearer depth.
void mergePlane(const PlaneSpec& plane, OitPlanes& a, const OitPlanes& b) {
  const std::size_t pixels = a.radiance.size();
  const bool nearest = plane.blend == PlaneBlend::minimum;
  for (int c = 0; c < plane.components(); ++c) {
    const PlaneValues to = valuesOf(a, plane.sum, c);
    const ConstPlaneValues from = valuesOf(b, plane.sum, c);
    for (std::size_t i = 0; i < pixels; ++i) to[i] = nearest ? std::min(to[i], from[i]) : to[i] + from[i];
  }
}

// Transmission multiplies; offsets are summed, and their weight only says whether there is one.
void mergePublished(OitPlanes& a, const OitPlanes& b) {
  for (std::size_t i = 0; i < a.depth.size(); ++i) a.depth[i] *= b.depth[i];
  for (std::size_t i = 0; i < a.refraction.size(); ++i) a.refraction[i].z = std::min(a.refraction[i].z, 1.0f);
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

OitPlanes emptyScatterPlanes(const Window& display, const Window& data) {
  OitPlanes planes;
  planes.display = display;
  planes.data = data;
  planes.refractionZ = Image<float>(data.width(), data.height(), 0.0f);
  addScatterPlanes(planes);
  return planes;
}

void addScatterPlanes(OitPlanes& planes) {
  if (planes.scatters()) return;
  const int width = planes.data.width(), height = planes.data.height();
  planes.refraction = Image<glm::vec4>(width, height, glm::vec4(0.0f));
  planes.diffuseZ = Image<float>(width, height, kNothing);
}

void addPlane(OitPlanes& planes, PlaneSum sum) {
  if (!isOfScattering(sum)) return;
  addScatterPlanes(planes);
  Image<glm::vec4>& plane = *planes.sums()[static_cast<std::size_t>(sum)];
  if (plane.empty()) plane = Image<glm::vec4>(planes.data.width(), planes.data.height(), glm::vec4(0.0f));
}

void addPlanes(OitPlanes& planes, LayerModel layers) {
  if (layers.scatters()) addScatterPlanes(planes);
  if (planes.published()) layers.tier = PlaneTier::published;
  for (const PlaneSpec& plane : planesOf(layers)) addPlane(planes, plane.sum);
}

void mergePlanes(OitPlanes& a, const OitPlanes& b) {
  mergePlanes(a, b, "the planes before", "OIT planes");
}

void mergePlanes(OitPlanes& a, const OitPlanes& b, const std::string& fileA, const std::string& fileB) {
  expectSamePlanes(b, fileB, a, fileA);
  if (const double factor = referenceFactor(b.info.weight, a.info.weight); factor != 1.0) {
    OitPlanes scaled = b;
    if (!scaleWeights(scaled, factor)) refuseReference(b, fileB, a, fileA);
    scaled.info.weight = a.info.weight;
    return mergePlanes(a, scaled, fileA, fileB);
  }
  addPlanes(a, modelOf(b));
  for (const PlaneSpec& plane : planesOf(modelOf(b)))
    if (!(a.published() && plane.sum == PlaneSum::depth)) mergePlane(plane, a, b);
  if (a.published()) mergePublished(a, b);
  for (std::size_t i = 0; i < a.solid.size(); ++i)
    if (b.solid[i].a < a.solid[i].a) a.solid[i] = b.solid[i];
}

}  // namespace pellucid
