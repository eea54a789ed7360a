// What a renderer of ours leaves of the opaque part of a scene, before it is an EXR.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine_bridge/scene/scene.h"
#include "gbuffer/opaque_io.h"

namespace pellucid {

struct LightPlane {
  std::string name;  // unique, of the light
  Image<glm::vec3> radiance;
};

// Planes of one window. beauty = emission + lights in order + indirect + what is seen behind, per pixel.
struct OpaquePlanes {
  Window window;
  Image<glm::vec4> beauty;         // scene-linear, premultiplied; A is 1 everywhere when the surroundings are seen
  Image<float> viewZ;              // planar metres at the pixel centre, +inf where nothing was hit
  Image<glm::vec3> normal;         // world, unit, on the side seen, at the pixel centre; 0 where nothing was hit
  Image<glm::vec3> albedo;         // base colour at the pixel centre, [0,1]
  Image<float> occlusion;          // open part of the hemisphere, [0,1]; empty when not asked for
  std::vector<LightPlane> lights;  // each light's direct light
  Image<glm::vec3> indirect;       // light of the surroundings; empty when they are black
  Image<glm::vec3> emission;       // and the colour of unlit materials; empty when nothing emits
};

// Planes of this size: nothing was hit.
OpaquePlanes emptyOpaquePlanes(const Window& window, const std::vector<std::string>& lights, bool occlusion,
                               bool indirect, bool emission);

// Lights that shine, each with a name no other has, fit for a channel: "key", "key_2".
std::vector<std::string> lightLayerNames(const std::vector<Light>& lights);

// Whether any opaque primitive that is placed sends light of its own.
bool opaqueEmits(const Scene& scene);

// beauty of pixel i from its other planes and from what is seen behind, in the one order.
void sumBeauty(OpaquePlanes& planes, std::size_t i, glm::vec3 behind, float alpha);

// The layers of a file: R G B A Z, N, albedo, AO, light.<name>, indirect, emission.
std::vector<ExtraLayer> layersOf(const OpaquePlanes& planes);

}  // namespace pellucid
