// Which points a map darkens: those alone that have a caster before them within the texels that the lookup reads.
#include <gtest/gtest.h>

#include <cmath>

#include "composite/shadows.h"
#include "engine_bridge/embree/shadow_rays.h"
#include "engine_bridge/gl/shadow_pass.h"
#include "engine_bridge/scene/gltf.h"
#include "gbuffer/opaque_io.h"
#include "gbuffer/view_point.h"
#include "tests/shadow/scenes.h"
#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;
using Form = ShadowMapSettings::Form;

// 7 of the tent and 4 between the texels that are kept; 1 for the width of the one that is met.
constexpr int kReach = 12;  // texels as drawn

// A directional map's texels as drawn, in view space, and what of the light passes the casters before their centres.
class DrawnTexels {
 public:
  DrawnTexels(const ShadowRays& rays, const ShadowMaps& maps, double shrink) : rays_(rays), face_(maps.faces[0]) {
    const glm::dmat4 m(face_.mapFromView);
    const glm::dvec3 across(m[0][0], m[1][0], m[2][0]), down(m[0][1], m[1][1], m[2][1]);
    across_ = across / glm::dot(across, across) * shrink;
    down_ = down / glm::dot(down, down) * shrink;
  }
  double size() const { return glm::length(across_); }
  bool shadowedWithin(const glm::dvec3& point, int reach) const {
    for (int r = 0; r <= reach; ++r)  // from the middle out
      for (int j = -r; j <= r; ++j)
        for (int i = -r; i <= r; i += std::abs(j) == r ? 1 : std::max(2 * r, 1))
          if (rays_.visibility(0, point + static_cast<double>(i) * across_ + static_cast<double>(j) * down_) !=
              glm::vec3(1.0f))
            return true;
    return false;
  }
  // The exact light, filtered as the map's is: by the tent, then between the kept texels.
  glm::dvec3 filtered(const glm::dvec3& point) const {
    const glm::dvec4 place = glm::dmat4(face_.mapFromView) * glm::dvec4(point, 1.0);
    const glm::dvec2 kept = glm::dvec2(place) / place.w - 0.5, low = glm::floor(kept), part = kept - low;
    const glm::dvec2 drawn = 4.0 * kept + 2.5;  // the tent of texel X has its middle on drawn texel 4 X + 2
    const auto weight = [](double first, double share, double at) {
      const auto tent = [](double d) { return std::max(0.0, 8 - std::abs(d)) / 64; };
      return (1 - share) * tent(at - first) + share * tent(at - first - 4);
    };
    glm::dvec3 passed(0);
    for (int j = -kReach; j <= kReach; ++j)
      for (int i = -kReach; i <= kReach; ++i) {
        const glm::dvec2 at = glm::floor(drawn) + glm::dvec2(i, j), away = at + 0.5 - drawn;
        const double w = weight(4 * low.x + 2, part.x, at.x) * weight(4 * low.y + 2, part.y, at.y);
        if (w > 0) passed += w * glm::dvec3(rays_.visibility(0, point + away.x * across_ + away.y * down_));
      }
    return passed;
  }

 private:
  const ShadowRays& rays_;
  const shading::ShadowFace& face_;
  glm::dvec3 across_, down_;
};

TEST(ShadowFootprint, BlenderPixelsChangeWithinTheFilterOfAShadowAlone) {
  if (assets().empty()) GTEST_SKIP() << "no ../shared/assets";
  ReadOptions read;
  read.preset = "blender";
  const GBuffer gbuffer = readOpaque(assets() + "/blender/gbuffer.exr", read).gbuffer;
  const Scene scene = loadScene({assets() + "/blender/transparent_lit.glb"}, {});
  const Camera camera = cameraOf(scene.cameras.at(0), gbuffer.display, gbuffer.pixelAspect);
  const ShadowRays rays(scene, camera);
  const Image<glm::vec3> exact = rays.visibility(0, gbuffer, 1);
  GlContext context;
  std::size_t besideBefore = exact.size();
  for (const int size : {1024, 2048, 4096}) {
    ShadowMapSettings settings;
    settings.size = size;
    const ShadowMaps maps = renderShadowMaps(context, scene, camera, &gbuffer, settings);
    const Image<glm::vec3> mapped = mappedVisibility(maps, 0, gbuffer, camera, 1);
    const DrawnTexels texels(rays, maps, 1.0 / 4);
    std::size_t beside = 0, beyond = 0, lost = 0;
    double worst = 0;
    for (int y = 0; y < exact.height(); ++y)
      for (int x = 0; x < exact.width(); ++x) {
        const glm::vec3 light = mapped.at(x, y);
        const bool darker = light != glm::vec3(1.0f);
        if (exact.at(x, y) != glm::vec3(1.0f)) {
          lost += darker ? 0 : 1;
          continue;
        }
        if (!darker) continue;
        ++beside;
        const glm::dvec3 point = viewPoint(gbuffer, camera, x, y);
        beyond += texels.shadowedWithin(point, kReach) ? 0 : 1;
        if (size != 4096) continue;
        const glm::dvec3 apart = glm::abs(texels.filtered(point) - glm::dvec3(light));
        worst = std::max({worst, apart.x, apart.y, apart.z});
      }
    std::printf(
        "%d^2, texel %.2f mm: %zu of %zu pixels (%.3f%%) darker beside the exact shadow, %zu of them further than "
        "%d texels from it; %zu in it stay as they were\n",
        size, 1e3 * texels.size(), beside, exact.size(),
        100.0 * static_cast<double>(beside) / static_cast<double>(exact.size()), beyond, kReach, lost);
    EXPECT_GT(beside, 0u);
    EXPECT_EQ(beyond, 0u);
    EXPECT_LT(beside, besideBefore);  // narrower with the texel
    besideBefore = beside;
    if (size != 4096) continue;
    std::printf("beside the shadow the map holds the exact light filtered by its tent, to %.4f\n", worst);
    EXPECT_LT(worst, .02);  // optical depths in rounded steps; rims of leaves fall on either side of a texel's centre
  }
}

// A pane under a lid reaches out beyond it. Lookups near the lid's rim read texels beside the lid, where the pane is.
TEST(ShadowFootprint, CastersBehindAReceiverLeaveItAsItIs) {
  Camera camera;
  camera.viewFromWorld = glm::dmat4(glm::dmat3(1, 0, 0, 0, 0, 1, 0, -1, 0));
  camera.viewFromWorld[3] = {0, 0, -4, 1};
  const auto viewOf = [&](double x, double y, double z) {
    return glm::vec3(camera.viewFromWorld * glm::dvec4(x, y, z, 1));
  };
  Material paint = glass(glm::vec3(.5f));
  paint.transmission = 0.0f;
  Scene scene;
  add(scene, quad(.5f, 1.5f), glass(glm::vec3(.5f)));
  add(scene, quad(1, .75f), paint);
  add(scene, quad(0, 4.0f), paint);
  scene.lights = {sun({0, -1, 0}), sun({.3, -1, .2})};
  GlContext context;
  for (const Form form : {Form::variance, Form::corrected, Form::stratified, Form::published}) {
    ShadowMapSettings settings;
    settings.form = form;
    settings.size = 1024;
    const ShadowMaps maps = renderShadowMaps(context, scene, camera, nullptr, settings);
    int changed = 0, floor = 0;
    for (const std::size_t light : {0u, 1u})
      for (int i = 0; i < 400; ++i)
        for (const double across : {-.6, .0, .3}) {
          const double along = .75 - 1e-4 - .0001 * i;  // 4 cm of the rim; a texel has 3 mm
          for (const glm::dvec2 at : {glm::dvec2(along, across), glm::dvec2(-along, across), glm::dvec2(across, along),
                                      glm::dvec2(across, -along)})
            changed += maps.onOpaque(light, viewOf(at.x, 1, at.y)) == glm::vec3(1.0f) ? 0 : 1;
          // On the pane's own height lies what it stands on: it counts in full.
          floor += std::abs(maps.onOpaque(light, viewOf(1 + .001 * i, .5, across)).r - .5f) < 3e-4f ? 0 : 1;
        }
    std::printf("form %d: %d of 9600 points on the lid darkened; %d of 2400 under the pane not in its full shadow\n",
                static_cast<int>(form), changed, floor);
    // Where the coins left no caster in the square, nothing tells how far those that it hides are.
    EXPECT_LE(changed, form == Form::corrected ? 9600 / 50 : 0);
    if (form == Form::variance || form == Form::corrected) {
      EXPECT_EQ(floor, 0);
    }
  }
}

}  // namespace
}  // namespace pellucid
