// One shot, loaded: the opaque picture, the transparent scene, the camera, and the light around them.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "composite/cli/messages.h"
#include "composite/cli/options.h"
#include "composite/deep/deep_opaque.h"
#include "composite/deep/deep_source.h"
#include "composite/veil.h"
#include "engine_bridge/scene/surroundings.h"

namespace pellucid::cli {

struct Shot {
  OpaqueFile opaque;
  Scene scene;
  Camera camera;
  glm::vec3 surroundings{0.0f};
  std::shared_ptr<const Surroundings> environment;  // a picture of them, where a file was given
  std::unique_ptr<DeepOpaque> deepOpaque;  // when the opaque picture is deep; `opaque` is then what it flattens to
  bool hasScene = true;                    // false when all transparent inputs are deep files
  std::vector<std::unique_ptr<DeepSource>> deep;  // transparent layers that come as deep EXR
};

// Reads everything and decides on camera and surroundings, saying what was inferred. Throws what the readers throw, and
// MeaningError when there is no camera, or more than one and no --camera.
//   traced  rays will meet the scene's triangles: they are decoded, whatever --budget says
std::unique_ptr<Shot> loadShot(const std::string& opaquePath, const std::vector<std::string>& scenePaths,
                               const ReadFlags& read, const SceneFlags& sceneFlags, Stages& stages,
                               bool traced = false);

bool isExrName(const std::string& path);  // a deep file rather than glTF

// The camera of a shot, by flag, file attribute or glTF, in this order.
Camera chooseCamera(const std::string& flag, const GBuffer& gbuffer, const Scene& scene, const std::string& opaquePath);

// Median colour of the pixels where nothing was hit: what the transparent things reflect when nobody says. Black
// without such pixels.
glm::vec3 medianSky(const GBuffer& gbuffer, std::size_t& pixels);

}  // namespace pellucid::cli
