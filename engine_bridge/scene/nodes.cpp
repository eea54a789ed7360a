#include "engine_bridge/scene/nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "gbuffer/errors.h"

namespace pellucid::gltf {

namespace {

constexpr double kRoundedRow = 1e-5;     // what products of float matrices leave in a last row of 0 0 0 1
constexpr double kMostMagnitude = 1e15;  // metres and scales beyond it leave no room for float products

glm::dmat4 localMatrix(const JsonView& node, Notes& notes) {
  if (const std::optional<JsonView> matrix = node.find("matrix")) {
    const std::vector<double> m = matrix->numbers(16);
    const double off = std::max({std::abs(m[3]), std::abs(m[7]), std::abs(m[11]), std::abs(m[15] - 1.0)});
    if (!(off <= kRoundedRow)) matrix->refuse("has a last row other than 0 0 0 1; expected an affine transform");
    glm::dmat4 local(1.0);
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row) local[column][row] = m[static_cast<std::size_t>(column * 4 + row)] / m[15];
    return local;
  }
  glm::dmat4 local(1.0);
  if (const std::optional<JsonView> rotation = node.find("rotation")) {
    const std::vector<double> q = rotation->numbers(4);
    const glm::dquat quaternion(q[3], q[0], q[1], q[2]);  // glTF: x y z w
    const double length = glm::length(quaternion);
    const bool none = length == 0.0;  // what exporters make of a scale of zero; every viewer turns nothing by it
    if (none) notes.add(rotation->where() + " is 0 0 0 0 and turns nothing");
    if (!none && !(std::isfinite(length) && length >= 1e-30))
      rotation->refuse("has no length; expected a unit quaternion");
    if (!none) local = glm::mat4_cast(quaternion / length);
  }
  if (const std::optional<JsonView> scale = node.find("scale")) {
    const std::vector<double> s = scale->numbers(3);
    for (int column = 0; column < 3; ++column) local[column] *= s[static_cast<std::size_t>(column)];
  }
  if (const std::optional<JsonView> translation = node.find("translation")) {
    const std::vector<double> t = translation->numbers(3);
    local[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
  }
  return local;
}

//   everyRoot  set when no scene chooses among them
std::vector<std::size_t> rootNodes(const GltfFile& file, Notes& notes, bool& everyRoot) {
  const std::size_t count = file.count("nodes");
  const std::size_t scenes = file.count("scenes");
  std::vector<std::size_t> roots;
  std::optional<JsonView> scene;
  if (const std::optional<JsonView> chosen = file.root().find("scene")) {
    scene = file.item("scenes", *chosen);
  } else if (scenes == 1) {
    scene = file.item("scenes", 0);
  }
  everyRoot = !scene;
  if (scene) {
    const std::optional<JsonView> nodes = scene->find("nodes");
    for (std::size_t i = 0; nodes && i < nodes->size(); ++i) roots.push_back(nodes->at(i).index(count, "nodes"));
    return roots;
  }
  if (scenes > 1) notes.add(fmt::format("has {} scenes and no default; the nodes of all are drawn", scenes));
  std::vector<bool> isChild(count, false);
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<JsonView> children = file.item("nodes", i).find("children");
    for (std::size_t c = 0; children && c < children->size(); ++c)
      isChild[children->at(c).index(count, "nodes")] = true;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!isChild[i]) roots.push_back(i);
  }
  return roots;
}

}  // namespace

void checkMagnitude(const JsonView& node, const glm::dmat4& worldFromObject) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      const double value = worldFromObject[column][row];
      if (!(std::abs(value) <= kMostMagnitude)) {
        node.refuse(
            fmt::format("has a world transform with {:g}; expected magnitudes up to {:g}", value, kMostMagnitude));
      }
    }
  }
}

std::vector<PlacedNode> placeNodes(const GltfFile& file, double metresPerUnit, Notes& notes) {
  const std::size_t count = file.count("nodes");
  bool everyRoot = false;
  const std::vector<std::size_t> roots = rootNodes(file, notes, everyRoot);
  glm::dmat4 metresFromUnits(metresPerUnit);
  metresFromUnits[3][3] = 1.0;
  struct Pending {
    std::size_t index;
    glm::dmat4 worldFromParent;
    bool visible;
  };
  // A stack of our own: a chain of a million nodes is no recursion.
  std::vector<Pending> pending;
  for (std::size_t i = roots.size(); i-- > 0;) pending.push_back({roots[i], metresFromUnits, true});
  std::vector<bool> placed(count, false);
  std::vector<PlacedNode> nodes;
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    const JsonView node = file.item("nodes", next.index);
    if (placed[next.index]) node.refuse("is reached twice: it has two parents or is its own ancestor; expected a tree");
    placed[next.index] = true;
    PlacedNode result;
    result.index = next.index;
    result.name = node.string("name", "");
    if (result.name.empty()) result.name = fmt::format("node {}", next.index);
    result.worldFromObject = next.worldFromParent * localMatrix(node, notes);
    checkMagnitude(node, result.worldFromObject);
    const std::optional<JsonView> visibility = node.extension("KHR_node_visibility");
    result.visible = next.visible && (!visibility || visibility->boolean("visible", true));
    if (const std::optional<JsonView> children = node.find("children")) {
      for (std::size_t c = children->size(); c-- > 0;) {
        pending.push_back({children->at(c).index(count, "nodes"), result.worldFromObject, result.visible});
      }
      if (pending.size() > 2 * count) children->refuse("name more nodes than there are; expected a tree");
    }
    nodes.push_back(std::move(result));
  }
  // From all the roots every node of a forest is reached.
  if (everyRoot && nodes.size() < count) throw InputError(file.path() + ": nodes form a cycle; expected a tree");
  return nodes;
}

glm::dmat4 worldBesideScene(const GltfFile& file, std::size_t node, double metresPerUnit, Notes& notes) {
  const std::size_t count = file.count("nodes");
  std::vector<std::size_t> parent(count, count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<JsonView> children = file.item("nodes", i).find("children");
    for (std::size_t c = 0; children && c < children->size(); ++c) parent[children->at(c).index(count, "nodes")] = i;
  }
  glm::dmat4 world(1.0);
  std::size_t steps = 0;
  for (std::size_t at = node; at < count; at = parent[at]) {
    const JsonView view = file.item("nodes", at);
    if (++steps > count) view.refuse("is its own ancestor; expected a tree");
    world = localMatrix(view, notes) * world;
  }
  glm::dmat4 metresFromUnits(metresPerUnit);
  metresFromUnits[3][3] = 1.0;
  world = metresFromUnits * world;
  checkMagnitude(file.item("nodes", node), world);
  return world;
}

}  // namespace pellucid::gltf
