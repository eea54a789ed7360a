// Opaque G-buffers by ray tracing.
#pragma once
#include <functional>

#include "engine_bridge/embree/environment.h"
#include "engine_bridge/scene/opaque_planes.h"
#include "gbuffer/pixel_filter.h"

namespace pellucid {

struct OpaqueRenderSettings {
  // Colour samples per pixel, averaged with equal weight. 1 is the pixel's centre. Z, N, albedo and AO are always the
  // centre's.
  int samples = 16;
  PixelFilter pixelFilter;  // that they are drawn from, as those of composite --aa are
  bool shadows = true;      // false: nothing is in the way of a light or of the surroundings
  float aoRadius = 1.0f;    // metres; 0 leaves AO out
  int aoSamples = 64;       // rays per pixel
  // Called now and then with the part done, [0,1], from any thread but never from two at once.
  std::function<void(double)> progress;
};

// The opaque primitives of the scene through a pinhole or orthographic camera: direct light of punctual lights and of
// the environment, one bounce, nothing reflected from surface to surface. Transparent and alpha-tested materials are
// not there, and cast no shadow. The same bits for every number of threads.
// Throws ResourceError when memory runs out.
OpaquePlanes renderOpaque(const Scene& scene, const Camera& camera, const Window& display, const Window& data,
                          const Environment& environment, const OpaqueRenderSettings& settings);

}  // namespace pellucid
