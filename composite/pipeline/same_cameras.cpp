#include "composite/pipeline/same_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gbuffer/camera_match.h"
#include "gbuffer/errors.h"

namespace pellucid {

bool allOneCamera(const std::vector<SceneCamera>& cameras, const GBuffer& gbuffer) {
  constexpr double kSlack = 1e-5;  // of what single precision keeps
  if (cameras.empty()) return false;
  const Camera first = cameraOf(cameras[0], gbuffer.display, gbuffer.pixelAspect);
  return std::all_of(cameras.begin(), cameras.end(), [&](const SceneCamera& each) {
    const Camera camera = cameraOf(each, gbuffer.display, gbuffer.pixelAspect);
    return sameView(first, camera) && std::abs(first.rangeNear - camera.rangeNear) <= kSlack * first.rangeNear &&
           std::abs(first.rangeFar - camera.rangeFar) <= kSlack * first.rangeFar;
  });
}

Camera namedCamera(const std::string& name, const Scene& scene, const GBuffer& gbuffer) {
  if (scene.cameras.empty())
    throw UsageError(fmt::format(
        "--camera: found '{}', expected eye=X,Y,Z;look=X,Y,Z;up=X,Y,Z;fov=DEGREES: no glTF holds a camera", name));
  std::vector<SceneCamera> found;
  std::string names;
  for (const SceneCamera& camera : scene.cameras) {
    if (camera.name == name) found.push_back(camera);
    names += (names.empty() ? "" : ", ") + camera.name;
  }
  if (found.empty())
    throw UsageError(fmt::format("--camera: found '{}', expected one of the scene's cameras ({})", name, names));
  if (!allOneCamera(found, gbuffer))
    throw UsageError(
        fmt::format("--camera: found {} cameras of the name '{}' that differ, expected one", found.size(), name));
  Camera camera = cameraOf(found[0], gbuffer.display, gbuffer.pixelAspect);
  camera.origin += " by --camera";
  return camera;
}

}  // namespace pellucid
