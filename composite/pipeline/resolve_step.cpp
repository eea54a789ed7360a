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

}  // namespace

Veil resolveSums(ResolvePass* device, OitPlanes planes, const ResolveSettings& settings, const LookupSettings& lookup,
                 const GBuffer& background) {
  if (!device) return resolveOver(std::move(planes), settings, lookup, background);
  DeviceResolveSettings same;
  same.selfModulation = settings.selfModulation;
  same.kernel = lookup.kernel;
  same.exact = lookup.exact;
  same.published = planes.published();
  return veilOf(device->resolve(planes, background, same), planes);
}

}  // namespace pellucid
