// Bounds of flags' numbers that CLI11 does not state, or lets NaN pass: no comparison with it is true.
#pragma once
#include <CLI/CLI.hpp>

namespace pellucid::cli {

CLI::Validator aboveZero();     // finite and above 0
CLI::Validator notBelowZero();  // finite and not below 0
CLI::Validator isNumber();      // finite, beside a CLI::Range

}  // namespace pellucid::cli
