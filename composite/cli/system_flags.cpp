#include "composite/cli/system_flags.h"

#include <fmt/format.h>

#include <algorithm>

#include "composite/pipeline/system_weights.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {

void addSystemFlags(CLI::App& verb, std::string& systems, std::vector<std::string>& weights) {
  verb.add_option("--systems", systems, "A pass of its own for every input file or named node, sorted coarsely")
      ->check(CLI::IsMember({"off", "file", "node"}))
      ->capture_default_str();
  verb.add_option("--system-weight", weights,
                  "NAME=WEIGHT: weight of one system, a file or node by its name, as --weight has it; auto fits it to "
                  "that system alone. May be repeated; the others take --weight")
      ->allow_extra_args(false);
}

void systemsInto(Request& request, const std::string& systems, const std::vector<std::string>& weights) {
  if (systems == "off") {
    if (!weights.empty())
      throw UsageError(
          fmt::format("--system-weight: found {} without --systems, expected --systems file or node", weights[0]));
    return;
  }
  const bool sums = paintsBy<PaintSums>(request);
  const auto* listed = std::get_if<PaintListed>(&request.paint);
  if (!sums && !listed)
    throw UsageError(fmt::format("--systems: --method {} has no use for passes per system, expected a blended method",
                                 request.method));
  PaintSystems painted{systems == "file" ? SystemRule::file : SystemRule::node, std::nullopt, {}};
  if (listed) painted.method = listed->method;
  for (const std::string& each : weights) {
    painted.weights.push_back(readSystemWeight(each));
    const std::string& name = painted.weights.back().system;
    if (std::count_if(painted.weights.begin(), painted.weights.end(),
                      [&](const SystemWeight& other) { return other.system == name; }) > 1)
      throw UsageError(fmt::format("--system-weight: found '{}' twice, expected one weight for each system", name));
  }
  request.paint = painted;
}

}  // namespace pellucid::cli
