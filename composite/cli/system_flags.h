// Flags of passes for each system.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "composite/pipeline/request.h"

namespace pellucid::cli {

void addSystemFlags(CLI::App& verb, std::string& systems, std::vector<std::string>& weights);
// Throws UsageError for methods that have no passes for systems, and for weights without systems.
void systemsInto(Request& request, const std::string& systems, const std::vector<std::string>& weights);

}  // namespace pellucid::cli
