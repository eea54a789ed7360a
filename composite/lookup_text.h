// The shared text of the lookup in C++, with the functions by which it reads the picture; the loops over taps that take
// most of the time have a form of lanes with the same bits (wide_gaussian, wide_pyramid).
#pragma once
#include <algorithm>
#include <vector>

#include "composite/gather.h"
#include "composite/spread_pyramid.h"

namespace pellucid::shading {

// What a gather reads of a pixel: its colour, its depth, and D^2, which is -1 where the colour is not finite.
enum TapPlane { kTapColour, kTapDepth = 4, kTapVariance, kTapPlanes };

// What the text reads.
struct LookupSource {
  BackdropView backdrop;
  const EdgeTexels* edges = nullptr;  // none of no texel
  const OitPlanes* planes = nullptr;
  ivec2 placeOfPlanes = ivec2(0);              // their first pixel, in the backdrop
  Window diffusing = {};                       // pixels of the backdrop, all that diffuse among them
  Columns taps = {};                           // of these, by TapPlane
  std::vector<SpreadLevel> spreadLevels = {};  // [0] is level 1

  int width() const { return backdrop.z->width(); }
  int height() const { return backdrop.z->height(); }
};

// The text as it stands.
struct GatherText : LookupSource {
  template <class T>
  static const T& clampedAt(const Image<T>& image, ivec2 place) {
    return image.at(std::clamp(place.x, 0, image.width() - 1), std::clamp(place.y, 0, image.height() - 1));
  }
  const vec4& backdropColour(ivec2 pixel) const { return clampedAt(*backdrop.colour, pixel); }
  float backdropDepth(ivec2 pixel) const { return clampedAt(*backdrop.z, pixel); }
  vec4 ownColour(ivec2 pixel) const {
    const vec4& behind = backdropColour(pixel);
    if (!edges || !edges->at(pixel)) return behind;
    const EdgeTexel& edge = edges->find(pixel);
    return edge.whole == behind ? edge.seen : behind;
  }
  vec4 colourBehind(ivec2 pixel, float layerZ) const {
    const ivec2 held(std::clamp(pixel.x, 0, width() - 1), std::clamp(pixel.y, 0, height() - 1));
    const vec4& behind = backdropColour(held);
    if (!edges || !edges->at(held)) return behind;
    const EdgeTexel& edge = edges->find(held);
    return edge.whole == behind && standsInFront(edge.nearerZ, layerZ) ? edge.farther : behind;
  }
  float spreadAt(ivec2 pixel) const {
    const int x = std::clamp(pixel.x, 0, width() - 1) - placeOfPlanes.x,
              y = std::clamp(pixel.y, 0, height() - 1) - placeOfPlanes.y;
    const bool inside = x >= 0 && y >= 0 && x < planes->refraction.width() && y < planes->refraction.height();
    return inside ? planes->refraction.at(x, y).w : 0.0f;
  }
  SpreadTexel spreadTexel(int level, ivec2 texel) const {
    return spreadLevels[static_cast<std::size_t>(level - 1)].clamped(texel);
  }
  SpreadBody spreadBody(int level, ivec2 texel) const {
    return spreadLevels[static_cast<std::size_t>(level - 1)].clampedBody(texel);
  }

#define PLD_FN inline
#define precise
#include "shaders/shared/gather.glsl"
#undef precise
#undef PLD_FN
};

// The same with lanes.
struct LookupText : GatherText {
  LookupChoice choice = {};

  // All must outlive this.
  //   place  of the planes' first pixel, in pixels of the backdrop
  LookupText(const BackdropView& seen, const OitPlanes& scattering, const LookupSettings& settings, ivec2 place,
             const EdgeTexels* edgesOfPicture = nullptr);
  Gathered gatherSpread(LookupChoice settings, vec2 centre, float variance, float layerZ);

#define PLD_FN inline
#define precise
#include "shaders/shared/path_lookup.glsl"
#undef precise
#undef PLD_FN
};

}  // namespace pellucid::shading
