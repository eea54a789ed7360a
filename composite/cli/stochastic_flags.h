// Flags of --method stochastic.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "composite/pipeline/request.h"

namespace pellucid::cli {

// "stochastic", "stochastic:basic", ...; nothing for other methods.
std::optional<StochasticSettings::Variant> stochasticVariant(const std::string& method);
inline constexpr const char* kStochasticNames = "stochastic[:basic|alpha|depth]";

struct StochasticFlags {
  int samples = 0, seed = 0;
  double adaptive = 0.0;
  std::string noise = "screen", masks = "stratified", correction = "on", sampledOn = "cpu";
  void addTo(CLI::App& verb);
  // Paints by samples under --method stochastic. Throws UsageError for flags that another method, or a variant, cannot
  // honour; after MethodFlags, ShadowFlags and --aa. The masks are stratified across all passes.
  void into(Request& request) const;
  // Throws UsageError for flags that none of the methods reads.
  //   verbFlag  that names methods: "--method"
  void expectRead(const std::vector<std::string>& methods, const char* verbFlag, const ShadowRequest& shadows) const;
  StochasticSettings settings(StochasticSettings::Variant variant, int passes) const;

 private:
  CLI::Option *samplesOption_ = nullptr, *seedOption_ = nullptr, *masksOption_ = nullptr, *correctionOption_ = nullptr,
              *sampledOption_ = nullptr, *adaptiveOption_ = nullptr, *noiseOption_ = nullptr;
};

}  // namespace pellucid::cli
