#include "composite/pipeline/resolve_step.h"

#include <algorithm>

namespace pellucid {
namespace {

Veil veilOf(const DeviceVeil& device, const OitPlanes& planes) {
  Veil veil(planes.data.width(), planes.data.height());
  if (planes.scatters()) veil.addScatter();
  for (std::size_t i = 0; i < device.light.size(); ++i) {
    const float kind = device.light[i].a;
    if (kind == 0.0f) continue;
    const bool elsewhere = kind == 2.0f;
    veil.touched[i] = 1;
    veil.light[i] = glm::vec3(device.light[i]);
    veil.transmission[i] = glm::vec3(device.transmission[i]);
    veil.frontZ[i] = elsewhere ? planes.frontZ[i] : std::min(planes.frontZ[i], planes.solid[i].a);
    if (!veil.scatters()) continue;
    veil.direct[i] = elsewhere ? glm::vec3(0.0f) : veil.transmission[i];
    if (elsewhere) veil.applied[i] = device.applied[i];
  }
  return veil;
}

// The device knows no edges: what meets them is looked up here.
void showEdges(OitPlanes planes, const LookupSettings& lookup, const GBuffer& background, const EdgeTexels& edges,
               Veil& veil) {
  if (!planes.scatters() || edges.empty()) return;
  PassBackdrop backdrops;
  const BackdropView backdrop = backdrops.of(background, planes.solid, glm::ivec2(0));
  hideSolids(planes);
  const Lookups lookups(backdrop, planes, lookup, glm::ivec2(0), &edges);
  for (int y = 0; y < veil.touched.height(); ++y)
    for (int x = 0; x < veil.touched.width(); ++x)
      if (veil.touched.at(x, y) && lookups.scattersAt(x, y) && lookups.meetsEdges(x, y))
        showThroughAt(lookups, x, y, veil);
}

}  // namespace

Veil resolveSums(ResolvePass* device, OitPlanes planes, const ResolveSettings& settings, const LookupSettings& lookup,
                 const GBuffer& background, const EdgeTexels* edges) {
  if (!device) return resolveOver(std::move(planes), settings, lookup, background, edges);
  DeviceResolveSettings same;
  same.selfModulation = settings.selfModulation;
  same.kernel = lookup.kernel;
  same.exact = lookup.exact;
  same.published = planes.published();
  Veil veil = veilOf(device->resolve(planes, background, same), planes);
  if (edges) showEdges(std::move(planes), lookup, background, *edges, veil);
  return veil;
}

}  // namespace pellucid
