#include "composite/cli/gbuffer_render.h"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <memory>

#include "composite/cli/results.h"
#include "engine_bridge/embree/opaque_render.h"
#include "engine_bridge/gl/opaque_pass.h"
#include "engine_bridge/scene/set_keys.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

constexpr int kLongestEdge = 65536;

// Says how far a long render is, not more often than one can read.
class SlowRender {
 public:
  void operator()(double done) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds(5) || done >= 1.0) return;
    last_ = now;
    note("gbuffer: {:.0f}% of the picture", 100.0 * done);
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

std::optional<ShotMoment> playAnimations(const ShotTime& time, SceneOptions& options) {
  checkTime(time);
  const std::optional<ShotMoment> moment = momentOf(time, {});
  options.animations = time.animations;
  options.secondsBy = moment ? moment->origin : "--frame N or --time SECONDS plays them";
  if (moment) options.seconds = moment->seconds;
  if (!moment && !time.none() && (!time.animations.empty() || time.framesPerSecond || time.offset))
    throw UsageError("--animation, --fps and --time-offset: found no time, expected --frame N or --time SECONDS");
  return moment;
}

Window parseSize(const std::string& text) {
  int width = 0, height = 0;
  const char* end = text.data() + text.size();
  const auto [cross, first] = std::from_chars(text.data(), end, width);
  if (first == std::errc() && cross != end && *cross == 'x') {
    const auto [rest, second] = std::from_chars(cross + 1, end, height);
    if (second == std::errc() && rest == end && width > 0 && height > 0 && width <= kLongestEdge &&
        height <= kLongestEdge)
      return {0, 0, width, height};
  }
  throw UsageError(fmt::format("--size: found '{}', expected WIDTHxHEIGHT, each from 1 to {}", text, kLongestEdge));
}

std::map<std::string, std::string> withSettings(const GbufferFlags& flags,
                                                std::map<std::string, std::string> attributes) {
  const PixelFilter filter = flags.filter.empty() ? PixelFilter() : parsePixelFilter(flags.filter);
  if (!filter.isPixelSquare()) attributes[kFilterAttribute] = filterText(filter);
  if (const auto frame = flags.time.time().frame) attributes["Frame"] = std::to_string(*frame);
  if (const auto time = timeToState(flags.time.time())) attributes[kTimeAttribute] = timeText(*time);
  const std::optional<Shutter> shutter = flags.blur.shutterAsked();
  if (shutter && shutter->opens()) attributes[kShutterAttribute] = shutterText({shutter->open, shutter->close});
  return attributes;
}

namespace {

void checkFilter(const GbufferFlags& flags) {
  if (flags.filter.empty()) return;
  parsePixelFilter(flags.filter);
  if (flags.renderer == "gl")
    throw UsageError(fmt::format(
        "--filter: found {} with --renderer gl, expected --renderer embree: gl samples pixel centres", flags.filter));
  if (flags.samples == 1)
    throw UsageError(fmt::format(
        "--filter: found {} with --samples 1, expected 2 or more: one sample is the pixel's centre", flags.filter));
}

void checkTraced(const GbufferFlags& flags) {
  if (flags.textureFilter == "mipmap")
    throw UsageError(
        "--texture-filter: found mipmap, expected bilinear or nearest with --renderer embree: its samples filter");
  if (flags.textureFilter == "nearest")
    throw UsageError("--texture-filter: found nearest, expected bilinear with --renderer embree");
  if (flags.device >= 0) throw UsageError("--device: expected --renderer gl: Embree runs on the CPU");
}

void checkRasterised(const GbufferFlags& flags) {
  if (flags.samples.value_or(1) != 1)
    throw UsageError(
        fmt::format("--samples: found {}, expected 1 with --renderer gl: it samples pixel centres", *flags.samples));
  if (flags.shadows == "exact")
    throw UsageError("--shadows: found exact, expected off with --renderer gl: it traces no rays");
  if (flags.aoRadius.value_or(0.0) > 0.0)
    throw UsageError("--ao-radius: expected --renderer embree: gl traces no rays");
  if (!flags.environment.empty() && !isColour(flags.environment))
    throw UsageError(fmt::format("--environment: found '{}', expected R,G,B with --renderer gl", flags.environment));
}

}  // namespace

void checkFlags(const GbufferFlags& flags) {
  gltf::checkOverrides(flags.overrides);
  checkFilter(flags);
  if (isColour(flags.environment)) parseColour(flags.environment, "--environment");
  flags.renderer == "gl" ? checkRasterised(flags) : checkTraced(flags);
}

OpaquePlanes trace(const GbufferFlags& flags, const Scene& scene, const Camera& camera, const Window& window,
                   std::optional<int> samples, const ColourSpace& space, const std::function<void(double)>& told,
                   Stages& stages) {
  OpaqueRenderSettings settings;
  settings.samples = samples.value_or(settings.samples);
  if (!flags.filter.empty()) settings.pixelFilter = parsePixelFilter(flags.filter);
  Environment environment;
  std::vector<std::string> notes;
  if (isColour(flags.environment))
    environment = Environment(parseColour(flags.environment, "--environment"));
  else if (!flags.environment.empty())
    environment =
        stages.time("read environment", [&] { return readEnvironment(flags.environment, notes, space.fromRec709); });
  say(notes);
  settings.shadows = flags.shadows != "off";
  settings.aoRadius = static_cast<float>(flags.aoRadius.value_or(static_cast<double>(settings.aoRadius)));
  settings.progress = [notes = std::make_shared<SlowRender>(), told](double done) {
    (*notes)(done);
    if (told) told(done);
  };
  return stages.time("trace", [&] { return renderOpaque(scene, camera, window, window, environment, settings); });
}

OpaquePlanes rasterise(const GbufferFlags& flags, const Scene& scene, const Camera& camera, const Window& window,
                       Stages& stages, std::string& device) {
  OpaquePassSettings settings;
  settings.filter = flags.textureFilter == "bilinear"  ? TextureFilter::bilinear
                    : flags.textureFilter == "nearest" ? TextureFilter::nearest
                                                       : TextureFilter::mipmap;
  if (isColour(flags.environment)) settings.surroundings = parseColour(flags.environment, "--environment");
  GlContext context(flags.device);
  device = context.description();
  return stages.time("rasterise", [&] { return rasteriseOpaque(context, scene, camera, window, window, settings); });
}

}  // namespace pellucid::cli
