#include "composite/cli/parse.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>

#include "gbuffer/errors.h"

namespace pellucid::cli {

std::vector<double> parseNumbers(const std::string& text, char separator, std::size_t count, const std::string& flag,
                                 const std::string& form) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* end = text.data() + text.size();
  while (at <= end) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) break;
    numbers.push_back(value);
    if (next == end && numbers.size() == count) return numbers;
    if (next == end || *next != separator) break;
    at = next + 1;
  }
  throw UsageError(fmt::format("{}: found '{}', expected {}", flag, text, form));
}

std::size_t parseBytes(const std::string& text, const std::string& flag) {
  std::size_t value = 0;
  const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(next, text.data() + text.size());
  const int shift = unit.empty() ? 0 : unit == "K" ? 10 : unit == "M" ? 20 : unit == "G" ? 30 : -1;
  if (error != std::errc() || shift < 0 || value == 0 || value > (SIZE_MAX >> shift))
    throw UsageError(fmt::format("{}: found '{}', expected bytes such as 64M or 2G", flag, text));
  return value << shift;
}

bool isColour(const std::string& text) {
  return text.find(',') != std::string::npos && text.find_first_not_of("0123456789+-.eE,") == std::string::npos;
}

glm::vec3 parseColour(const std::string& text, const std::string& flag) {
  const auto numbers = parseNumbers(text, ',', 3, flag, "three numbers R,G,B");
  for (const double number : numbers)
    if (number < 0) throw UsageError(fmt::format("{}: found '{}', expected no negative light", flag, text));
  return glm::vec3(static_cast<float>(numbers[0]), static_cast<float>(numbers[1]), static_cast<float>(numbers[2]));
}

std::pair<double, double> parseRange(const std::string& text, const std::string& flag) {
  const auto numbers = parseNumbers(text, ':', 2, flag, "NEAR:FAR in metres");
  if (numbers[0] <= 0 || numbers[1] <= numbers[0])
    throw UsageError(fmt::format("{}: found '{}', expected 0 < NEAR < FAR", flag, text));
  return {numbers[0], numbers[1]};
}

}  // namespace pellucid::cli
