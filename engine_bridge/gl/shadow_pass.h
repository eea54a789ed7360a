// Renders shadow maps of a scene's lights: every caster once, in any order. PT17 section 5, ST10 sections 3.2 and 3.6,
// MODEL section 6
#pragma once
#include <cstdint>
#include <vector>

#include "engine_bridge/gl/transparent_pass.h"
#include "gbuffer/shadow_maps.h"

namespace pellucid {

struct ShadowMapSettings {
  enum class Form {
    variance,    // prefiltered, with the exact net density: no noise on opaque receivers
    published,   // prefiltered as PT17 has it: a coin per texel, nothing exact
    naive,       // ST10's maps, percentage closer: a coin per texel
    stratified,  // coins stratified over squares of texels
    corrected,   // and scaled to the exact net density
  };
  Form form = Form::variance;
  int size = 4096;     // texels along an edge as rendered; half of it for the faces of a cube
  int opaqueSize = 0;  // of maps of opaque casters; 0: none, which is enough for opaque receivers
  int closerEdge = 4;  // of the square that percentage-closer lookups take
  std::uint32_t seed = 0;
  std::size_t budgetBytes = std::size_t{256} << 20;  // geometry on the device at once
  SubmissionOrder order = {};
};

struct ShadowMapStatistics {
  double drawSeconds = 0, filterSeconds = 0;
  std::size_t faces = 0, triangles = 0, bytes = 0;  // of the maps as they are looked up
};

// Maps of every light of the scene. Opaque casters are the scene's opaque primitives or, when it has none, what the
// G-buffer shows. Materials that only add light, or whose castsShadow is off, cast none. Single-sided meshes cast by
// their faces towards the light when they are closed, by both when not. Cut-out leaves are cut hard. The same bits for
// every submission order and chunking. Throws ResourceError when the device has no room.
//   gbuffer  may be null: then nothing is known of what is opaque but the scene
//   camera   in whose view space the maps are looked up
ShadowMaps renderShadowMaps(GlContext& context, const Scene& scene, const Camera& camera, const GBuffer* gbuffer,
                            const ShadowMapSettings& settings, ShadowMapStatistics* statistics = nullptr);

}  // namespace pellucid
