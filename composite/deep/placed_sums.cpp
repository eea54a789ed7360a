#include "composite/deep/placed_sums.h"

#include <fmt/format.h>

#include <cstring>

namespace pellucid {
namespace {

template <class Texel>
void putAtPlaces(const HeldOutRow& row, const Image<Texel>& from, Image<Texel>& to) {
  for (std::size_t entry = 0; entry < from.size(); ++entry) to[row.place[entry]] = from[entry];
}

}  // namespace

Window placesWindow(const DeepOpaque& opaque) {
  const auto width = static_cast<std::size_t>(opaque.data.width());
  return {0, 0, opaque.data.width(), static_cast<int>((placesOf(opaque) + width - 1) / width)};
}

HeldOutRow rowOfPlaces(const DeepOpaque& opaque) {
  HeldOutRow row;
  for (std::size_t pixel = 0; pixel < opaque.offsets.size(); ++pixel)
    row.first.push_back(opaque.offsets[pixel] + pixel);
  row.first.back() = placesOf(opaque);
  row.bends.assign(placesOf(opaque), 0);
  return row;
}

std::string placesText(const DeepOpaque& opaque) {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  const auto add = [&](std::uint64_t value) { hash = (hash ^ value) * 1099511628211u; };
  for (const std::uint64_t offset : opaque.offsets) add(offset);
  for (const OpaqueSample& sample : opaque.samples) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &sample.z, sizeof bits);
    add(bits);
  }
  return fmt::format("{} places of a deep picture, {:016x}", placesOf(opaque), hash);
}

void putAtPlaces(const HeldOutRow& row, const OitPlanes& sums, OitPlanes& placed) {
  putAtPlaces(row, sums.radiance, placed.radiance);
  putAtPlaces(row, sums.weight, placed.weight);
  putAtPlaces(row, sums.opacity, placed.opacity);
  putAtPlaces(row, sums.depth, placed.depth);
  putAtPlaces(row, sums.light, placed.light);
  putAtPlaces(row, sums.frontZ, placed.frontZ);
  putAtPlaces(row, sums.solid, placed.solid);
  if (!sums.scatters()) return;
  addScatterPlanes(placed);
  putAtPlaces(row, sums.refraction, placed.refraction);
  putAtPlaces(row, sums.diffuseZ, placed.diffuseZ);
}

Veil veilOfPlaces(const HeldOutRow& places, const Veil& placed, const OitPlanes* scatter, const LookupSettings& lookup,
                  const DeepOpaque& opaque, const GBuffer& background) {
  const int width = opaque.data.width(), height = opaque.data.height();
  Veil veil(width, height);
  veil.addScatter();
  Image<glm::vec3> lookedUp(width, height, glm::vec3(0.0f));
  addHeldOut(opaque.data, places, placed, opaque, scatter, veil, lookedUp);
  if (scatter) {
    const Backdrop backdrop = backdropOf(background, scatter->solid);
    showThroughHeldOut(Lookups(backdrop, *scatter, lookup), lookedUp, veil);
  }
  return veil;
}

Veil resolvePlaces(const OitPlanes& placed, const OitPlanes& scatter, const ResolveSettings& settings,
                   const LookupSettings& lookup, const DeepOpaque& opaque, const GBuffer& background) {
  HeldOutRow places = rowOfPlaces(opaque);
  for (std::size_t i = 0; i < places.bends.size() && placed.scatters(); ++i)
    places.bends[i] = placed.refraction[i].z > 0.0f || placed.refraction[i].w > 0.0f;
  return veilOfPlaces(places, resolve(placed, settings), scatter.scatters() ? &scatter : nullptr, lookup, opaque,
                      background);
}

}  // namespace pellucid
