// --layers: what the output holds besides the picture.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "composite/pipeline/request.h"

namespace pellucid::cli {

std::vector<LayerName> layerNames(const std::vector<std::string>& layers);
void addLayersOption(CLI::App& verb, std::vector<std::string>& layers);

}  // namespace pellucid::cli
