// What the programs that damage files have in common: their words, and how they end.
#pragma once
#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

namespace pellucid::test {

inline std::uint64_t numberOf(const std::string& text, const char* name) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value == 0)
    throw std::runtime_error(fmt::format("{}: found '{}', expected a whole number above 0", name, text));
  return value;
}

// What `run` returns, or 2 after the sentence of what it throws.
inline int endOf(const char* program, int (*run)(int, char**), int count, char** arguments) {
  try {
    return run(count, arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", program, error.what());
    return 2;
  }
}

}  // namespace pellucid::test
