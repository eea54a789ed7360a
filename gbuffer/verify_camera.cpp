#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gbuffer/channels.h"
#include "gbuffer/errors.h"
#include "gbuffer/opaque_io.h"
#include "gbuffer/pixel_rows.h"

namespace pellucid {
namespace {

// Filtered positions lie within their pixel; lens and motion blur widen that. A wrong camera is off by tens.
constexpr double kLargestResidual = 2.0;     // pixels
constexpr double kLargestDepthError = 0.02;  // relative
constexpr std::size_t kFewestPixels = 16;
constexpr std::size_t kMostPixels = 20000;  // a median needs no more

struct Sample {
  glm::dvec3 position;  // as the file says it, in metres
  glm::dvec2 pixel;
  double z;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<Sample> samplesOf(const OpaqueFile& file, const PassChannels& pass, double unit) {
  const GBuffer& gbuffer = file.gbuffer;
  const ExrPart& part = file.document.parts[static_cast<std::size_t>(pass.part)];
  Image<glm::vec3> position(gbuffer.data.width(), gbuffer.data.height(), glm::vec3(0.0f));
  for (int c = 0; c < 3; ++c)
    visitPixels(*pass.channel[c], part.data, gbuffer.data,
                [&](int x, int y, float value) { position.at(x, y)[c] = value; });
  std::vector<Sample> samples;
  const auto every = std::max<std::size_t>(1, position.size() / kMostPixels);
  const auto width = static_cast<std::size_t>(gbuffer.data.width());
  for (std::size_t i = 0; i < position.size(); i += every) {
    const glm::vec3& p = position[i];
    // 0 is what renderers write where nothing was hit.
    if (!std::isfinite(gbuffer.viewZ[i]) || p == glm::vec3(0.0f) || !std::isfinite(p.x + p.y + p.z)) continue;
    samples.push_back(
        {glm::dvec3(p) * unit,
         {gbuffer.data.x0 + static_cast<int>(i % width) + 0.5, gbuffer.data.y0 + static_cast<int>(i / width) + 0.5},
         static_cast<double>(gbuffer.viewZ[i])});
  }
  return samples;
}

struct Fit {
  double residual = 0, depthError = 0;
};

template <class World>
Fit fitOf(const std::vector<Sample>& samples, const Camera& camera, const Window& display, World world) {
  std::vector<double> residuals, depthErrors;
  for (const Sample& sample : samples) {
    const Projected projected = project(camera, display, world(sample.position));
    const double off = glm::length(projected.pixel - sample.pixel);
    // Behind the camera or in its plane: as wrong as can be.
    residuals.push_back(projected.z > 0 && std::isfinite(off) ? off : 1e30);
    depthErrors.push_back(std::abs(projected.z / sample.z - 1.0));
  }
  return {median(std::move(residuals)), median(std::move(depthErrors))};
}

// The pass that its name calls positions, else the layer whose Z was taken for the depth.
std::optional<PassChannels> positionPass(const OpaqueFile& file) {
  const std::vector<NamedChannel> channels = nameChannels(file.document);
  BeautyChannels beauty;
  for (const NamedChannel& named : channels)
    if (named.part == file.choice.beautyPart && named.channel->name == file.choice.beautyChannel[0]) {
      beauty.part = named.part;
      beauty.view = named.view;
      beauty.layers = named.layers;
    }
  if (const auto pass = resolvePass(channels, beauty, Pass::position)) return pass;
  for (const NamedChannel& named : channels)
    if (named.part == file.choice.depthPart && named.channel->name == file.choice.depthChannel)
      return positionsOf(channels, named);
  return std::nullopt;
}

}  // namespace

std::optional<double> verifyCamera(const OpaqueFile& file, const Camera& camera) {
  const std::optional<PassChannels> pass = positionPass(file);
  if (!pass) return std::nullopt;
  const std::vector<Sample> samples = samplesOf(file, *pass, file.metresPerUnit);
  if (samples.size() < kFewestPixels) return std::nullopt;

  Camera own = camera;  // positions in camera space: pbrt's, and variants of other renderers' passes
  own.viewFromWorld = glm::dmat4(1.0);
  const Window& display = file.gbuffer.display;
  const Fit fits[] = {
      fitOf(samples, camera, display, [](glm::dvec3 p) { return p; }),
      fitOf(samples, camera, display, [](glm::dvec3 p) { return glm::dvec3(p.x, p.z, -p.y); }),
      fitOf(samples, own, display, [](glm::dvec3 p) { return p; }),
      fitOf(samples, own, display, [](glm::dvec3 p) { return glm::dvec3(p.x, p.y, -p.z); }),
  };
  const Fit best = *std::min_element(std::begin(fits), std::end(fits),
                                     [](const Fit& a, const Fit& b) { return a.residual < b.residual; });
  if (!(best.residual <= kLargestResidual))
    throw MeaningError(
        fmt::format("{}: camera {}: found positions {} a median of {:.3g} pixels from where it sees them, "
                    "expected at most {}: another --camera?",
                    file.document.path, camera.origin, pass->layerName, best.residual, kLargestResidual));
  if (!(best.depthError <= kLargestDepthError))
    throw MeaningError(
        fmt::format("{}: camera {}: found positions {} a median of {:.3g}% from the depth {}, expected at "
                    "most {:.3g}%: another --depth, --depth-kind or --unit?",
                    file.document.path, camera.origin, pass->layerName, 100 * best.depthError, file.choice.depthChannel,
                    100 * kLargestDepthError));
  return best.residual;
}

}  // namespace pellucid
