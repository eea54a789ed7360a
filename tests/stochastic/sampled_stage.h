// Stages of layers as the device samples them.
#pragma once
#include <vector>

#include "engine_bridge/gl/stochastic_pass.h"
#include "tests/gl/builder.h"
#include "tests/stochastic/sampled_stacks.h"

namespace pellucid::test {

inline StochasticPassSettings passOf(const StochasticSettings& settings) {
  StochasticPassSettings pass;
  pass.samples = settings.samples;
  pass.stratified = settings.stratified;
  pass.winnersOnly = settings.variant != StochasticSettings::Variant::depth;
  pass.seed = settings.seed;
  return pass;
}

inline StochasticSums sumsAt(const StochasticPlanes& planes, int x, int y) {
  StochasticSums sums;
  sums.light = planes.light.at(x, y);
  sums.unit = planes.unit.at(x, y);
  sums.added = planes.added.at(x, y);
  sums.empty = planes.empty.at(x, y);
  sums.beta = planes.beta.at(x, y);
  return sums;
}

inline glm::dvec3 pictureOf(const StochasticSums& sums, const glm::dvec3& behind, const StochasticSettings& settings) {
  const glm::dvec3 shows = correctsBackground(settings) ? sums.beta : sums.empty;
  return stochasticLight(sums, glm::dvec3(1.0) - sums.beta, settings) + shows * behind;
}

inline StochasticPlanes sampleStage(const Stage& stage, const StochasticPassSettings& samples,
                                    const PassSettings& settings = {}) {
  GlContext context;
  StochasticPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  return pass.sample(settings, samples);
}

// Glass, smoke, a flame, coincident panes and a solid leaf.
inline Stage mixture() {
  Stage stage(48, 40);
  Material pane;
  pane.doubleSided = true;
  pane.metallic = 0;
  pane.transmission = 1;
  pane.ior = 1;
  pane.unlit = true;
  pane.baseColor = {.9f, .5f, .1f, 1};
  const int glass = stage.add(pane);
  Material flame = unlitBlend({3, 1, .2f}, .5f);
  flame.additive = true;
  const int fire = stage.add(flame), smoke = stage.add(unlitBlend({.6f, .6f, .7f}, .3f)),
            thin = stage.add(unlitBlend({1, 1, 1}, .003f)), leaf = stage.add(unlitBlend({.1f, .5f, .1f}, 1));
  stage.quad(2, 2, 40, 30, 2, glass);
  stage.quad(10, 5, 46, 38, 3, smoke);
  stage.quad(5, 12, 30, 36, 3, smoke);  // at the same depth
  stage.slanted(0, 8, 48, 33, 1.5, 4, smoke);
  stage.quad(20, 0, 47, 22, 2.5, fire);
  stage.quad(0, 0, 48, 40, 1.2, thin);
  stage.quad(28, 20, 40, 40, 3.5, leaf);
  stage.quad(0, 0, 48, 40, 5, glass);
  return stage;
}

}  // namespace pellucid::test
