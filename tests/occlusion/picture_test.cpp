// The pictures of PT17 fig. 6 through the transparent pass, against occlusion traced at every fragment's own point.
// They are left in the build folder, occlusion_*.exr, to be looked at.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <glm/gtc/constants.hpp>

#include "composite/over.h"
#include "composite/resolve.h"
#include "gbuffer/opaque_io.h"
#include "tests/occlusion/leaf_stage.h"
#include "tests/occlusion/plants_scene.h"

namespace pellucid {
namespace {

using namespace test;

const glm::vec3 kSky(0.62f, 0.7f, 0.8f);

struct Plants {
  PlantScene scene;
  std::vector<samples::Card> cards;
  Image<glm::vec4> mask;
};

Plants tree() {
  return {treeScene(), samples::crown({0.0, 1.5, 0.0}, 0.75, 650, 0.2, 7), samples::leafMask(256)};
}

Plants fence() {
  return {fenceScene(), samples::fence({-0.9, 0.0, 0.0}, 1.8, 1.1, 3, 0.05), samples::slatMask(512)};
}

// A plant before its opaque ground, as a renderer with traced occlusion leaves it.
class Scene6 {
 public:
  explicit Scene6(Plants plants, int lines, int cropLines) : plants_(std::move(plants)) {
    crop(plants_.scene.view, lines, cropLines);
    picture_ = plants_.scene.world->picture(plants_.scene.view);
    occluders_ = std::make_shared<OccluderPlanes>(tracedOccluders(plants_.scene, picture_, 64));
    stage_ = std::make_unique<LeafStage>(picture_.display, picture_.data, picture_.camera);
    const int material = stage_->addMask(plants_.mask);
    stage_->addCards(plants_.cards, material);
    stage_->scene.textures[0].texels = plants_.mask;  // with its colours
    GBuffer& gbuffer = stage_->gbuffer;
    gbuffer.hasAlpha = true;
    for (std::size_t i = 0; i < gbuffer.viewZ.size(); ++i) {
      gbuffer.beauty[i] = glm::vec4(kSky, 1.0f);
      const bool leaf = picture_.layer.coverage[i] == 1.0f || !std::isfinite(picture_.viewZ[i]);
      if (leaf) continue;
      gbuffer.viewZ[i] = picture_.viewZ[i];
      gbuffer.beauty[i] = glm::vec4(glm::vec3(0.45f, 0.4f, 0.33f) * kSky * occluders_->occlusion[i], 1.0f);
    }
    // Behind leaves the ground is not in the picture that was traced: it goes on as the plane it is.
    for (int y = 0; y < gbuffer.viewZ.height(); ++y)
      for (int x = 0; x < gbuffer.viewZ.width(); ++x) {
        const glm::dvec3 down = direction(x, y);
        const double z = -plants_.scene.view.eye.y / down.y;
        if (picture_.layer.coverage.at(x, y) != 1.0f || !(z > 0.0)) continue;
        const glm::dvec3 at = point(x, y, z);
        if (std::abs(at.x) > 6.0 || std::abs(at.z) > 6.0) continue;
        gbuffer.viewZ.at(x, y) = static_cast<float>(z);
        gbuffer.beauty.at(x, y) = glm::vec4(glm::vec3(0.45f, 0.4f, 0.33f) * kSky, 1.0f);
      }
  }

  enum Kind { none, opaque, inferred, truth };
  Image<glm::vec4> render(Kind kind) const {
    PassSettings settings;
    settings.surroundings = kSky;
    if (kind == opaque || kind == inferred) settings.occlusion.occluders = occluders_;
    settings.occlusion.rims = kind == inferred;
    GlContext context;
    TransparentPass pass(context, stage_->scene, stage_->gbuffer, stage_->camera);
    Veil veil(picture_.data.width(), picture_.data.height());
    pass.fragments(settings, [&](const FragmentLists& lists) {
      if (kind != truth) return compositeSorted(lists, picture_.data, veil);
      FragmentLists traced = lists;
      occlude(traced);
      compositeSorted(traced, picture_.data, veil);
    });
    return compose(veil, stage_->gbuffer).rgba;
  }

  // Pixels whose layers include a rim in front.
  bool isRim(std::size_t i) const { return shading::isRim(picture_.rims.coverage[i]); }
  const Window& data() const { return picture_.data; }

 private:
  glm::dvec3 direction(int x, int y) const {
    const double ndcX = 2.0 * (picture_.data.x0 + x + 0.5) / picture_.display.width() - 1.0,
                 ndcY = 1.0 - 2.0 * (picture_.data.y0 + y + 0.5) / picture_.display.height();
    return glm::transpose(glm::dmat3(picture_.camera.viewFromWorld)) *
           glm::dvec3(ndcX / picture_.camera.focal.x, ndcY / picture_.camera.focal.y, -1.0);
  }
  glm::dvec3 point(int x, int y, double z) const { return plants_.scene.view.eye + z * direction(x, y); }

  // Normal, towards the eye, of the card that the point lies on.
  glm::dvec3 normalAt(const glm::dvec3& at, const glm::dvec3& away) const {
    double nearest = 1e30;
    glm::dvec3 found(0.0);
    for (const samples::Card& card : plants_.cards) {
      const glm::dvec3 normal = glm::normalize(glm::cross(card.right, card.up)), on = at - card.corner;
      const double u = glm::dot(on, card.right) / glm::dot(card.right, card.right),
                   v = glm::dot(on, card.up) / glm::dot(card.up, card.up), off = std::abs(glm::dot(on, normal));
      if (u < -0.01 || u > 1.01 || v < -0.01 || v > 1.01 || off >= nearest) continue;
      nearest = off;
      found = glm::dot(normal, away) > 0.0 ? -normal : normal;
    }
    return found;
  }

  double openAt(int x, int y, float z) const {
    const glm::dvec3 at = point(x, y, static_cast<double>(z));
    return plants_.scene.world->open(at, normalAt(at, direction(x, y)), kReach, 100,
                                     static_cast<std::uint32_t>(x * 7919 + y));
  }

  void occlude(FragmentLists& lists) const {
    tbb::parallel_for(lists.window.y0, lists.window.y1, [&](int row) {
      for (int column = lists.window.x0; column < lists.window.x1; ++column) {
        const int u = column - lists.window.x0, v = row - lists.window.y0, x = column - picture_.data.x0,
                  y = row - picture_.data.y0;
        const auto pixel =
            static_cast<std::size_t>(v) * static_cast<std::size_t>(lists.window.width()) + static_cast<std::size_t>(u);
        for (std::uint64_t k = lists.offsets[pixel]; k < lists.offsets[pixel + 1]; ++k)
          lists.fragments[k].radiance *= static_cast<float>(openAt(x, y, lists.fragments[k].z));
        glm::vec4& solid = lists.solid.at(u, v);
        if (std::isfinite(solid.a))
          solid = glm::vec4(glm::vec3(solid) * static_cast<float>(openAt(x, y, solid.a)), solid.a);
      }
    });
  }

  Plants plants_;
  LeafPicture picture_;
  std::shared_ptr<OccluderPlanes> occluders_;
  std::unique_ptr<LeafStage> stage_;
};

void keep(const std::string& name, const Scene6& scene, const Image<glm::vec4>& rgba) {
  std::vector<std::pair<std::string, Image<float>>> channels;
  const char* names[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    Image<float> plane(rgba.width(), rgba.height());
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = rgba[i][c];
    channels.emplace_back(names[c], std::move(plane));
  }
  const Window window{0, 0, scene.data().width(), scene.data().height()};
  writeLayers(std::string(PELLUCID_BINARY_DIR) + "/occlusion_" + name + ".exr", window, window, {{"", channels}});
}

void holdPictures(Plants plants, const std::string& name) {
  const Scene6 scene(std::move(plants), 540, 180);
  const Image<glm::vec4> none = scene.render(Scene6::none), opaque = scene.render(Scene6::opaque),
                         inferred = scene.render(Scene6::inferred), truth = scene.render(Scene6::truth);
  keep(name + "_none", scene, none);
  keep(name + "_opaque", scene, opaque);
  keep(name + "_inferred", scene, inferred);
  keep(name + "_truth", scene, truth);
  double open = 0.0, bright = 0.0, error = 0.0, level = 0.0;
  std::size_t rims = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (!scene.isRim(i)) continue;
    ++rims;
    const auto g = [&](const Image<glm::vec4>& image) { return static_cast<double>(image[i].g); };
    open += std::abs(g(none) - g(truth));
    bright += std::abs(g(opaque) - g(truth));
    error += std::abs(g(inferred) - g(truth));
    level += g(truth);
  }
  const auto count = static_cast<double>(rims);
  printf(
      "[ figure ] %s, %zu rim pixels of mean brightness %.4f: off by %.4f without occlusion, %.4f with it on solids "
      "alone, %.4f inferred (%.0f%%)\n",
      name.c_str(), rims, level / count, open / count, bright / count, error / count, 100.0 * error / bright);
  ASSERT_GT(rims, 500u);
  EXPECT_LE(error, bright / 3.0);
  EXPECT_LT(bright, open * 1.05);
}

TEST(OcclusionPictures, TreeAsInFigure6) {
  holdPictures(tree(), "tree");
}

TEST(OcclusionPictures, FenceAsInFigure6) {
  holdPictures(fence(), "fence");
}

}  // namespace
}  // namespace pellucid
