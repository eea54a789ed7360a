// Flags of --method stochastic.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "composite/methods/stochastic.h"

namespace pellucid::cli {

// "stochastic", "stochastic:basic", ...; nothing for other methods.
std::optional<StochasticSettings::Variant> stochasticVariant(const std::string& method);
inline constexpr const char* kStochasticNames = "stochastic[:basic|alpha|depth]";

struct StochasticFlags {
  int samples = 0, seed = 0;
  double adaptive = 0.0;
  std::string masks = "stratified", correction = "on", sampledOn = "cpu";
  void addTo(CLI::App& verb);
  bool onDevice() const { return sampledOn == "gl"; }
  // Nothing for other methods. Throws UsageError for flags that the method cannot honour.
  //   passes   --aa; the masks are stratified across all of them
  //   shadows  drawn at random too: --seed is theirs
  std::optional<StochasticSettings> settings(const std::string& method, int passes, bool shadows = false) const;

 private:
  CLI::Option *samplesOption_ = nullptr, *seedOption_ = nullptr, *masksOption_ = nullptr, *correctionOption_ = nullptr,
              *sampledOption_ = nullptr, *adaptiveOption_ = nullptr;
};

}  // namespace pellucid::cli
