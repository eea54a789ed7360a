// --preset-model: the settings of a paper's own pictures, as the flags that ask for them.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace pellucid::cli {

struct ModelFlag {
  std::string model;
  void addTo(CLI::App& verb);
  // Gives the verb the flags of the model that were not given, and says which. What was given wins.
  void apply(CLI::App& verb) const;
};

}  // namespace pellucid::cli
