// Inferred occlusion against rays shot from each rim's own point.
#include <gtest/gtest.h>

#include <string>

#include "composite/screen_occlusion.h"
#include "tests/occlusion/plants_scene.h"

namespace pellucid {
namespace {

using namespace test;

constexpr int kRelative = shading::PLD_OCCLUSION_RELATIVE, kPublished = shading::PLD_OCCLUSION_PUBLISHED;
constexpr int kLines = 216;     // of the crop
constexpr double kFlat = 1e-5;  // metres: how far points of one card lie from its plane

class Mean {
 public:
  void add(double value) { sum_ += std::abs(value), ++count_; }
  double value() const { return count_ ? sum_ / static_cast<double>(count_) : 0.0; }
  std::size_t count() const { return count_; }

 private:
  double sum_ = 0;
  std::size_t count_ = 0;
};

struct Errors {
  Mean none, inferred, published, screen;  // at every rim in front, by its own gradient, as in the pass
  Mean fileNone, file;                     // at the layer's rims, by the picture's gradient
  Mean stepNone, stepInferred, stepTruth;  // rim - interior, in ambient light
};

// Occlusion of the nearest wholly covered pixel of the same card within two pixels; negative without one.
double interiorBeside(const LeafPicture& picture, const OccluderPlanes& occluders, int x, int y) {
  double found = -1.0, nearest = 9.0;
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx) {
      const int u = x + dx, v = y + dy;
      if (u < 0 || v < 0 || u >= picture.viewZ.width() || v >= picture.viewZ.height()) continue;
      if (!std::isfinite(picture.viewZ.at(u, v))) continue;
      const glm::dvec3 between = picture.solidPoint.at(u, v) - picture.rimPoint.at(x, y);
      const double off = std::abs(glm::dot(between, picture.rimNormal.at(x, y))), distance = std::hypot(dx, dy);
      if (off > kFlat || distance >= nearest) continue;
      nearest = distance;
      found = static_cast<double>(occluders.occlusion.at(u, v));
    }
  return found;
}

// Of the crop, from the depth of the whole picture: what hides a leaf may stand outside of the crop.
Image<float> occlusionFromDepth(const PlantScene& scene, const LeafPicture& crop) {
  LeafView whole = scene.view;
  whole.data = {};
  const LeafPicture picture = scene.world->picture(whole);
  ScreenOcclusionSettings settings;
  settings.radius = kReach;
  const Image<float> all = screenOcclusion(picture.viewZ, picture.camera, picture.display, picture.data, settings);
  Image<float> part(crop.data.width(), crop.data.height());
  for (int y = 0; y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x) part.at(x, y) = all.at(crop.data.x0 + x, crop.data.y0 + y);
  return part;
}

//   fromDepth  also measures occlusion from depth alone
Errors measure(const PlantScene& scene, bool fromDepth) {
  const LeafPicture picture = scene.world->picture(scene.view);
  const OccluderPlanes occluders = tracedOccluders(scene, picture, 64);
  OccluderPlanes screen = occluders;
  if (fromDepth) screen.occlusion = occlusionFromDepth(scene, picture);
  const Image<float> file = inferOcclusion(picture.layer, occluders, kRelative).occlusion;
  Errors errors;
  for (int y = 0; y < file.height(); ++y)
    for (int x = 0; x < file.width(); ++x) {
      if (!shading::isRim(picture.rims.coverage.at(x, y))) continue;
      const double truth = scene.world->open(picture.rimPoint.at(x, y), picture.rimNormal.at(x, y), kReach, 144,
                                             static_cast<std::uint32_t>(x * 7919 + y));
      const auto inPass = [&](const OccluderPlanes& planes, int form) {
        return static_cast<double>(inferredInPass(picture, planes, x, y, form));
      };
      const double inferred = inPass(occluders, kRelative);
      errors.none.add(1.0 - truth);
      errors.inferred.add(inferred - truth);
      errors.published.add(inPass(occluders, kPublished) - truth);
      errors.screen.add(inPass(screen, kRelative) - truth);
      if (shading::isRim(picture.layer.coverage.at(x, y))) {
        errors.fileNone.add(1.0 - truth);
        errors.file.add(static_cast<double>(file.at(x, y)) - truth);
      }
      const double interior = interiorBeside(picture, occluders, x, y);
      if (interior < 0.0) continue;
      errors.stepNone.add(1.0 - interior);
      errors.stepInferred.add(inferred - interior);
      errors.stepTruth.add(truth - interior);
    }
  return errors;
}

void holdAgainstRays(PlantScene (*make)(double), const std::string& name) {
  int asFile = 0;
  for (const int height : {540, 1080, 2160}) {
    PlantScene scene = make(1.0);
    crop(scene.view, height, kLines);
    const bool fromDepth = height == 540;  // depends on no resolution, and larger pictures take long
    const Errors errors = measure(scene, fromDepth);
    const double ratio = errors.inferred.value() / errors.none.value();
    const double fall = 1.0 - errors.stepInferred.value() / errors.stepNone.value();
    printf("[ figure ] %s, %d lines: %zu rims: mean error none %.4f, inferred %.4f (%.0f%%), published %.4f\n",
           name.c_str(), height, errors.none.count(), errors.none.value(), errors.inferred.value(), 100 * ratio,
           errors.published.value());
    if (fromDepth) {
      printf("[ figure ]   with sources from depth alone %.4f (%.0f%%)\n", errors.screen.value(),
             100 * errors.screen.value() / errors.none.value());
      EXPECT_LE(errors.screen.value(), 0.4 * errors.none.value());
    }
    printf("[ figure ]   rim step %.4f -> %.4f (falls by %.0f%%; traced %.4f)\n", errors.stepNone.value(),
           errors.stepInferred.value(), 100 * fall, errors.stepTruth.value());
    // A layer shows only the rims that stand before nothing of the layer itself: close crops of the fence have none.
    if (errors.file.count() > 50) {
      const double fileRatio = errors.file.value() / errors.fileNone.value();
      printf("[ figure ]   as a file: %zu rims: none %.4f, inferred %.4f (%.0f%%)\n", errors.file.count(),
             errors.fileNone.value(), errors.file.value(), 100 * fileRatio);
      EXPECT_LE(fileRatio, 1.0 / 3.0);
      ++asFile;
    }
    ASSERT_GT(errors.none.count(), 500u);
    EXPECT_LE(ratio, 1.0 / 3.0);
    EXPECT_GE(fall, 0.8);
    EXPECT_LT(errors.inferred.value(), errors.published.value() * 1.02);  // never worse than as printed
  }
  EXPECT_GE(asFile, 1);
}

TEST(InferredOcclusion, TreeRimsMatchRays) {
  holdAgainstRays(treeScene, "tree");
}

TEST(InferredOcclusion, FenceRimsMatchRays) {
  holdAgainstRays(fenceScene, "fence");
}

// Rims in front of nothing: the published floor turns them black, ours leave them as open as their leaf.
TEST(InferredOcclusion, SkyBehindLeavesMakesNoBlackFringe) {
  PlantScene scene = treeScene();
  scene.view.target = {0.0, 2.1, 0.0};  // the top of the crown
  crop(scene.view, 540, kLines);
  const LeafPicture picture = scene.world->picture(scene.view);
  const OccluderPlanes occluders = tracedOccluders(scene, picture, 64);
  std::size_t fringe = 0, black = 0, publishedBlack = 0;
  for (int y = 0; y < picture.viewZ.height(); ++y)
    for (int x = 0; x < picture.viewZ.width(); ++x) {
      if (!shading::isRim(picture.rims.coverage.at(x, y)) || std::isfinite(picture.viewZ.at(x, y))) continue;
      const double truth = scene.world->open(picture.rimPoint.at(x, y), picture.rimNormal.at(x, y), kReach, 64, 1);
      if (truth < 0.5) continue;
      ++fringe;
      black += inferredInPass(picture, occluders, x, y, kRelative) < 0.2f;
      publishedBlack += inferredInPass(picture, occluders, x, y, kPublished) < 0.2f;
    }
  printf("[ figure ] %zu open rims against the sky: black in ours %zu, as published %zu\n", fringe, black,
         publishedBlack);
  ASSERT_GT(fringe, 300u);
  EXPECT_LE(black, fringe / 100);
  EXPECT_GT(publishedBlack, 2 * black);
}

// The same scene in other units: 0.01 m of depth difference means something else in each.
TEST(InferredOcclusion, SceneScaleChangesNothing) {
  const auto occlusions = [](double scale, int form) {
    PlantScene scene = treeScene(scale);
    crop(scene.view, 540, 108);
    const LeafPicture picture = scene.world->picture(scene.view);
    OccluderPlanes occluders;
    occluders.data = picture.data;
    occluders.viewZ = picture.viewZ;
    // From depth, with the radius that no unit enters.
    occluders.occlusion = screenOcclusion(picture.viewZ, picture.camera, picture.display, picture.data, {});
    return inferOcclusion(picture.layer, occluders, form).occlusion;
  };
  for (const int form : {kRelative, kPublished}) {
    const Image<float> one = occlusions(1.0, form);
    for (const double scale : {0.01, 100.0}) {
      const Image<float> other = occlusions(scale, form);
      std::vector<double> differences;
      for (std::size_t i = 0; i < one.size(); ++i)
        if (one[i] < 1.0f || other[i] < 1.0f)
          differences.push_back(std::abs(static_cast<double>(one[i]) - static_cast<double>(other[i])));
      std::sort(differences.begin(), differences.end());
      ASSERT_GT(differences.size(), 300u);
      const double mean = [&] {
        double sum = 0;
        for (const double d : differences) sum += d;
        return sum / static_cast<double>(differences.size());
      }();
      const double most = differences[differences.size() * 99 / 100];
      printf("[ figure ] %s form, scene times %g: occlusion differs by mean %.2g, 99th percentile %.2g\n",
             form == kRelative ? "relative" : "published", scale, mean, most);
      if (form == kRelative) {
        EXPECT_LE(mean, 1e-3);
        EXPECT_LE(most, 1e-3);
      } else {
        EXPECT_GT(mean, 1e-2);
      }
    }
  }
}

}  // namespace
}  // namespace pellucid
