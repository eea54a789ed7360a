// What a shot was read from, so that the next frame knows what of it has not changed.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "composite/pipeline/request.h"

namespace pellucid {

// Files, and which of which size and time they were before they were read.
using StampedFiles = std::vector<std::pair<std::string, std::string>>;

struct ShotOrigin {
  StampedFiles scene;                // and what a glTF names
  SceneOptions options;              // that it was loaded with, but for the time
  bool posed = false;                // at some time
  glm::dmat3 fromRec709{1.0};        // that its colours were brought through
  std::vector<std::string> outside;  // what bringInto() has said
  StampedFiles picture;              // and the files beside it
  ReadOptions read;
  ColourRequest colour;
  StampedFiles surroundings;

  bool sameScene(const ShotOrigin& other) const { return scene == other.scene && options == other.options; }
  bool sameSurroundings(const ShotOrigin& other) const {
    return surroundings == other.surroundings && fromRec709 == other.fromRec709;
  }
  bool samePicture(const ShotOrigin& other) const {
    return picture == other.picture && read == other.read && colour == other.colour;
  }
};

// Of what a request asks for, before any of it is read.
//   options  that the scene is to be loaded with
ShotOrigin originOf(const ShotRequest& request, const std::vector<std::string>& geometry, const SceneOptions& options);

}  // namespace pellucid
