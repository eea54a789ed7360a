#include "composite/cli/number_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace pellucid::cli {
namespace {

CLI::Validator checkOf(bool (*good)(double), const char* expected) {
  return CLI::Validator(
      [good, expected](std::string& text) {
        double value = 0.0;
        const bool number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
        return number && good(value) ? std::string() : fmt::format("found {}, expected {}", text, expected);
      },
      "");
}

}  // namespace

CLI::Validator aboveZero() {
  return checkOf([](double value) { return value > 0.0; }, "a number above 0");
}

CLI::Validator notBelowZero() {
  return checkOf([](double value) { return value >= 0.0; }, "a number of 0 or more");
}

CLI::Validator isNumber() {
  return checkOf([](double) { return true; }, "a number");
}

}  // namespace pellucid::cli
