#include "composite/cli/gbuffer_blur.h"

#include <fmt/format.h>

#include <algorithm>

#include "composite/antialias.h"
#include "composite/cli/camera_flag.h"
#include "composite/cli/messages.h"
#include "composite/pass_points.h"
#include "composite/pipeline/shot.h"
#include "engine_bridge/scene/working_space.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

constexpr int kUsualPasses = 16, kUsualSamples = 16;

// Sums of planes in double precision.
template <class Texel, class Wide>
void add(const Image<Texel>& plane, Image<Wide>& sum) {
  if (plane.empty()) return;
  if (sum.empty()) sum = Image<Wide>(plane.width(), plane.height(), Wide(0.0));
  for (std::size_t i = 0; i < plane.size(); ++i) sum[i] += Wide(plane[i]);
}
template <class Texel, class Wide>
void meanInto(const Image<Wide>& sum, int count, Image<Texel>& plane) {
  if (sum.empty()) return;
  plane = Image<Texel>(sum.width(), sum.height());
  for (std::size_t i = 0; i < sum.size(); ++i) plane[i] = Texel(sum[i] / static_cast<double>(count));
}

struct ColourSums {
  Image<glm::dvec4> beauty;
  Image<glm::dvec3> indirect, emission;
  std::vector<std::pair<std::string, Image<glm::dvec3>>> lights;

  void addAll(const OpaquePlanes& planes) {
    add(planes.beauty, beauty);
    add(planes.indirect, indirect);
    add(planes.emission, emission);
    for (const LightPlane& light : planes.lights) {
      auto found =
          std::find_if(lights.begin(), lights.end(), [&](const auto& each) { return each.first == light.name; });
      if (found == lights.end()) found = lights.insert(lights.end(), {light.name, {}});
      add(light.radiance, found->second);
    }
  }
  void into(int count, OpaquePlanes& planes) const {
    meanInto(beauty, count, planes.beauty);
    meanInto(indirect, count, planes.indirect);
    meanInto(emission, count, planes.emission);
    planes.lights.clear();
    for (const auto& [name, sum] : lights) {
      planes.lights.push_back({name, {}});
      meanInto(sum, count, planes.lights.back().radiance);
    }
  }
};

// The camera whose pixel centres are what lies at `sample` in this one's pixels.
Camera jittered(Camera camera, glm::dvec2 sample, const Window& display) {
  camera.centre.x -= 2.0 * (sample.x - 0.5) / display.width();
  camera.centre.y += 2.0 * (sample.y - 0.5) / display.height();
  return camera;
}

bool blursAtAll(const GbufferFlags& flags) {
  const LensRequest asked = flags.blur.lens();
  const std::optional<Shutter> shutter = flags.blur.shutterAsked();
  return (shutter && shutter->opens()) || (asked.on() && asked.radius.value_or(1.0) > 0.0);
}

}  // namespace

void checkBlur(const GbufferFlags& flags, const std::optional<ShotMoment>& moment) {
  const LensRequest asked = flags.blur.lens();
  const std::optional<Shutter> shutter = flags.blur.shutterAsked();
  checkLens(asked);
  if (shutter) checkShutter(*shutter);
  if (asked.on() && !asked.focus)
    throw UsageError("--focus: found auto, expected METRES: there is no picture yet whose depth could say it");
  if (shutter && shutter->opens() && !moment)
    throw UsageError("--shutter: found no time, expected --frame N or --time SECONDS");
  if (!blursAtAll(flags) && flags.passes)
    throw UsageError("--aa: found it without --shutter and without a lens, expected one: --samples are one render's");
}

OpaquePlanes renderBlurred(const GbufferFlags& flags, Scene& scene, SceneFiles& files,
                           const std::optional<ShotMoment>& moment, const ColourSpace& space, const Camera& camera,
                           const RenderOnce& render) {
  const LensRequest asked = flags.blur.lens();
  const std::optional<Shutter> shutter = flags.blur.shutterAsked();
  const bool poses = shutter && shutter->opens();
  const bool blurs = blursAtAll(flags);
  OpaquePlanes planes = render(camera, flags.samples);
  if (!blurs) return planes;
  GBuffer frame;
  frame.display = frame.data = planes.window;
  Journal journal([](const std::string& sentence) { say(sentence); });
  ExrDocument nothing;
  nothing.path = flags.output;
  const Lens lens = lensOf(asked, nothing, frame, camera, journal);
  const int count = flags.passes.value_or(kUsualPasses);
  const int each = flags.renderer == "gl" ? 1 : std::max(1, flags.samples.value_or(kUsualSamples) / count);
  const std::vector<PassPoint> points = passPoints(count);
  ColourSums sums;
  Camera posed = camera;
  for (int i = 0; i < count; ++i) {
    const PassPoint& point = points[static_cast<std::size_t>(i)];
    if (poses && files.moves()) {
      const std::vector<int> read =
          files.pose(moment->at(shutter->open + (shutter->close - shutter->open) * point.time));
      bringInto(scene, space.fromRec709, &read);
      if (!shutter->holdsCamera) posed = chooseCamera(cameraChoice(flags.camera), frame, scene, flags.scenes.front());
    }
    const Camera from = throughLens(posed, lens, lensPoint(point.lens, lens.blades));
    // Several samples of a render cover the pixel by themselves.
    const glm::dvec2 sample = each == 1 ? samplePosition(i, count) : glm::dvec2(0.5);
    sums.addAll(render(jittered(from, sample, frame.display), each));
  }
  sums.into(count, planes);
  return planes;
}

}  // namespace pellucid::cli
