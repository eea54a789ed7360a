// Which pixels a triangle touches, and which opaque depths hide it.
#include <gtest/gtest.h>

#include "tests/gl/builder.h"

namespace pellucid::test {
namespace {

const glm::vec3 kRed(0.75f, 0.25f, 0.125f);

int touched(const OitPlanes& planes) {
  int count = 0;
  for (std::size_t i = 0; i < planes.weight.size(); ++i) count += planes.weight[i].a > 0 ? 1 : 0;
  return count;
}

TEST(Coverage, QuadTouchesExactlyItsPixelsTopRowFirst) {
  Stage stage(40, 24);
  stage.quad(5, 0, 21, 3, 2.0, stage.add(unlitBlend(kRed, 0.5f)));
  const OitPlanes planes = stage.accumulate();
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 40; ++x) {
      const bool inside = x >= 5 && x < 21 && y < 3;
      ASSERT_EQ(planes.weight.at(x, y).a, inside ? 1.0f : 0.0f) << x << ' ' << y;
      if (inside) {
        ASSERT_NEAR(planes.frontZ.at(x, y), 2.0f, 4e-7f);  // interpolated: 2 ulp
        ASSERT_EQ(planes.opacity.at(x, y).r, 0.5f);
      } else {
        ASSERT_EQ(planes.frontZ.at(x, y), kSky);
        ASSERT_EQ(planes.radiance.at(x, y), glm::vec4(0.0f));
      }
    }
  EXPECT_EQ(stage.statistics.fragments, 16u * 3u);
  EXPECT_EQ(stage.statistics.triangles, 2u);
}

TEST(Coverage, CroppedAndOverscannedDataWindows) {
  for (const Window data : {Window{10, 5, 30, 17}, Window{-6, -4, 50, 30}}) {
    Stage stage(40, 24);
    stage.quad(12, 7, 20, 9, 2.0, stage.add(unlitBlend(kRed, 0.5f)));
    stage.gbuffer.data = data;
    stage.gbuffer.viewZ = Image<float>(data.width(), data.height(), kSky);
    const OitPlanes planes = stage.accumulate();
    EXPECT_EQ(touched(planes), 8 * 2);
    EXPECT_EQ(planes.weight.at(12 - data.x0, 7 - data.y0).a, 1.0f);
    EXPECT_EQ(planes.weight.at(19 - data.x0, 8 - data.y0).a, 1.0f);
  }
}

TEST(Coverage, SamplePositionMovesTheEdge) {
  // The left edge lies at x = 4.3: a sample at .25 misses pixel 4, one at .35 hits it. y alike, downwards.
  for (const double sample : {0.25, 0.35}) {
    Stage stage(16, 16);
    stage.quad(4.3, 4.3, 12, 12, 2.0, stage.add(unlitBlend(kRed, 0.5f)));
    PassSettings settings;
    settings.sample = {sample, sample};
    const OitPlanes planes = stage.accumulate(settings);
    EXPECT_EQ(planes.weight.at(4, 6).a, sample > 0.3 ? 1.0f : 0.0f);
    EXPECT_EQ(planes.weight.at(6, 4).a, sample > 0.3 ? 1.0f : 0.0f);
    EXPECT_EQ(planes.weight.at(5, 5).a, 1.0f);
  }
}

TEST(Coverage, OpaqueDepthHidesWhatIsBehind) {
  Stage stage(16, 8);
  stage.quad(0, 0, 16, 8, 5.0, stage.add(unlitBlend(kRed, 0.5f)));
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) stage.gbuffer.viewZ.at(x, y) = y < 3 ? 4.999f : 5.001f;
  const OitPlanes planes = stage.accumulate();
  for (int y = 0; y < 8; ++y) EXPECT_EQ(planes.weight.at(7, y).a, y < 3 ? 0.0f : 1.0f) << y;
}

TEST(Coverage, CoplanarSurfacesAreInFront) {
  Stage stage(64, 32);
  stage.slanted(0, 0, 64, 32, 3.0, 40.0, stage.add(unlitBlend(kRed, 0.5f)));
  // 1 / z is linear over the picture.
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) {
      const double s = (x + 0.5) / 64;
      stage.gbuffer.viewZ.at(x, y) = static_cast<float>(1.0 / ((1 - s) / 3.0 + s / 40.0));
    }
  EXPECT_EQ(touched(stage.accumulate()), 64 * 32);
  stage.gbuffer.depthPrecision = -1e-5f;
  EXPECT_EQ(touched(stage.accumulate()), 0);
}

TEST(Coverage, BackFacesAreCulledUnlessDoubleSided) {
  for (const bool mirrored : {false, true})
    for (const bool doubleSided : {false, true})
      for (const bool back : {false, true}) {
        Stage stage(16, 16);
        Material material = unlitBlend(kRed, 0.5f);
        material.doubleSided = doubleSided;
        Instance& instance = stage.quad(2, 2, 14, 14, 2.0, stage.add(material));
        // A mirror turns the sides round; the loader turns the windings with it.
        if (back != mirrored) {
          std::swap(stage.scene.primitives[0].indices[1], stage.scene.primitives[0].indices[2]);
          std::swap(stage.scene.primitives[0].indices[4], stage.scene.primitives[0].indices[5]);
        }
        if (mirrored) instance.worldFromObject[0][0] = -1.0;
        EXPECT_EQ(touched(stage.accumulate()), back && !doubleSided ? 0 : 12 * 12) << mirrored << doubleSided << back;
      }
}

TEST(Coverage, OpaqueMaterialsAreSkipped) {
  Stage stage(8, 8);
  Material material;
  material.doubleSided = true;
  stage.quad(0, 0, 8, 8, 2.0, stage.add(material));
  EXPECT_EQ(touched(stage.accumulate()), 0);
  EXPECT_EQ(stage.statistics.triangles, 0u);
}

TEST(Coverage, NothingBehindTheEyeOrWithoutCoverage) {
  Stage stage(8, 8);
  stage.quad(0, 0, 8, 8, -2.0, stage.add(unlitBlend(kRed, 0.5f)));
  stage.quad(0, 0, 8, 8, 2.0, stage.add(unlitBlend(kRed, 0.0f)));
  EXPECT_EQ(touched(stage.accumulate()), 0);
}

TEST(Coverage, OrthographicCamera) {
  Stage stage(32, 16);
  stage.camera.orthographic = true;
  stage.quad(3, 2, 9, 6, 7.0, stage.add(unlitBlend(kRed, 0.5f)));
  const OitPlanes planes = stage.accumulate();
  EXPECT_EQ(touched(planes), 6 * 4);
  EXPECT_NEAR(planes.frontZ.at(5, 3), 7.0f, 1e-6f);
  stage.gbuffer.viewZ = Image<float>(32, 16, 6.5f);
  EXPECT_EQ(touched(stage.accumulate()), 0);
}

// A floor that passes under the camera and on behind it: the hardest triangle to clip.
TEST(Coverage, FloorUnderTheCameraKeepsItsDepth) {
  Stage stage(320, 180);
  Primitive floor;
  floor.material = stage.add(unlitBlend(kRed, 0.5f));
  for (const glm::vec2 corner :
       {glm::vec2(-500, 500), glm::vec2(500, 500), glm::vec2(500, -500), glm::vec2(-500, -500)}) {
    Vertex vertex{};
    vertex.position = {corner.x, -1.5f, corner.y};
    vertex.normal = {0, 1, 0};
    vertex.colour = glm::vec4(1.0f);
    floor.vertices.push_back(vertex);
  }
  floor.indices = {0, 1, 2, 0, 2, 3};
  stage.place(std::move(floor));
  const OitPlanes planes = stage.accumulate();
  double worst = 0;
  for (int y = 0; y < 180; ++y)
    for (int x = 0; x < 320; ++x) {
      const double down = -(1.0 - 2.0 * (y + 0.5) / 180) / stage.camera.focal.y;
      const double z = 1.5 / down;
      if (down <= 0 || z > 499) {
        if (down <= 0) {
          ASSERT_EQ(planes.weight.at(x, y).a, 0.0f);
        }
        continue;
      }
      ASSERT_EQ(planes.weight.at(x, y).a, 1.0f) << x << ' ' << y;
      worst = std::max(worst, std::abs(static_cast<double>(planes.frontZ.at(x, y)) / z - 1.0));
    }
  std::printf("floor: worst relative error of z %.2e\n", worst);
  EXPECT_LT(worst, 1e-4);  // the rasteriser's plane equations in float, over a triangle 300 times the picture
}

// Wider than any texture: two super-tiles, whose seam must not show.
TEST(Coverage, WindowsBeyondTheDeviceLimit) {
  Stage stage(20000, 4);
  stage.slanted(100, 1, 19900, 3, 2.0, 9.0, stage.add(unlitBlend(kRed, 0.5f)));
  const OitPlanes planes = stage.accumulate();
  for (int x = 0; x < 20000; ++x) {
    const bool inside = x >= 100 && x < 19900;
    for (int y = 0; y < 4; ++y) ASSERT_EQ(planes.weight.at(x, y).a, inside && (y == 1 || y == 2) ? 1.0f : 0.0f) << x;
    if (!inside) continue;
    const double s = (x + 0.5 - 100) / 19800;
    ASSERT_NEAR(static_cast<double>(planes.frontZ.at(x, 1)) * ((1 - s) / 2.0 + s / 9.0), 1.0, 1e-5);
  }
  std::size_t listed = 0;
  for (const FragmentLists& lists : stage.fragments()) listed += lists.fragments.size();
  EXPECT_EQ(listed, 19800u * 2u);
}

}  // namespace
}  // namespace pellucid::test
