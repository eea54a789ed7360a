// A drawn scene as the program reads it: an opaque EXR and a GLB.
#pragma once
#include <string>

#include "tests/pictures/drawn_scene.h"
#include "tests/reference/pixel_weights.h"

namespace pellucid::test {

// Colour filtered over the pixel, depth at its centre.
struct OpaqueForm {
  bool half = false;
  std::string depthKind = "planar";  // planar, ray, inverse, negative
  double metresPerUnit = 1.0;        // of depth
};

void writeOpaque(const std::string& path, const reference::Picture& picture, const reference::Samples& samples,
                 const OpaqueForm& form);
void writeScene(const std::string& path, const DrawnScene& scene);

}  // namespace pellucid::test
