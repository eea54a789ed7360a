#include "composite/cli/systems.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "composite/cli/lists.h"
#include "engine_bridge/scene/triangle_source.h"

namespace pellucid::cli {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

// Which system each instance belongs to, and their names.
std::vector<std::size_t> groupInstances(const std::string& rule, const std::vector<std::string>& paths,
                                        const Scene& scene, std::vector<std::string>& names) {
  std::vector<std::size_t> file;  // of each instance: files are appended in order
  SceneOptions counting;
  counting.streamBytes = std::size_t{8} << 20;
  for (std::size_t i = 0; i < paths.size(); ++i)
    file.resize(
        paths.size() > 1 ? file.size() + loadScene({paths[i]}, counting).instances.size() : scene.instances.size(), i);
  if (rule == "file") {
    names = paths;
    return file;
  }
  std::vector<std::size_t> group;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const std::string name =
        paths.size() > 1 ? paths[file[i]] + ": " + scene.instances[i].node : scene.instances[i].node;
    const auto known = std::find(names.begin(), names.end(), name);
    group.push_back(static_cast<std::size_t>(known - names.begin()));
    if (known == names.end()) names.push_back(name);
  }
  return group;
}

void keepTexture(const TextureRef& ref, const Scene& from, Scene& to) {
  if (ref.texture < 0) return;
  const auto i = static_cast<std::size_t>(ref.texture);
  to.textures[i] = from.textures[i];
}

// The instances of one group, and what they need; other primitives and textures stay as empty places.
Scene partOf(const Scene& scene, const std::vector<std::size_t>& group, std::size_t wanted) {
  Scene part;
  part.materials = scene.materials;
  part.lights = scene.lights;
  part.textures.resize(scene.textures.size());
  for (Texture& texture : part.textures) texture.texels = Image<glm::vec4>(1, 1, glm::vec4(1.0f));
  part.primitives.resize(scene.primitives.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (group[i] != wanted) continue;
    part.instances.push_back(scene.instances[i]);
    const auto number = static_cast<std::size_t>(scene.instances[i].primitive);
    part.primitives[number] = scene.primitives[number];
    const Material& material = scene.materials[static_cast<std::size_t>(scene.primitives[number].material)];
    for (const TextureRef* ref : material.textures()) keepTexture(*ref, scene, part);
  }
  return part;
}

// Planar distance to the middle of the bounding box of what is transparent; nothing where nothing is.
std::optional<double> middleOf(const Scene& scene, const Camera& camera) {
  constexpr std::size_t kBatch = 1024;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  VertexPlaces places;
  TriangleBatch batch;
  for (const Instance& instance : scene.instances) {
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    if (!scene.materials[static_cast<std::size_t>(primitive.material)].transparent()) continue;
    const glm::dmat4 viewFromObject = camera.viewFromWorld * instance.worldFromObject;
    for (std::size_t first = 0; first < primitive.triangles(); first += kBatch) {
      readTriangles(primitive, first, std::min(kBatch, primitive.triangles() - first), places, batch);
      for (const Vertex& vertex : batch.vertices) {
        const double z = -(viewFromObject * glm::dvec4(glm::dvec3(vertex.position), 1.0)).z;
        low = std::min(low, z);
        high = std::max(high, z);
      }
    }
  }
  if (!(low <= high)) return std::nullopt;
  return 0.5 * (low + high);
}

// Without what stands behind the nearest solid of any system, and without the solids.
FragmentLists inFrontOfSolids(const FragmentLists& lists, const OitPlanes& whole) {
  FragmentLists kept;
  kept.window = lists.window;
  kept.solid = Image<glm::vec4>(lists.window.width(), lists.window.height(), glm::vec4(0.0f, 0.0f, 0.0f, kNothing));
  kept.offsets.assign(1, 0);
  const int left = lists.window.x0 - whole.data.x0, top = lists.window.y0 - whole.data.y0;
  std::size_t pixel = 0;
  for (int y = 0; y < lists.window.height(); ++y)
    for (int x = 0; x < lists.window.width(); ++x, ++pixel) {
      const float solid = whole.solid.at(left + x, top + y).a;
      for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i)
        if (lists.fragments[i].z <= solid) kept.fragments.push_back(lists.fragments[i]);
      kept.offsets.push_back(kept.fragments.size());
    }
  return kept;
}

void putOver(const Veil& nearer, Veil& veil) {
  for (std::size_t i = 0; i < veil.touched.size(); ++i) {
    if (!nearer.touched[i]) continue;
    veil.light[i] = nearer.light[i] + nearer.transmission[i] * veil.light[i];
    veil.transmission[i] *= nearer.transmission[i];
    veil.frontZ[i] = std::min(veil.frontZ[i], nearer.frontZ[i]);
    veil.touched[i] = 1;
  }
}

}  // namespace

std::vector<SystemPass> splitSystems(const std::string& rule, const std::vector<std::string>& paths, const Shot& shot,
                                     GlContext& context) {
  std::vector<std::string> names;
  const std::vector<std::size_t> group = groupInstances(rule, paths, shot.scene, names);
  std::vector<SystemPass> systems;
  for (std::size_t i = 0; i < names.size(); ++i) {
    SystemPass system{names[i], 0, partOf(shot.scene, group, i), nullptr};
    const std::optional<double> z = middleOf(system.scene, shot.camera);
    if (!z) continue;
    system.z = *z;
    systems.push_back(std::move(system));
  }
  std::stable_sort(systems.begin(), systems.end(), [](const SystemPass& a, const SystemPass& b) { return a.z > b.z; });
  for (SystemPass& system : systems)
    system.pass = std::make_unique<TransparentPass>(context, system.scene, shot.opaque.gbuffer, shot.camera);
  return systems;
}

Veil veilFromSystems(TransparentPass& whole, std::vector<SystemPass>& systems, const RenderSettings& settings,
                     const PassSettings& sample, const GBuffer& gbuffer, RenderCounts& counts) {
  const ChosenMethod method = settings.listMethod ? *settings.listMethod : *chooseMethod("weighted");
  const MethodChoice choice{0, sample.weight, sample.normalisation};
  const OitPlanes planes = whole.accumulate(sample);
  const int width = gbuffer.data.width(), height = gbuffer.data.height();
  Veil veil(width, height);
  counts.passes = whole.statistics().passes;
  std::vector<std::unique_ptr<DeepSource>> noDeep;
  for (SystemPass& system : systems) {
    Veil own(width, height);
    eachList(system.pass.get(), noDeep, gbuffer, sample, VolumeRule::midDepth, [&](const FragmentLists& lists) {
      compositeBy(method, choice, inFrontOfSolids(lists, planes), gbuffer.data, own);
    });
    putOver(own, veil);
    counts.passes += system.pass->statistics().passes;
  }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec4 solid = planes.solid.at(x, y);
      if (!std::isfinite(solid.a)) continue;
      veil.touched.at(x, y) = 1;
      veil.frontZ.at(x, y) = std::min(veil.frontZ.at(x, y), solid.a);
      if (scattersAt(planes, x, y)) continue;  // looked up below
      veil.light.at(x, y) += veil.transmission.at(x, y) * glm::vec3(solid);
      veil.transmission.at(x, y) = glm::vec3(0.0f);
    }
  if (planes.scatters()) {
    const Backdrop backdrop = backdropOf(gbuffer, planes.solid);
    showThrough(Lookups(backdrop, planes, settings.lookup), veil);
  }
  return veil;
}

}  // namespace pellucid::cli
