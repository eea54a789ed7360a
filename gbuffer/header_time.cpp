#include "gbuffer/header_time.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace pellucid {
namespace {

constexpr double kUsualFramesPerSecond = 24.0;
constexpr double kMostFramesPerSecond = 1e6, kMostSeconds = 1e9;
constexpr std::uint32_t kDropFrame = 1u << 6;  // of TimeCode::timeAndFlags, as the bits of TV60 have it

template <class T>
std::optional<T> valueOf(const ExrAttribute& attribute, const char* type, std::size_t at = 0) {
  T value;
  if (attribute.type != type || attribute.bytes.size() < at + sizeof value) return std::nullopt;
  std::memcpy(&value, attribute.bytes.data() + at, sizeof value);
  return value;
}

const ExrAttribute* find(const ExrDocument& document, const char* name) {
  for (const ExrPart& part : document.parts)
    if (const auto found = part.attributes.find(name); found != part.attributes.end()) return &found->second;
  return nullptr;
}

std::optional<int> wholeNumber(const ExrAttribute& attribute) {
  if (attribute.type == "string") {
    int value = 0;
    const char* end = attribute.bytes.data() + attribute.bytes.size();
    const auto [next, error] = std::from_chars(attribute.bytes.data(), end, value);
    if (error != std::errc() || next != end) return std::nullopt;
    return value;
  }
  if (const auto value = valueOf<std::int32_t>(attribute, "int")) return *value;
  if (const auto value = valueOf<float>(attribute, "float"))
    if (std::abs(*value) < 1e6f && *value == std::floor(*value)) return static_cast<int>(*value);
  return std::nullopt;
}

std::optional<double> rateOf(const ExrAttribute& attribute) {
  const auto above = valueOf<std::int32_t>(attribute, "rational", 0);
  const auto below = valueOf<std::uint32_t>(attribute, "rational", 4);
  if (!above || !below || *above <= 0 || *below == 0) return std::nullopt;
  const double rate = static_cast<double>(*above) / static_cast<double>(*below);
  return rate < kMostFramesPerSecond ? std::optional(rate) : std::nullopt;
}

// Two binary coded digits; nothing where one of them is none.
std::optional<int> digits(std::uint32_t bits, unsigned first, std::uint32_t tensMask) {
  const std::uint32_t ones = bits >> first & 0xfu, tens = bits >> (first + 4) & tensMask;
  if (ones > 9 || tens > 9) return std::nullopt;
  return static_cast<int>(tens * 10 + ones);
}

std::optional<int> framesOf(const ExrAttribute& attribute, double rate) {
  const auto bits = valueOf<std::uint32_t>(attribute, "timecode");
  if (!bits) return std::nullopt;
  const auto frames = digits(*bits, 0, 0x3u), seconds = digits(*bits, 8, 0x7u);
  const auto minutes = digits(*bits, 16, 0x7u), hours = digits(*bits, 24, 0x3u);
  if (!frames || !seconds || !minutes || !hours || *seconds > 59 || *minutes > 59 || *hours > 23) return std::nullopt;
  const int whole = static_cast<int>(std::lround(rate));  // 24 for 23.976: the code counts frames, not time
  const int allMinutes = 60 * *hours + *minutes;
  int count = (60 * allMinutes + *seconds) * whole + *frames;
  // Two numbers of frames are left out each minute but every tenth, and four at 60 a second.
  if (*bits & kDropFrame) count -= (whole >= 50 ? 4 : 2) * (allMinutes - allMinutes / 10);
  return count;
}

// Two numbers with a colon between them.
std::optional<std::pair<double, double>> pairOf(const ExrAttribute& attribute) {
  if (attribute.type != "string") return std::nullopt;
  const char *at = attribute.bytes.data(), *end = at + attribute.bytes.size();
  std::pair<double, double> pair;
  const auto [colon, first] = std::from_chars(at, end, pair.first);
  if (first != std::errc() || colon == end || *colon != ':') return std::nullopt;
  const auto [next, second] = std::from_chars(colon + 1, end, pair.second);
  const bool numbers = second == std::errc() && next == end && std::isfinite(pair.first) && std::isfinite(pair.second);
  return numbers ? std::optional(pair) : std::nullopt;
}

std::string pairText(double first, double second) {
  char text[64];
  char* end = std::to_chars(text, text + sizeof text, first).ptr;
  *end++ = ':';
  return {text, std::to_chars(end, text + sizeof text, second).ptr};
}

std::optional<OpenShutter> shutterOf(const ExrAttribute& attribute) {
  const auto pair = pairOf(attribute);
  if (!pair || pair->first > pair->second || std::abs(pair->first) > kLongestShutter ||
      std::abs(pair->second) > kLongestShutter)
    return std::nullopt;
  return OpenShutter{pair->first, pair->second};
}

std::optional<StatedTime> statedTimeOf(const ExrAttribute& attribute) {
  const auto pair = pairOf(attribute);
  if (!pair || std::abs(pair->first) > kMostSeconds || pair->second <= 0.0 || pair->second >= kMostFramesPerSecond)
    return std::nullopt;
  return StatedTime{pair->first, pair->second};
}

}  // namespace

std::string shutterText(const OpenShutter& shutter) {
  return pairText(shutter.open, shutter.close);
}

std::string timeText(const StatedTime& time) {
  return pairText(time.seconds, time.framesPerSecond);
}

HeaderTime headerTimeOf(const ExrDocument& document) {
  HeaderTime time;
  // OpenImageIO's writers begin the name with a capital.
  for (const char* name : {"framesPerSecond", "FramesPerSecond"})
    if (const ExrAttribute* rate = find(document, name); rate && !time.framesPerSecond)
      time.framesPerSecond = rateOf(*rate);
  if (const ExrAttribute* stated = find(document, kTimeAttribute)) time.stated = statedTimeOf(*stated);
  if (const ExrAttribute* shutter = find(document, kShutterAttribute)) time.shutter = shutterOf(*shutter);
  if (const ExrAttribute* exposure = find(document, "expTime")) {
    const auto seconds = valueOf<float>(*exposure, "float");
    if (seconds && std::isfinite(*seconds) && *seconds > 0.0f) time.exposure = static_cast<double>(*seconds);
  }
  if (const ExrAttribute* frame = find(document, "Frame")) {
    time.frame = wholeNumber(*frame);
    if (time.frame) time.frameBy = "attribute Frame";
  }
  if (time.frame) return time;
  if (const ExrAttribute* code = find(document, "timeCode")) {
    time.frame = framesOf(*code, time.framesPerSecond.value_or(kUsualFramesPerSecond));
    if (time.frame) time.frameBy = "attribute timeCode";
  }
  return time;
}

}  // namespace pellucid
