// K nodes a pixel, in depth order; one too many merges the last two. Exact up to K layers; beyond, what is merged
// depends on the order submitted. Salvi and Vaidyanathan 2014
#include <algorithm>

#include "composite/methods/method.h"

namespace pellucid {
namespace {

struct Node {
  glm::dvec3 light, passed;
  double z;
};

}  // namespace

LayerMix mixMlab(const std::vector<MethodLayer>& layers, const MethodChoice& choice) {
  std::vector<Node> nodes;
  const auto most = static_cast<std::size_t>(choice.order);
  nodes.reserve(most + 1);
  for (const MethodLayer& layer : layers) {
    const Node node{layer.light, glm::dvec3(1.0) - layer.opacity, layer.z};
    nodes.insert(
        std::upper_bound(nodes.begin(), nodes.end(), node, [](const Node& a, const Node& b) { return a.z < b.z; }),
        node);
    if (nodes.size() > most) {
      Node& last = nodes[most - 1];
      last.light += last.passed * nodes[most].light;
      last.passed *= nodes[most].passed;
      nodes.pop_back();
    }
  }
  LayerMix mix;
  for (const Node& node : nodes) {
    mix.light += mix.transmission * node.light;
    mix.transmission *= node.passed;
  }
  return mix;
}

}  // namespace pellucid
