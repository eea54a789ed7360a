// The two plants that inferred occlusion is held against, and what rays say about them.
#pragma once
#include <tbb/parallel_for.h>

#include <cmath>

#include "tests/occlusion/leaf_world.h"

namespace pellucid::test {

constexpr double kReach = 0.6;  // metres: how far rays look for occluders

struct PlantScene {
  std::unique_ptr<LeafWorld> world;
  LeafView view;
  double scale = 1.0;
};

inline samples::Card ground() {
  return {{-6.0, 0.0, 6.0}, {12.0, 0.0, 0.0}, {0.0, 0.0, -12.0}};
}

inline PlantScene treeScene(double scale = 1.0) {
  PlantScene scene;
  scene.scale = scale;
  scene.world = std::make_unique<LeafWorld>(
      std::vector<LeafWorld::Group>{{samples::crown({0.0, 1.5, 0.0}, 0.75, 650, 0.2, 7), samples::leafMask(256)},
                                    {{ground()}, {}}},
      scale);
  scene.view.eye = {0.2, 1.6, 4.2};
  scene.view.target = {0.0, 1.4, 0.0};
  return scene;
}

// Pickets before pickets, with posts that stand out at both sides and a shelf over them.
inline PlantScene fenceScene(double scale = 1.0) {
  PlantScene scene;
  scene.scale = scale;
  std::vector<samples::Card> solid{ground(), {{-0.9, 1.12, 0.3}, {1.8, 0.0, 0.0}, {0.0, 0.0, -0.4}}};
  for (const double x : {-0.9, -0.3, 0.3, 0.9}) solid.push_back({{x, 0.0, 0.3}, {0.0, 0.0, -0.4}, {0.0, 1.12, 0.0}});
  scene.world = std::make_unique<LeafWorld>(
      std::vector<LeafWorld::Group>{{samples::fence({-0.9, 0.0, 0.0}, 1.8, 1.1, 3, 0.05), samples::slatMask(512)},
                                    {solid, {}}},
      scale);
  scene.view.eye = {0.35, 1.0, 2.6};
  scene.view.target = {0.0, 0.58, 0.0};
  return scene;
}

// The middle of a picture `height` pixels high (16:9), `cropHeight` of them.
inline void crop(LeafView& view, int height, int cropHeight) {
  view.height = height;
  view.width = height * 16 / 9;
  const int cropWidth = cropHeight * 16 / 9;
  const int x0 = (view.width - cropWidth) / 2, y0 = (height - cropHeight) / 2;
  view.data = {x0, y0, x0 + cropWidth, y0 + cropHeight};
}

// The opaque picture with traced occlusion.
inline OccluderPlanes tracedOccluders(const PlantScene& scene, const LeafPicture& picture, int rays) {
  OccluderPlanes occluders;
  occluders.data = picture.data;
  occluders.viewZ = picture.viewZ;
  occluders.occlusion = Image<float>(picture.viewZ.width(), picture.viewZ.height(), 1.0f);
  tbb::parallel_for(0, picture.viewZ.height(), [&](int y) {
    for (int x = 0; x < picture.viewZ.width(); ++x) {
      if (!std::isfinite(picture.viewZ.at(x, y))) continue;
      const auto seed = static_cast<std::uint32_t>(y * picture.viewZ.width() + x);
      occluders.occlusion.at(x, y) = static_cast<float>(scene.world->open(
          picture.solidPoint.at(x, y), picture.solidNormal.at(x, y), kReach * scene.scale, rays, seed));
    }
  });
  return occluders;
}

// What the pass infers at the nearest rim of a pixel, by that rim's own gradient.
inline float inferredInPass(const LeafPicture& picture, const OccluderPlanes& occluders, int x, int y, int form) {
  const shading::OcclusionSearch search = shading::occlusionSearch(picture.rimGradient.at(x, y));
  const glm::ivec2 size(picture.viewZ.width(), picture.viewZ.height());
  glm::vec2 sum(0.0f);
  for (int tap = 0; tap < search.taps; ++tap) {
    const glm::ivec2 at = shading::occlusionPixel({x, y}, search, tap, form, size);
    sum += shading::occlusionTap(search, tap, occluders.occlusion.at(at.x, at.y), occluders.viewZ.at(at.x, at.y),
                                 picture.rims.viewZ.at(x, y), form);
  }
  return shading::occlusionFrom(sum, form);
}

}  // namespace pellucid::test
