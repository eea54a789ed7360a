// A small shot with everything that layers can do, as files: smoke cards that are marked for low resolution, a glass
// that refracts and diffuses, a lamp with its own layer in the picture; the same picture as deep samples.
#pragma once
#include <string>

#include "composite/pipeline/request.h"
#include "gbuffer/deep_io.h"

namespace pellucid::test {

constexpr int kShotWidth = 24, kShotHeight = 18;

struct ShotFiles {
  std::string flat, deepPicture, scene, unlitScene, deepLayers;
  std::string deepWall;  // the flat picture as one sample a pixel
};
// Written into a folder of the test's own.
ShotFiles writeShotFiles(const std::string& folder);

// Composites `scene` over `opaque` by the sums, at pixel centres; nothing is inferred from the sky.
Request requestOf(const std::string& opaque, const std::string& scene);

// Motion blur of what the scene moves, and depth of field, by two passes.
void openShutter(Request& request);
void openLens(Request& request);

// What --method takes, without the settings of samples.
Paint paintOf(const std::string& method);

// Deep files of A, B, G, R and Z: their header, and rows without samples.
DeepHeader deepHeaderOf(int width, int height);
DeepRows noSamplesOf(const DeepHeader& header);

// The largest distance of two colours at one place of pictures of one size.
double farthestApart(const Image<glm::vec4>& a, const Image<glm::vec4>& b);

}  // namespace pellucid::test
