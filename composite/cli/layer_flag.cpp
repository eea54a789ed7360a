#include "composite/cli/layer_flag.h"

namespace pellucid::cli {
namespace {

struct NamedLayer {
  const char* text;
  LayerName name;
};
constexpr NamedLayer kLayers[] = {
    {"transparent", LayerName::transparent},
    {"transmission", LayerName::transmission},
    {"depth", LayerName::depth},
    {"edges", LayerName::edges},
    {"unseen", LayerName::unseen},
    {"D", LayerName::diffusion},
    {"delta", LayerName::delta},
    {"weight", LayerName::weight},
    {"count", LayerName::count},
};

}  // namespace

std::vector<LayerName> layerNames(const std::vector<std::string>& layers) {
  std::vector<LayerName> names;
  for (const std::string& text : layers)
    for (const NamedLayer& layer : kLayers)
      if (text == layer.text) names.push_back(layer.name);
  return names;
}

void addLayersOption(CLI::App& verb, std::vector<std::string>& layers) {
  std::vector<std::string> names;
  for (const NamedLayer& layer : kLayers) names.emplace_back(layer.text);
  verb.add_option(
          "--layers", layers,
          "Layers to add: transparent, transmission, depth; for debugging edges, unseen, D, delta, weight, count")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
}

}  // namespace pellucid::cli
