// The opaque picture that transparency is composited onto, understood: one beauty, one depth, one camera.
#pragma once
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "gbuffer/camera.h"
#include "gbuffer/image.h"

namespace pellucid {

class ObjectCoverage;  // gbuffer/object_coverage.h

// All planes have the size of `data`.
struct GBuffer {
  Window display, data;
  double pixelAspect = 1.0;
  Image<glm::vec4> beauty;  // scene-linear RGB premultiplied by A, and A; A = 1 where the file has none
  bool hasAlpha = false;
  Image<float> viewZ;            // planar metres along the view axis, > 0, +inf where nothing was hit
  float depthPrecision = 0;      // relative: a fragment at z <= viewZ * (1 + depthPrecision) is in front
  Image<glm::vec3> normal;       // world, unit; empty when the file has none
  Image<float> occlusion;        // ambient occlusion, [0,1], 1 = open; empty when the file has none
  std::optional<Camera> camera;  // from the file's attributes
  std::shared_ptr<const ObjectCoverage> objects;  // null when the file has none
};

}  // namespace pellucid
