#include "gbuffer/depth_kind.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
constexpr double kLargestHalf = 65504.0;
// Renderers write 1e9 (several), 1e10 and 1e11 (Blender), 1e12 and 1e30 (Arnold) or FLT_MAX.
constexpr double kDefaultFar = 1e9;

struct MeaningName {
  DepthMeaning meaning;
  const char* name;
  const char* words;
};
constexpr MeaningName kNames[] = {
    {DepthMeaning::planar, "planar", "planar depth"},
    {DepthMeaning::ray, "ray", "distance along the ray"},
    {DepthMeaning::inverse, "inverse", "1 / planar depth"},
    {DepthMeaning::device, "device", "window depth"},
    {DepthMeaning::negative, "negative", "negative planar depth"},
    {DepthMeaning::normalised, "normalised", "planar depth normalised to 0 to 1"},
};

const MeaningName& nameOf(DepthMeaning meaning) {
  for (const MeaningName& row : kNames)
    if (row.meaning == meaning) return row;
  return kNames[0];
}

std::optional<double> numberOf(const std::string& text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, problem] = std::from_chars(text.data(), end, value);
  if (problem != std::errc() || stopped != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

double defaultFar(const DepthKind& kind, PixelType type) {
  if (kind.meaning == DepthMeaning::device) return kind.reversed ? 0.0 : 1.0;
  if (kind.meaning == DepthMeaning::normalised) return kind.inverted ? 0.0 : 1.0;
  if (kind.meaning == DepthMeaning::inverse) return 1.0 / kDefaultFar;
  return type == PixelType::half ? kLargestHalf : kDefaultFar;
}

}  // namespace

DepthKind parseDepthKind(const std::string& text) {
  if (text == "auto") return parseDepthKind("planar|ray|inverse");
  if (text.find('|') != std::string::npos) {
    DepthKind either{DepthMeaning::evidence};
    std::istringstream all(text);
    for (std::string one; std::getline(all, one, '|');)
      either.candidates |= 1u << static_cast<int>(parseDepthKind(one).meaning);
    return either;
  }
  std::vector<std::string> words;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ':');) words.push_back(word);
  const auto refuse = [&]() -> DepthKind {
    throw UsageError(fmt::format("--depth-kind: found '{}', expected {}", text, depthKindForms()));
  };
  if (words.empty() || text.back() == ':') return refuse();
  for (const MeaningName& row : kNames) {
    if (words[0] != row.name) continue;
    DepthKind kind;
    kind.meaning = row.meaning;
    if (kind.meaning == DepthMeaning::device && words.size() == 2 && words[1] == "reversed") {
      kind.reversed = true;
      return kind;
    }
    if (kind.mayBeNegated() && words.size() == 2 && words[1] == "negative") {
      kind.negated = true;
      return kind;
    }
    if (kind.meaning != DepthMeaning::normalised) return words.size() == 1 ? kind : refuse();
    kind.inverted = words.size() == 4 && words[3] == "inverted";
    if (words.size() != 3 && !kind.inverted) return refuse();
    const std::optional<double> from = numberOf(words[1]), to = numberOf(words[2]);
    if (!from || !to || !(*from >= 0.0) || !(*to > *from)) return refuse();
    kind.rangeNear = *from;
    kind.rangeFar = *to;
    return kind;
  }
  return refuse();
}

std::string depthKindForms() {
  return "planar, ray, inverse, device, device:reversed, negative, ray:negative, inverse:negative, "
         "normalised:NEAR:FAR[:inverted] with 0 <= NEAR < FAR in the file's unit, or auto";
}

std::string depthKindText(const DepthKind& kind) {
  if (kind.meaning == DepthMeaning::evidence) {
    std::string text;
    for (const MeaningName& row : kNames)
      if (kind.mayBe(row.meaning)) text += (text.empty() ? "" : " or ") + std::string(row.name);
    return text;
  }
  if (kind.meaning == DepthMeaning::normalised)
    return fmt::format("normalised:{:g}:{:g}{}", kind.rangeNear, kind.rangeFar, kind.inverted ? ":inverted" : "");
  return std::string(nameOf(kind.meaning).name) + (kind.reversed ? ":reversed" : kind.negated ? ":negative" : "");
}

std::string depthKindWords(const DepthKind& kind) {
  return fmt::format("{}{} ({})", kind.negated ? "minus " : "", nameOf(kind.meaning).words, depthKindText(kind));
}

bool needsCamera(const DepthKind& kind) {
  return kind.meaning == DepthMeaning::ray || kind.meaning == DepthMeaning::device ||
         kind.meaning == DepthMeaning::evidence;
}

double rayOverPlanar(const Camera& camera, const Window& display, double x, double y) {
  if (camera.orthographic) return 1.0;
  const double ndcX = 2.0 * (x - display.x0) / display.width() - 1.0;
  const double ndcY = 1.0 - 2.0 * (y - display.y0) / display.height();
  const double a = (ndcX - camera.centre.x) / camera.focal.x, b = (ndcY - camera.centre.y) / camera.focal.y;
  return std::sqrt(1.0 + a * a + b * b);
}

DepthConverter::DepthConverter(const DepthKind& kind, PixelType type, std::optional<double> far, double unit,
                               const Camera* camera, const Window& display, const std::string& what)
    : kind_(kind), far_(far.value_or(defaultFar(kind, type))), unit_(unit), camera_(camera), display_(display) {
  const bool device = kind.meaning == DepthMeaning::device;
  if ((kind.meaning == DepthMeaning::ray || device) && !camera)
    throw MeaningError(
        fmt::format("{}: found no camera, expected one to convert --depth-kind {}", what, depthKindText(kind)));
  const bool endless = device && !camera->orthographic && camera->rangeNear > 0.0 && camera->rangeFar == 0.0;
  if (device && !endless && !(camera->rangeNear > 0.0 && camera->rangeFar > camera->rangeNear))
    throw MeaningError(
        fmt::format("{}: found the clip range {} to {}, expected a camera with 0 < near < far to "
                    "convert --depth-kind {}",
                    what, camera->rangeNear, camera->rangeFar, depthKindText(kind)));
  const bool mayBeZero = kind.reversed || kind.inverted;
  if (!(far_ > 0.0) && !(mayBeZero && far_ >= 0.0))
    throw UsageError(fmt::format("--far: found {}, expected a number above 0", far_));
}

DepthConverter DepthConverter::planar() const {
  DepthConverter converter = *this;
  converter.kind_ = {};
  converter.far_ = defaultFar(converter.kind_, PixelType::float32);
  return converter;
}

// A perspective camera that states near without far has none: its projection is the limit.
double DepthConverter::deviceDistance(double value) const {
  const double n = camera_->rangeNear, f = camera_->rangeFar;
  if (camera_->orthographic) return kind_.reversed ? f - value * (f - n) : n + value * (f - n);
  if (f == 0.0) return n / (kind_.reversed ? value : 1.0 - value);
  return kind_.reversed ? n * f / (n + value * (f - n)) : n * f / (f - value * (f - n));
}

double DepthConverter::stretch(double z) const {
  if (kind_.meaning == DepthMeaning::normalised && kind_.inverted)
    return (kind_.rangeFar - kind_.rangeNear) * unit_ / z;
  if (kind_.meaning != DepthMeaning::device) return 0.0;
  if (camera_->orthographic) return (camera_->rangeFar - camera_->rangeNear) / z;
  if (kind_.reversed) return 0.0;  // 1/z but for what the far plane adds
  return z * (1.0 / camera_->rangeNear - (camera_->rangeFar > 0.0 ? 1.0 / camera_->rangeFar : 0.0));
}

double DepthConverter::distance(double value, double x, double y) const {
  if (kind_.negated) value = -value;
  switch (kind_.meaning) {
    case DepthMeaning::planar:
    case DepthMeaning::evidence:
      return value * unit_;
    case DepthMeaning::negative:
      return -value * unit_;
    case DepthMeaning::inverse:
      return unit_ / value;
    case DepthMeaning::normalised:
      return (kind_.rangeNear + (kind_.inverted ? 1.0 - value : value) * (kind_.rangeFar - kind_.rangeNear)) * unit_;
    case DepthMeaning::device:
      return deviceDistance(value);
    case DepthMeaning::ray:
      return value * unit_ / rayOverPlanar(*camera_, display_, x, y);
  }
  return kNothing;
}

double DepthConverter::operator()(double value, double x, double y) const {
  if (!std::isfinite(value)) return kNothing;
  const bool downwards = kind_.meaning == DepthMeaning::inverse || kind_.reversed || kind_.inverted;
  const double size = kind_.negated ? -value : value;
  if (kind_.meaning == DepthMeaning::negative) {
    if (!(value < 0.0) || value <= -far_) return kNothing;
  } else if (kind_.meaning == DepthMeaning::normalised && !kind_.inverted) {
    if (!(value >= 0.0) || value >= far_) return kNothing;  // 0 is at NEAR
  } else if (!(size > 0.0) || (downwards ? size <= far_ : size >= far_)) {
    return kNothing;
  }
  return distance(value, x, y);
}

}  // namespace pellucid
