#include "composite/pipeline/shot_origin.h"

#include "composite/pipeline/input_files.h"
#include "composite/sequence/digest.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

void add(const std::string& path, StampedFiles& files) {
  files.emplace_back(path, stampOf(path));
}

// A file that cannot be read is a matter of whoever loads it.
void addScene(const std::string& path, const std::string& assetRoot, StampedFiles& files) {
  add(path, files);
  try {
    for (const std::string& file : filesReadWith(path, assetRoot)) add(file, files);
  } catch (const InputError&) {
  }
}

}  // namespace

ShotOrigin originOf(const ShotRequest& request, const std::vector<std::string>& geometry, const SceneOptions& options) {
  ShotOrigin origin;
  for (const std::string& path : geometry) addScene(path, options.assetRoot, origin.scene);
  origin.options = options;
  if (!request.memory) add(request.opaque, origin.picture);
  if (request.read.depthFile) add(request.read.depthFile->path, origin.picture);
  for (const SideFile& side : request.read.aovs) add(side.path, origin.picture);
  if (!request.colour.config.empty()) add(request.colour.config, origin.picture);
  origin.read = request.read;
  origin.colour = request.colour;
  if (const auto* picture = std::get_if<PictureOfSurroundings>(&request.surroundings))
    add(picture->path, origin.surroundings);
  return origin;
}

}  // namespace pellucid
