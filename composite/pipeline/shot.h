// One shot, loaded: the opaque picture, the transparent scene, the camera, and the light around them.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "composite/deep/deep_opaque.h"
#include "composite/deep/deep_source.h"
#include "composite/pipeline/journal.h"
#include "composite/pipeline/request.h"
#include "composite/pipeline/shot_origin.h"
#include "engine_bridge/scene/surroundings.h"

namespace pellucid {

// Nothing of it changes once it is loaded, but for its pose where a glTF of it is animated; deep files keep their place
// in themselves as they are read.
struct Shot {
  ShotOrigin origin;         // which files, and how they were read
  bool keptPicture = false;  // as the frame before left it: files, settings and camera are the same
  bool keptScene = false;    // but for its pose

  bool inMemory = false;  // the picture's colours and depths are the caller's own
  OpaqueFile opaque;
  HeaderTime headerTime;             // what the picture's header says of it
  std::optional<ShotMoment> moment;  // when it was taken; nothing where nobody says
  Scene scene;
  std::unique_ptr<SceneFiles> files;  // what poses the scene; its moves() says whether anything does
  Camera camera;
  glm::vec3 surroundings{0.0f};
  std::shared_ptr<const Surroundings> environment;  // a picture of them, where a file was given
  std::unique_ptr<DeepOpaque> deepOpaque;           // when the opaque picture is deep; `opaque` is what it flattens to
  bool hasScene = true;                             // false when all transparent inputs are deep files
  bool sceneCamera = false;                         // the camera is one of the scene's, and moves with it
  bool hasCamera = true;                            // false where deep files alone need none, and none was found
  std::vector<std::string> understood;              // picture, depth, camera and scene, a line each
  std::vector<std::string> geometry;                // the glTF files
  std::vector<std::unique_ptr<DeepSource>> deep;    // transparent layers that come as deep EXR
};

// Reads every file once and decides on camera and surroundings, noting what was inferred. Throws what the readers
// throw, and MeaningError when there is no camera, or more than one and none was named.
//   traced   rays will meet the scene's triangles: they are decoded, whatever SceneOptions::streamBytes says
//   earlier  of another frame, or null: what is the same is taken over, at the same place
std::unique_ptr<Shot> loadShot(const ShotRequest& request, bool traced, Journal& journal,
                               std::unique_ptr<Shot> earlier = nullptr);

// The opaque picture of a file, flat or deep.
//   camera  where depth needs one, or null: the file's own
//   deep    is given the samples of a deep one
OpaqueFile readPictureFile(const std::string& path, const ReadOptions& options, const Camera* camera,
                           std::unique_ptr<DeepOpaque>& deep);

bool isExrName(const std::string& path);  // a deep file rather than glTF

// The camera of a shot, by choice, file attribute or glTF, in this order.
//   opaquePath  for messages
//   refused     why the picture's own attributes were not taken, "" where it has none
Camera chooseCamera(const CameraChoice& choice, const GBuffer& gbuffer, const Scene& scene,
                    const std::string& opaquePath, const std::string& refused = "");

// Median colour of the pixels where nothing was hit: what the transparent things reflect when nobody says. Black
// without such pixels.
glm::vec3 medianSky(const GBuffer& gbuffer, std::size_t& pixels);

}  // namespace pellucid
