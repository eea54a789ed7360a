#include "gbuffer/depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gbuffer/errors.h"
#include "gbuffer/pixel_rows.h"

namespace pellucid {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr double kLargestHalf = 65504.0;
// Renderers write 1e9 (several), 1e10 and 1e11 (Blender), 1e12 and 1e30 (Arnold) or FLT_MAX.
constexpr double kDefaultFar = 1e9;

enum class Kind { planar, ray, inverse, device };

Kind kindOf(const std::string& name) {
  if (name == "planar") return Kind::planar;
  if (name == "ray") return Kind::ray;
  if (name == "inverse") return Kind::inverse;
  if (name == "device") return Kind::device;
  throw UsageError(fmt::format("--depth-kind: found '{}', expected planar, ray, inverse or device", name));
}

double defaultFar(Kind kind, PixelType type) {
  if (kind == Kind::device) return 1.0;
  if (kind == Kind::inverse) return 1.0 / kDefaultFar;
  return type == PixelType::half ? kLargestHalf : kDefaultFar;
}

// Relative spacing of the stored numbers, twice over: the file's rounding and that of what is compared with it.
// Floats are given 8 ulp: half of one from the file, two from our conversion, the rest for depth that a rasteriser
// interpolates across a triangle.
double storedPrecision(const ExrPart& part, const ExrChannel& depth) {
  if (depth.type == PixelType::half) return 0x1p-10;
  return part.compression == "pxr24" ? 0x1p-14 : 0x1p-20;
}

struct Converter {
  Kind kind;
  double far, unit;
  const Camera* camera;

  // Planar metres, or nothing. x and y in pixels of the display window.
  double operator()(double value, double x, double y, const Window& display) const {
    const double none = static_cast<double>(kNothing);
    if (!std::isfinite(value) || !(value > 0.0)) return none;
    if (kind == Kind::inverse) return value <= far ? none : unit / value;
    if (value >= far) return none;
    if (kind == Kind::planar) return value * unit;
    if (kind == Kind::device) {
      const double n = camera->rangeNear, f = camera->rangeFar;
      return camera->orthographic ? n + value * (f - n) : n * f / (f - value * (f - n));
    }
    if (camera->orthographic) return value * unit;
    const double ndcX = 2.0 * (x - display.x0) / display.width() - 1.0;
    const double ndcY = 1.0 - 2.0 * (y - display.y0) / display.height();
    const double a = (ndcX - camera->centre.x) / camera->focal.x, b = (ndcY - camera->centre.y) / camera->focal.y;
    return value * unit / std::sqrt(1.0 + a * a + b * b);
  }
};

// A step of window depth at the median distance, relative to that distance: z = n f / (f - d (f - n)), so
// dz / z = z (1/n - 1/f) dd.
float devicePrecision(const Image<float>& viewZ, const Camera& camera, PixelType type) {
  std::vector<float> finite;
  for (std::size_t i = 0; i < viewZ.size(); ++i)
    if (std::isfinite(viewZ[i])) finite.push_back(viewZ[i]);
  if (finite.empty()) return 0.0f;
  const auto middle = finite.begin() + static_cast<std::ptrdiff_t>(finite.size() / 2);
  std::nth_element(finite.begin(), middle, finite.end());
  const double step = type == PixelType::half ? 0x1p-10 : 0x1p-22;  // twice half an ulp at 1, and as much again
  const double slope = camera.orthographic
                           ? (camera.rangeFar - camera.rangeNear) / static_cast<double>(*middle)
                           : static_cast<double>(*middle) * (1.0 / camera.rangeNear - 1.0 / camera.rangeFar);
  return static_cast<float>(step * slope);
}

}  // namespace

void convertDepth(const ExrPart& part, const ExrChannel& depth, const ReadOptions& options, const Camera* camera,
                  OpaqueFile& file) {
  GBuffer& gbuffer = file.gbuffer;
  const std::string& path = file.document.path;
  const Kind kind = kindOf(options.depthKind);
  if ((kind == Kind::ray || kind == Kind::device) && !camera)
    throw MeaningError(fmt::format("{}: depth {}: found no camera, expected one to convert --depth-kind {}", path,
                                   depth.name, options.depthKind));
  if (kind == Kind::device && !(camera->rangeNear > 0.0 && camera->rangeFar > camera->rangeNear))
    throw MeaningError(
        fmt::format("{}: depth {}: found the clip range {} to {}, expected a camera with 0 < near < far "
                    "to convert --depth-kind device",
                    path, depth.name, camera->rangeNear, camera->rangeFar));
  const double far = options.farValue.value_or(defaultFar(kind, depth.type));
  if (!(far > 0.0)) throw UsageError(fmt::format("--far: found {}, expected a number above 0", far));
  const Converter convert{kind, far, options.metresPerUnit, camera};

  file.choice.depthKind = options.depthKind;
  file.choice.farValue = far;
  gbuffer.viewZ = Image<float>(gbuffer.data.width(), gbuffer.data.height(), kNothing);
  int firstX = 0, firstY = 0;
  visitPixels(depth, part.data, gbuffer.data, [&](int x, int y, float value) {
    if (std::isnan(value) || value == -kNothing) {
      if (file.choice.nonFiniteDepth++ == 0) firstX = x, firstY = y;
    }
    const double z =
        convert(static_cast<double>(value), gbuffer.data.x0 + x + 0.5, gbuffer.data.y0 + y + 0.5, gbuffer.display);
    // A distance beyond float is nothing; one below its smallest normal number would be flushed to 0 elsewhere.
    gbuffer.viewZ.at(x, y) = z > 0.0 ? std::max(static_cast<float>(z), std::numeric_limits<float>::min()) : kNothing;
  });
  for (std::size_t i = 0; i < gbuffer.viewZ.size(); ++i)
    if (!std::isfinite(gbuffer.viewZ[i])) ++file.choice.farPixels;
  gbuffer.depthPrecision = kind == Kind::device ? devicePrecision(gbuffer.viewZ, *camera, depth.type)
                                                : static_cast<float>(storedPrecision(part, depth));

  if (file.choice.nonFiniteDepth > 0)
    file.notes.push_back(fmt::format("depth {}: {} pixels are not numbers, first at ({}, {}): taken as nothing hit",
                                     depth.name, file.choice.nonFiniteDepth, gbuffer.data.x0 + firstX,
                                     gbuffer.data.y0 + firstY));
  if (depth.type == PixelType::half)
    file.notes.push_back(fmt::format(
        "depth {} is half: surfaces closer than 1/1000 of their distance cannot be told apart", depth.name));
  if (file.choice.farPixels == gbuffer.viewZ.size())
    file.notes.push_back(fmt::format("depth {}: nothing was hit in any pixel", depth.name));
}

}  // namespace pellucid
