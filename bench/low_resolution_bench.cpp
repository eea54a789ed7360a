// What low resolution saves: the same smoke, 96 soft lit cards over 1280 x 720, drawn at full resolution and at a half,
// a quarter and an eighth of it, sums brought back to full resolution included. Prints each time and the ratio to it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "composite/low_resolution.h"
#include "composite/pipeline/sums.h"
#include "tests/gl/builder.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kRuns = 3;

test::Stage smoke() {
  test::Stage stage(kWidth, kHeight);
  test::Random random(5);
  std::vector<glm::vec4> texels;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const double r = std::hypot(x - 31.5, y - 31.5) / 32.0;
      texels.push_back(glm::vec4(1, 1, 1, static_cast<float>(std::max(0.0, 1.0 - r * r))));
    }
  Material material = test::unlitBlend(glm::vec3(0.8f), 0.5f);
  material.unlit = false;
  material.metallic = 0.0f;
  material.lowResolution = true;
  material.baseColorTexture.texture = stage.texture(64, 64, texels);
  const int soft = stage.add(material);
  for (int i = 0; i < 96; ++i) {
    const double x = random.between(-100, kWidth - 200), y = random.between(-100, kHeight - 200);
    const double edge = random.between(250, 450);
    stage.quad(x, y, x + edge, y + edge, random.between(3, 30), soft);
  }
  Light light;
  light.kind = LightKind::directional;
  light.intensity = 3.0f;
  stage.scene.lights.push_back(light);
  return stage;
}

// The sums of a frame, its marked layers at 1/factor.
void draw(TransparentPass& pass, const test::Stage& stage, const PassSettings& settings, int factor) {
  if (factor == 1) {
    pass.accumulate(settings);
    return;
  }
  PassSettings full = settings;
  full.layers = LayerChoice::fullResolution;
  OitPlanes planes = pass.accumulate(full);
  const LowView view = lowViewOf(stage.gbuffer, planes.solid, stage.camera, factor);
  OitPlanes low;
  {
    const DrawnOver over(pass, view, stage.gbuffer, stage.camera);
    low = pass.accumulate(lowResolutionPart(settings));
  }
  addLowResolution(low, view, settings.sample, planes);
}

double secondsAt(TransparentPass& pass, const test::Stage& stage, int factor) {
  PassSettings settings;
  settings.surroundings = glm::vec3(0.3f);
  double best = 1e9;
  for (int run = 0; run <= kRuns; ++run) {  // the first compiles
    const auto start = std::chrono::steady_clock::now();
    draw(pass, stage, settings, factor);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (run > 0) best = std::min(best, seconds);
  }
  return best;
}

void measure() {
  const test::Stage stage = smoke();
  GlContext context;
  TransparentPass pass(context, stage.scene, stage.gbuffer, stage.camera);
  const double full = secondsAt(pass, stage, 1);
  std::printf("smoke at full resolution        %8.1f ms\n", 1e3 * full);
  for (const int factor : {2, 4, 8}) {
    const double low = secondsAt(pass, stage, factor);
    std::printf("at 1/%d, upsampling included     %8.1f ms   %.2f times as fast\n", factor, 1e3 * low, full / low);
  }
}

}  // namespace
}  // namespace pellucid

int main() {
  pellucid::measure();
}
