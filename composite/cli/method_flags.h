// Flags of the method, its precision and its weight.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "composite/pipeline/request.h"

namespace pellucid::cli {

// What a verb composites by where --method says nothing.
enum class UsualMethod {
  truth,  // over, unless a flag asks for sums: default_method.h
  sums,   // phenomenological
};

struct MethodFlags {
  std::string method, precision = "float", normalisation = "spectral", weight = "eq5", weightRange, weightFrom,
                      methodFrom;
  std::optional<double> weightReference;
  void addTo(CLI::App& verb, bool listsToo, UsualMethod usual);
  void addWeightTo(CLI::App& verb, bool takesAuto);  // --normalisation, --weight, --weight-range alone
  // What paints, the tier and the weight. --method stochastic is StochasticFlags'. Throws UsageError.
  void into(Request& request) const;

 private:
  UsualMethod usual_ = UsualMethod::sums;
  const CLI::App* verb_ = nullptr;
  const CLI::Option *methodOption_ = nullptr, *weightOption_ = nullptr, *normalisationOption_ = nullptr;
};

Tier tierOf(const std::string& precision);

}  // namespace pellucid::cli
