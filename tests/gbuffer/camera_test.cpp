// Cameras between conventions: EXR's rows and left-handed +z, ours, pixels and clip space.
#include "gbuffer/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "exr_files.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"
#include "room.h"

namespace pellucid::test {
namespace {

Camera someCamera(std::mt19937& random, bool orthographic) {
  std::uniform_real_distribution<double> d(-1.0, 1.0);
  Camera camera;
  camera.viewFromWorld =
      glm::rotate(glm::dmat4(1.0), 3.0 * d(random), glm::normalize(glm::dvec3(d(random), d(random), 0.5))) *
      glm::translate(glm::dmat4(1.0), 20.0 * glm::dvec3(d(random), d(random), d(random)));
  camera.orthographic = orthographic;
  camera.focal = {1.5 + d(random), 2.5 + d(random)};
  camera.centre = {0.2 * d(random), 0.2 * d(random)};
  return camera;
}

// EXR's row-vector use of a matrix, written out: p' = p M.
glm::dvec4 rowTimes(const glm::dvec4& p, const float m[4][4]) {
  glm::dvec4 result(0.0);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) result[column] += p[row] * static_cast<double>(m[row][column]);
  return result;
}

glm::dmat4 rows(const float m[4][4]) {
  glm::dmat4 matrix;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) matrix[r][c] = static_cast<double>(m[r][c]);
  return matrix;
}

// A world point in front of the camera, well inside its picture.
glm::dvec3 pointBefore(const Camera& camera, std::mt19937& random) {
  std::uniform_real_distribution<double> d(-0.5, 0.5);
  const glm::dvec4 view(d(random), d(random), -4.0 - 2.0 * d(random), 1.0);
  return glm::dvec3(glm::inverse(camera.viewFromWorld) * view);
}

TEST(Camera, ExrAttributesFollowTheConvention) {
  // At the origin, looking down -z of a y-up right-handed world: EXR's camera z is -z.
  Camera camera;
  camera.focal = {2.0, 4.0};
  float toCamera[4][4], toNdc[4][4];
  cameraToExr(camera, toCamera, toNdc);
  const glm::dvec4 inCamera = rowTimes({1, 2, -5, 1}, toCamera);
  EXPECT_EQ(glm::dvec3(inCamera), glm::dvec3(1, 2, 5)) << "left-handed, +z forward, y up";
  const glm::dvec4 topLeft = rowTimes({-2.5, 1.25, -5, 1}, toNdc), bottomRight = rowTimes({2.5, -1.25, -5, 1}, toNdc);
  EXPECT_EQ(glm::dvec2(topLeft) / topLeft.w, glm::dvec2(0, 0));
  EXPECT_EQ(glm::dvec2(bottomRight) / bottomRight.w, glm::dvec2(1, 1));
}

TEST(Camera, ExrRoundTrip) {
  std::mt19937 random(5);
  double worst = 0;
  const Window display{0, 0, 1920, 1080};
  for (int i = 0; i < 200; ++i) {
    const Camera camera = someCamera(random, i % 2 == 1);
    float toCamera[4][4], toNdc[4][4];
    cameraToExr(camera, toCamera, toNdc);
    const Camera back = cameraFromExr(rows(toCamera), rows(toNdc), "shot.exr");
    EXPECT_EQ(back.orthographic, camera.orthographic);
    EXPECT_EQ(back.origin, "attribute worldToCamera");
    for (int p = 0; p < 10; ++p) {
      const glm::dvec3 world = pointBefore(camera, random);
      const Projected a = project(camera, display, world), b = project(back, display, world);
      worst = std::max(worst, glm::length(a.pixel - b.pixel));
      EXPECT_NEAR(a.z, b.z, 1e-5 * a.z);
    }
  }
  printf("EXR camera round trip: worst %.2g pixels of 1920\n", worst);
  EXPECT_LT(worst, 0.02) << "matrices of floats, 20 m from the origin: 1e-7 * 20 / 3 of some 2000 pixels, a few times";
}

// Fifty kilometres off, in metres or in centimetres: what floats lose of the place is no part of the projection.
TEST(Camera, FarFromTheOriginTheAttributesAreACamera) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> d(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    Camera camera = someCamera(random, i % 2 == 1);
    camera.viewFromWorld =
        glm::translate(camera.viewFromWorld, std::pow(10.0, 3.0 + i % 4) * glm::dvec3(d(random), d(random), 1.0));
    float toCamera[4][4], toNdc[4][4];
    cameraToExr(camera, toCamera, toNdc);
    const Camera back = cameraFromExr(rows(toCamera), rows(toNdc), "shot.exr");
    EXPECT_EQ(back.orthographic, camera.orthographic) << i;
    EXPECT_EQ(back.origin, "attribute worldToCamera") << i;
    EXPECT_LT(glm::length(back.focal - camera.focal), 1e-5) << i;
    // Of parallel rays the middle of the picture and the camera's place are one sum.
    if (camera.orthographic) continue;
    EXPECT_LT(glm::length(back.centre - camera.centre), 1e-5) << i;
  }
}

TEST(Camera, TransposedAndUpsideDownMatricesAreHandled) {
  std::mt19937 random(6);
  const Camera camera = someCamera(random, false);
  float toCamera[4][4], toNdc[4][4];
  cameraToExr(camera, toCamera, toNdc);
  glm::dmat4 ndc = rows(toNdc);
  for (int r = 0; r < 4; ++r) ndc[r][1] = ndc[r][3] - ndc[r][1];  // y up, as pbrt's
  const Camera back = cameraFromExr(glm::transpose(rows(toCamera)), glm::transpose(ndc), "pbrt.exr");
  EXPECT_NE(back.origin.find("transposed"), std::string::npos);
  EXPECT_NE(back.origin.find("y up"), std::string::npos);
  const glm::dvec3 world = pointBefore(camera, random);
  const Window display{0, 0, 640, 480};
  EXPECT_LT(glm::length(project(back, display, world).pixel - project(camera, display, world).pixel), 0.01);
}

// What renderers write instead of EXR's own form, at the origin too, where a transposed matrix looks like another
// camera.
TEST(Camera, RelativesOfTheAttributesAreUnderstood) {
  std::mt19937 random(9);
  const Window display{0, 0, 640, 480};
  for (int trial = 0; trial < 40; ++trial) {
    Camera camera = someCamera(random, false);
    if (trial % 2) camera.viewFromWorld = glm::dmat4(1.0);
    const glm::dmat4 flip = glm::scale(glm::dmat4(1.0), glm::dvec3(1, 1, -1));
    const glm::dmat4 toCamera = flip * camera.viewFromWorld;
    const double n = trial % 4 < 2 ? 0.1 : 1.0, f = trial % 8 < 4 ? 1000 : 1e9;
    for (int form = 0; form < 16; ++form) {
      const bool wide = form & 1, up = form & 2, transposed = form & 4, right = form & 8;
      glm::dmat4 projection(0.0);  // of left-handed camera space
      projection[2] = {0, 0, f / (f - n), 1};
      projection[3][2] = -f * n / (f - n);
      const double sign = up ? 1 : -1, half = wide ? 1 : 0.5, middle = wide ? 0 : 0.5;
      projection[0][0] = half * camera.focal.x;
      projection[1][1] = half * sign * camera.focal.y;
      projection[2][0] = middle + half * camera.centre.x;
      projection[2][1] = middle + half * sign * camera.centre.y;
      glm::dmat4 ndc = projection * toCamera, world = right ? camera.viewFromWorld : toCamera;
      if (transposed) ndc = glm::transpose(ndc), world = glm::transpose(world);
      const Camera back = cameraFromExr(world, ndc, "shot.exr");
      SCOPED_TRACE(back.origin + ", form " + std::to_string(form));
      const glm::dvec3 point = pointBefore(camera, random);
      EXPECT_LT(glm::length(project(back, display, point).pixel - project(camera, display, point).pixel), 0.01);
      EXPECT_NEAR(project(back, display, point).z, project(camera, display, point).z, 1e-4);
    }
  }
}

TEST(Camera, ContradictionsAreRefused) {
  std::mt19937 random(7);
  const Camera camera = someCamera(random, false);
  float toCamera[4][4], toNdc[4][4];
  cameraToExr(camera, toCamera, toNdc);
  const glm::dmat4 c = rows(toCamera), n = rows(toNdc);
  const auto refused = [&](const glm::dmat4& a, const glm::dmat4& b) -> std::string {
    try {
      cameraFromExr(a, b, "shot.exr");
    } catch (const MeaningError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused(c, n), "");
  const glm::dmat4 flip = glm::scale(glm::dmat4(1.0), glm::dvec3(1, 1, -1));
  EXPECT_NE(refused(c, n * glm::inverse(c) * flip * c), "") << "a projection that looks the other way";
  EXPECT_NE(refused(glm::scale(glm::dmat4(1.0), glm::dvec3(2)) * c, n).find("scale"), std::string::npos);
  EXPECT_NE(refused(n, n), "") << "a projection where the camera should be";
  EXPECT_NE(refused(c, glm::dmat4(0.0)), "");
  EXPECT_NE(refused(c, glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, 1)) * n *
                           glm::translate(glm::dmat4(1.0), glm::dvec3(5, 0, 0))),
            "")
      << "a projection from another place";
  glm::dmat4 bad = c;
  bad[1][1] = std::nan("");
  EXPECT_NE(refused(bad, n).find("not finite"), std::string::npos);
  glm::dmat4 mirrored = n;
  for (int r = 0; r < 4; ++r) mirrored[r][0] = mirrored[r][3] - mirrored[r][0];
  EXPECT_NE(refused(c, mirrored).find("mirrored"), std::string::npos);
}

// project() and clipFromView() take different ways to the same pixel.
TEST(Camera, ClipSpaceOfTheDataWindowMatchesPixels) {
  std::mt19937 random(8);
  const std::pair<Window, Window> windows[] = {
      {{0, 0, 640, 360}, {0, 0, 640, 360}},          // plain
      {{0, 0, 640, 360}, {-32, -18, 672, 378}},      // overscan
      {{0, 0, 640, 360}, {100, 50, 300, 210}},       // crop
      {{-320, -180, 320, 180}, {-330, -200, 10, 5}}  // negative origin
  };
  for (const auto& [display, data] : windows)
    for (const bool orthographic : {false, true})
      for (const glm::dvec2 sample : {glm::dvec2(0.5, 0.5), glm::dvec2(0.125, 0.875)}) {
        const Camera camera = someCamera(random, orthographic);
        const glm::dmat4 clip = clipFromView(camera, display, data, sample);
        for (int i = 0; i < 20; ++i) {
          const glm::dvec3 world = pointBefore(camera, random);
          const Projected projected = project(camera, display, world);
          const glm::dvec4 c = clip * camera.viewFromWorld * glm::dvec4(world, 1.0);
          const glm::dvec3 ndc = glm::dvec3(c) / c.w;
          // Where GL puts it in the data window, rows counted from the top; its samples are pixel centres.
          const glm::dvec2 gl(data.x0 + (ndc.x + 1) * 0.5 * data.width(), data.y0 + (1 - ndc.y) * 0.5 * data.height());
          const glm::dvec2 expected = projected.pixel + glm::dvec2(0.5) - sample;
          EXPECT_NEAR(gl.x, expected.x, 1e-9);
          EXPECT_NEAR(gl.y, expected.y, 1e-9);
          EXPECT_GT(ndc.z, 0.0);
          EXPECT_LT(ndc.z, 1.0);
          if (!orthographic) {
            EXPECT_NEAR(ndc.z, kClipNear / projected.z, 1e-15);
            EXPECT_NEAR(c.w, projected.z, 1e-12);
          }
        }
        // Behind the camera is outside 0..1 (clipped): w is negative, or z is.
        const glm::dvec4 behind = clip * glm::dvec4(0, 0, 1, 1);
        EXPECT_TRUE(behind.w < 0 || behind.z / behind.w < 0);
      }
}

TEST(Camera, PixelAspectChangesNothingButTheFieldOfView) {
  // NDC is over the display window, so a pixel twice as wide as high halves focal.x and nothing else.
  Camera camera;
  camera.focal = {1.0, 2.0};
  const Window display{0, 0, 200, 100};
  const Projected square = project(camera, display, {0.5, 0.25, -1});
  EXPECT_EQ(square.pixel, glm::dvec2(150, 25));
  EXPECT_EQ(focalPixels(camera, display), 100.0);
  camera.focal.x = 0.5;
  EXPECT_EQ(project(camera, display, {0.5, 0.25, -1}).pixel, glm::dvec2(125, 25));
  EXPECT_EQ(focalPixels(camera, display), 50.0);
}

Camera blenderCamera() {
  std::ifstream in(assets() + "/blender/camera.json");
  const nlohmann::json json = nlohmann::json::parse(in);
  glm::dmat4 viewFromBlender;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) viewFromBlender[c][r] = json["world_to_camera"][r][c].get<double>();
  // glTF's world from Blender's: (x, y, z) -> (x, z, -y).
  const glm::dmat4 blenderFromGltf(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
  Camera camera;
  camera.viewFromWorld = viewFromBlender * blenderFromGltf;
  camera.focal = {json["projection_gl"][0][0].get<double>(), json["projection_gl"][1][1].get<double>()};
  camera.origin = "camera.json";
  return camera;
}

TEST(VerifyCamera, BlendersPositionsAgreeWithItsCamera) {
  if (assets().empty()) GTEST_SKIP() << "no shared assets";
  for (const char* name : {"/blender/gbuffer.exr", "/blender/flat_gbuffer_center.exr"}) {
    const OpaqueFile file = readOpaque(assets() + name, {});
    const std::optional<double> residual = verifyCamera(file, blenderCamera());
    ASSERT_TRUE(residual.has_value());
    printf("%s: median residual %.3g pixels\n", name, *residual);
    // Positions are averaged over the pixel filter in the first file and taken at pixel centres in the second.
    EXPECT_LT(*residual, std::string(name).find("center") == std::string::npos ? 0.2 : 0.01);
    Camera wrong = blenderCamera();
    wrong.focal *= 1.1;
    EXPECT_THROW(verifyCamera(file, wrong), MeaningError);
    wrong = blenderCamera();
    wrong.viewFromWorld[3].x += 0.2;
    EXPECT_THROW(verifyCamera(file, wrong), MeaningError);
    ReadOptions centimetres;
    centimetres.depthKind = "inverse";
    const OpaqueFile inverse = readOpaque(assets() + name, centimetres);
    EXPECT_THROW(verifyCamera(inverse, blenderCamera()), MeaningError) << "depth is planar";
  }
}

TEST(VerifyCamera, KnowsWhenItCannotTell) {
  TemporaryFolder folder;
  const Window window{0, 0, 8, 8};
  const ExtraLayer colour{"",
                          {{"R", Image<float>(8, 8, 1.0f)},
                           {"G", Image<float>(8, 8, 1.0f)},
                           {"B", Image<float>(8, 8, 1.0f)},
                           {"Z", Image<float>(8, 8, 2.0f)}}};
  writeLayers(folder.path("plain.exr"), window, window, {colour});
  EXPECT_FALSE(verifyCamera(readOpaque(folder.path("plain.exr"), {}), Camera{}).has_value());
  const ExtraLayer nowhere{"P", {{"X", Image<float>(8, 8)}, {"Y", Image<float>(8, 8)}, {"Z", Image<float>(8, 8)}}};
  writeLayers(folder.path("zero.exr"), window, window, {colour, nowhere});
  EXPECT_FALSE(verifyCamera(readOpaque(folder.path("zero.exr"), {}), Camera{}).has_value()) << "0 is no position";
}

// A layer of any name whose Z is taken for the depth holds positions, and they are held against the camera: in the
// camera's space its Z is a depth, in the world's it is none.
TEST(VerifyCamera, TheZOfPositionsIsNoDepthInTheWorldsSpace) {
  TemporaryFolder folder;
  const Room room(true);
  ReadOptions options;
  options.depthChannel = "pp.Z";
  //   depthAlong  of z: -1 in the camera's space
  const auto residualOf = [&](const glm::dmat4& spaceFromView, const Camera& camera, double depthAlong, bool thrice) {
    std::vector<float> planes[3];
    for (std::size_t i = 0; i < room.z.size(); ++i) {
      const auto [a, b] = room.planeAt(i);
      const glm::dvec3 p(spaceFromView * glm::dvec4(a * room.z[i], b * room.z[i], -room.z[i], 1.0));
      for (int c = 0; c < 3; ++c) planes[c].push_back(static_cast<float>(thrice || c == 2 ? depthAlong * p.z : p[c]));
    }
    Part part = room.part(false);
    const char* names[] = {"pp.X", "pp.Y", "pp.Z"};
    for (int c = 0; c < 3; ++c) part.planes.push_back(floatPlane(names[c], planes[c]));
    writeFile(folder.path("shot.exr"), {part});
    return verifyCamera(readOpaque(folder.path("shot.exr"), options, &camera), camera);
  };
  Camera camera = room.camera;
  const glm::dmat4 turned = glm::rotate(glm::translate(glm::dmat4(1.0), {3.0, 1.0, 40.0}), 1.0, {0.0, 1.0, 0.0});
  camera.viewFromWorld = glm::inverse(turned);
  const std::optional<double> own = residualOf(glm::dmat4(1.0), camera, -1.0, false);
  ASSERT_TRUE(own.has_value());
  EXPECT_LT(*own, 1e-3);
  EXPECT_FALSE(residualOf(glm::dmat4(1.0), camera, -1.0, true).has_value()) << "depth three times is no position";
  EXPECT_THROW(residualOf(turned, camera, 1.0, false), MeaningError);
}

}  // namespace
}  // namespace pellucid::test
