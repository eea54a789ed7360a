#pragma once
// What one layer scatters, on its way to the sums or to a list. Of a list, what records have no room for is in columns
// (gbuffer/fragments.h): OUTPUT_LIST stores them, REPLAY reads them.
#include "shared/refraction.glsl"

struct Scattered {
  Scatter scatter;
  vec4 dispersion;  // offset of red minus that of green, of blue minus that of green
};

// Into the sums: of gl/sums_output.glsl, after writeSums().
#define WRITE_SCATTERED(layer, here) writeScatter(layer, here.scatter, here.dispersion)

Scattered scattersNothing() {
  Scattered here;
  here.scatter.offset = vec2(0.0f);
  here.scatter.variance = 0.0f;
  here.dispersion = vec4(0.0f);
  return here;
}

#ifdef OUTPUT_LIST
#ifdef DISPERSION
layout(std430, binding = 7) writeonly buffer Dispersions { vec4 dispersions[]; };  // one per fragment
#endif

void storeColumns(uint place, Scattered here) {
#ifdef DISPERSION
  dispersions[place] = here.dispersion;
#endif
}
#endif

#ifdef REPLAY
#ifdef DISPERSION
layout(std430, binding = 7) readonly buffer Dispersions { vec4 dispersions[]; };
#endif

Scattered withColumns(Scattered here, uint place) {
#ifdef DISPERSION
  here.dispersion = dispersions[place];
#endif
  return here;
}
#endif
