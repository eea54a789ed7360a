// Where something opaque stops light before it comes to what is transparent, the map knows nothing of the latter: along
// the rim of the opaque thing's own shadow the other's shadow stays as dark as it is.
#include <gtest/gtest.h>

#include "engine_bridge/gl/shadow_pass.h"
#include "tests/shadow/scenes.h"

namespace pellucid::test {
namespace {

TEST(ShadowMaps, NoLightPassesAlongTheRimOfAnOpaqueShadow) {
  Scene scene;
  add(scene, quad(0.5f, 2.0f), glass(glm::vec3(0.1f)));  // a pane over all of the floor
  Material board;                                        // above its middle
  board.name = "board";
  add(scene, quad(1.5f, 0.4f), board);
  for (const bool coloured : {false, true}) {
    if (coloured) scene.materials[0].baseColor = glm::vec4(0.1f, 0.5f, 0.9f, 1.0f);
    scene.lights = {sun({0, -1, 0})};
    GlContext context;
    ShadowMapSettings settings;
    settings.size = 1024;
    const Camera camera;
    const ShadowMaps maps = renderShadowMaps(context, scene, camera, nullptr, settings);
    const glm::vec3 far = maps.onOpaque(0, {1.0f, 0.0f, 1.0f});
    EXPECT_NEAR(far.r, 0.1f, 0.01f);
    float worst = 0.0f;
    for (float x = 0.402f; x < 0.6f; x += 0.002f)  // beside the board's shadow
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(maps.onOpaque(0, {x, 0.0f, 0.1f})[c] - far[c]));
    std::printf("beside an opaque shadow a pane's is off by %.2g at most\n", static_cast<double>(worst));
    EXPECT_LT(worst, 0.01f);  // what coins and rounded steps are off by
    // What lies on the board has nothing before it.
    EXPECT_EQ(maps.onOpaque(0, {0.0f, 1.5f, 0.0f}).r, 1.0f);
  }
}

}  // namespace
}  // namespace pellucid::test
