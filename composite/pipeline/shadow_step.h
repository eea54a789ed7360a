// Shadows of transparent things on the opaque picture, cast before anything goes onto it, and on each other.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "composite/pipeline/device.h"
#include "composite/pipeline/shot.h"
#include "engine_bridge/embree/shadow_rays.h"
#include "gbuffer/shadow_maps.h"

namespace pellucid {

struct CastShadows {
  Image<glm::vec4> beauty;                 // of the picture, dimmed; empty where nothing changed
  std::unique_ptr<DeepOpaque> deepOpaque;  // of a deep picture, dimmed; null where nothing changed
  Image<std::uint8_t> touched;             // opaque pixels that changed; empty when shadows are off
  Image<glm::vec3> layer;                  // `shadow`, where no layer of a light was there to dim; else empty
  std::shared_ptr<const ShadowMaps> maps;  // null unless shadows are by maps
  std::shared_ptr<const ShadowRays> rays;  // null unless they are by rays
};

// Throws UsageError for flags that contradict each other; what depends on the shot is found by castShadows().
void checkShadows(const ShadowRequest& request);

// Notes what it could not know. Throws MeaningError for a light or layer that is not there.
//   fog      that dims the lights on their way to the picture; null: none
//   samples  positions in a pixel
CastShadows castShadows(const ShadowRequest& request, const Shot& shot, std::shared_ptr<const Fog> fog, int samples,
                        Device& device, Journal& journal);

}  // namespace pellucid
