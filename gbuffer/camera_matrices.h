// A camera from the matrices of a renderer that thinks as GL does.
#pragma once
#include "gbuffer/camera.h"

namespace pellucid {

//   viewFromWorld  column vectors, right-handed, y up, looking down -z, metres; no scale, no shear
//   clipFromView   perspective (last row 0 0 -1 0) or orthographic (last row 0 0 0 1), without roll or shear; its depth
//                  row is not read
// Throws UsageError that says which entry was found and what was expected.
Camera cameraFromMatrices(const glm::dmat4& viewFromWorld, const glm::dmat4& clipFromView);

}  // namespace pellucid
