#include "composite/cli/scene_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "engine_bridge/scene/corners.h"

namespace pellucid::cli {
namespace {

constexpr std::size_t kMostNodes = 500;  // that a page lists and draws

// A node's corners, in the world and before the eye.
struct NodeReach {
  glm::dvec3 least{std::numeric_limits<double>::infinity()}, most = -least;
  glm::dvec2 first{std::numeric_limits<double>::infinity()}, last = -first;  // pixels, of corners before the eye
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  std::string material;
  std::size_t triangles = 0;
  bool transparent = false;

  void add(const glm::dvec3& world, const Projected& seen) {
    least = glm::min(least, world);
    most = glm::max(most, world);
    nearest = std::min(nearest, seen.z);
    farthest = std::max(farthest, seen.z);
    if (!(seen.z > 0.0)) return;
    first = glm::min(first, seen.pixel);
    last = glm::max(last, seen.pixel);
  }
};

std::map<std::string, NodeReach> reachOfNodes(const Scene& scene, const Camera& camera, const Window& display) {
  std::map<std::string, NodeReach> nodes;
  for (const Instance& instance : scene.instances) {
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
    NodeReach& node = nodes[instance.node];
    node.transparent = node.transparent || material.transparent();
    if (node.material.empty() || material.transparent()) node.material = material.name;
    node.triangles += primitive.triangles();
  }
  forEachCorner(
      scene, glm::dmat4(1.0), [](const Material&) { return true; },
      [&](const Instance& instance, const glm::dvec3& world) {
        nodes[instance.node].add(world, project(camera, display, world));
      });
  std::erase_if(nodes, [](const auto& entry) { return entry.second.triangles == 0; });
  return nodes;
}

std::vector<std::string> rowOf(const std::string& name, const NodeReach& node) {
  const bool before = node.last.x >= node.first.x;
  return {
      name,
      node.material,
      node.transparent ? "composited" : "left out: opaque",
      fmt::format("{}", node.triangles),
      fmt::format("{:.4g} to {:.4g} m", node.nearest, node.farthest),
      before ? fmt::format("({:.0f}, {:.0f}) to ({:.0f}, {:.0f})", node.first.x, node.first.y, node.last.x, node.last.y)
             : "behind the eye"};
}

// How many layers lie on each pixel, with a line that says so.
PagePicture countPicture(const Result& result, SceneLook& look) {
  PagePicture picture{"layers on each pixel, divided by the most", {}};
  for (const ExtraLayer& layer : result.layers)
    for (const auto& [channel, plane] : layer.channels) {
      if (channel != "count") continue;
      const float most = *std::max_element(plane.data(), plane.data() + plane.size());
      std::size_t covered = 0;
      picture.rgb = Image<glm::vec3>(plane.width(), plane.height());
      for (std::size_t i = 0; i < plane.size(); ++i) {
        covered += plane[i] > 0.0f;
        picture.rgb[i] = glm::vec3(most > 0.0f ? plane[i] / most : 0.0f);
      }
      look.lines.push_back(fmt::format("Scene: {} of {} pixels show transparent layers, at most {:.0f} on one.",
                                       covered, plane.size(), most));
    }
  return picture;
}

}  // namespace

ScenePreview previewOf(const std::string& opaque, const std::vector<std::string>& scenes, const ReadOptions& read,
                       const CameraChoice& camera) {
  ScenePreview preview;
  preview.notes = std::make_shared<std::vector<std::string>>();
  preview.request.shot.opaque = opaque;
  preview.request.shot.inputs = scenes;
  preview.request.shot.read = read;
  preview.request.shot.camera = camera;
  preview.request.layers = {LayerName::count};
  preview.compositor = std::make_unique<Compositor>(
      preview.request, [notes = preview.notes](const std::string& note) { notes->push_back(note); });
  return preview;
}

SceneLook lookAt(ScenePreview& preview) {
  const Result result = preview.compositor->run(preview.request);
  const Shot& shot = preview.compositor->shot();
  SceneLook look;
  PageTable table{"Scene", {"node", "material", "", "triangles", "distance", "pixels"}, {}};
  const std::map<std::string, NodeReach> nodes = reachOfNodes(shot.scene, shot.camera, shot.opaque.gbuffer.display);
  if (nodes.size() > kMostNodes)
    look.lines.push_back(fmt::format("Scene: the first {} of {} nodes are shown.", kMostNodes, nodes.size()));
  for (const auto& [name, node] : nodes) {
    if (look.parts.size() == kMostNodes) break;
    look.parts.push_back({name, node.least, node.most, node.transparent});
    table.rows.push_back(rowOf(name, node));
  }
  if (!table.rows.empty()) look.tables.push_back(std::move(table));
  PagePicture composited{"composited at pixel centres",
                         Image<glm::vec3>(result.picture.rgba.width(), result.picture.rgba.height()), 0};
  for (std::size_t i = 0; i < composited.rgb.size(); ++i) composited.rgb[i] = glm::vec3(result.picture.rgba[i]);
  look.pictures.push_back(std::move(composited));
  if (PagePicture counts = countPicture(result, look); !counts.rgb.empty()) look.pictures.push_back(std::move(counts));
  for (const std::string& note : *preview.notes) look.lines.push_back("composite says: " + note);
  return look;
}

}  // namespace pellucid::cli
