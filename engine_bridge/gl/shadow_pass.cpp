#include "engine_bridge/gl/shadow_pass.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "engine_bridge/gl/shadow_draw.h"
#include "engine_bridge/scene/blocks.h"
#include "shaders/shadow_layout.h"

namespace pellucid {
namespace {

using Form = ShadowMapSettings::Form;
using Clock = std::chrono::steady_clock;

constexpr int kBandRows = 512;       // drawn at once, so that a map of any size takes as much device memory
constexpr double kMargin = 16.0;     // texels as drawn: the tent's reach, and the texels that a lookup blends
constexpr double kOpaqueBias = 2.0;  // texels of opaque maps
double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class MapMaker {
 public:
  MapMaker(const Scene& scene, const Camera& camera, const GBuffer* gbuffer, const ShadowMapSettings& settings)
      : scene_(scene),
        camera_(camera),
        gbuffer_(gbuffer),
        settings_(settings),
        drawer_(scene, camera, gbuffer, settings) {
    filtered_ = settings.form == Form::variance || settings.form == Form::published;
  }

  void light(const Light& light, std::uint32_t index);

  ShadowMaps maps;
  ShadowMapStatistics statistics;

 private:
  shading::ShadowFace face(const LightView& view, int edge, const shading::ShadowGrid& grid, int channels);
  void transparentFace(const LightView& view, const LightViews& metric, std::uint32_t seed);
  void opaqueFace(const LightView& view, const LightViews& metric);
  LightViews opaqueViewsOf(const Light& light, const glm::dmat4& own, const Bounds& casters, double faces) const;
  void transparentBias(const LightViews& views, const LightViews& metric, shading::ShadowLight& block) const;
  void opaqueBias(const LightViews& views, shading::ShadowLight& block) const;
  glm::vec4* grow(std::size_t texels) {
    maps.texels.resize(maps.texels.size() + texels);
    return maps.texels.data() + maps.texels.size() - texels;
  }

  const Scene& scene_;
  Camera camera_;
  const GBuffer* gbuffer_;
  ShadowMapSettings settings_;
  gl::ShadowDrawer drawer_;
  bool filtered_;
};

shading::ShadowFace MapMaker::face(const LightView& view, int edge, const shading::ShadowGrid& grid, int channels) {
  const Window all{0, 0, edge, edge};
  const glm::dmat4 clip = clipFromView(view.camera, all, all, {0.5, 0.5});
  shading::ShadowFace face = shading::shadowFaceOf(
      clip * view.camera.viewFromWorld * glm::inverse(camera_.viewFromWorld), edge, grid, -1.0, view.inner);
  face.extent.x = static_cast<int>(maps.texels.size());
  face.extent.z = channels;
  return face;
}

void MapMaker::transparentFace(const LightView& view, const LightViews& metric, std::uint32_t seed) {
  const int edge = metric.faces.size() > 1 ? settings_.size / 2 : settings_.size;
  const int channels = drawer_.grey() ? 1 : 3;
  maps.faces.push_back(face(view, edge, shading::shadowGrid(filtered_), channels));
  drawer_.begin({view, metric.radial, metric.scale, metric.offset, edge, seed});
  std::vector<float> weights;
  for (int first = 0; first < edge; first += kBandRows) {
    const int rows = std::min(kBandRows, edge - first);
    auto start = Clock::now();
    const gl::DrawnBand band =
        filtered_ ? drawer_.casters(first - gl::kTentReach, rows + 2 * gl::kTentReach) : drawer_.casters(first, rows);
    statistics.drawSeconds += secondsSince(start);
    start = Clock::now();
    if (filtered_) {
      const int kept = edge / gl::kShadowDivide, keptRows = rows / gl::kShadowDivide;
      const std::size_t known = weights.size();
      weights.resize(known + static_cast<std::size_t>(kept) * static_cast<std::size_t>(keptRows));
      gl::filterShadow(band, channels, edge, keptRows,
                       grow(static_cast<std::size_t>(kept) * static_cast<std::size_t>(keptRows * channels)),
                       &weights[known]);
    } else {
      gl::shadowTexels(band, channels,
                       grow(static_cast<std::size_t>(edge) * static_cast<std::size_t>(rows * channels)));
    }
    statistics.filterSeconds += secondsSince(start);
  }
  if (filtered_)
    gl::fillStopped(weights, channels, edge, &maps.texels[static_cast<std::size_t>(maps.faces.back().extent.x)]);
  statistics.triangles = drawer_.triangles();
}

void MapMaker::opaqueFace(const LightView& view, const LightViews& metric) {
  const int edge = metric.faces.size() > 1 ? settings_.opaqueSize / 2 : settings_.opaqueSize;
  maps.faces.push_back(face(view, edge, {}, 1));
  drawer_.begin({view, metric.radial, metric.scale, metric.offset, edge, 0u});
  for (int first = 0; first < edge; first += kBandRows) {
    const auto start = Clock::now();
    const Image<float> depth = drawer_.opaque(first, std::min(kBandRows, edge - first));
    statistics.drawSeconds += secondsSince(start);
    glm::vec4* to = grow(depth.size() / 4);
    for (std::size_t i = 0; i < depth.size() / 4; ++i)
      to[i] = {depth[4 * i], depth[4 * i + 1], depth[4 * i + 2], depth[4 * i + 3]};
  }
}

// The views of the opaque maps of a light, which reach as far as what is transparent or shown; none without opaque
// maps.
//   own    the light's space from the world
//   faces  how many times smaller the edge of a face is than that of a map
LightViews MapMaker::opaqueViewsOf(const Light& light, const glm::dmat4& own, const Bounds& casters,
                                   double faces) const {
  if (settings_.opaqueSize <= 0 || !drawer_.hasOpaque()) return {};
  double opaqueFarthest = 0.0, pictureFarthest = 0.0;
  Bounds opaque = casterBounds(scene_, Casters::opaque, own, opaqueFarthest), needed = opaque;
  if (gbuffer_) {
    const Bounds picture = pictureBounds(*gbuffer_, camera_, own, pictureFarthest);
    if (opaque.empty()) {
      opaque = picture;
      opaqueFarthest = pictureFarthest;
    }
    needed = picture;
    if (!casters.empty()) {
      needed.add(casters.low);
      needed.add(casters.high);
    }
  }
  return lightViews(light, opaque, opaqueFarthest, needed, faces * kMargin / settings_.opaqueSize);
}

void MapMaker::transparentBias(const LightViews& views, const LightViews& metric, shading::ShadowLight& block) const {
  const LightView& view = views.faces[0];
  const double edge = views.faces.size() > 1 ? settings_.size / 2 : settings_.size;
  const glm::vec2 bias =
      shading::shadowBias(metric.radial, std::min(view.camera.focal.x, view.camera.focal.y), edge, metric.scale);
  block.bias.z = bias.x;
  block.bias.w = bias.y;
}

// `views` with the unit of depth of the transparent maps.
void MapMaker::opaqueBias(const LightViews& views, shading::ShadowLight& block) const {
  const LightView& view = views.faces[0];
  const double edge = views.faces.size() > 1 ? settings_.opaqueSize / 2 : settings_.opaqueSize;
  const double texel = 2.0 / (std::min(view.camera.focal.x, view.camera.focal.y) * edge);
  // A texel of a cone or cube widens with the distance.
  if (views.radial)
    block.bias.y = static_cast<float>(kOpaqueBias * texel);
  else
    block.bias.x = static_cast<float>(kOpaqueBias * texel * views.scale);
}

void MapMaker::light(const Light& light, std::uint32_t index) {
  shading::ShadowLight block{};
  block.lookup = {settings_.form == Form::variance    ? shading::PLD_SHADOW_SLAB
                  : settings_.form == Form::published ? shading::PLD_SHADOW_CHEBYSHEV
                                                      : shading::PLD_SHADOW_CLOSER,
                  settings_.form == Form::variance || settings_.form == Form::corrected ? 1 : 0, settings_.closerEdge,
                  light.kind == LightKind::directional ? 0 : 1};
  if (!shines(light)) {
    maps.lights.push_back(block);
    return;
  }
  const glm::dmat4 own = lightFromWorld(light);
  double farthest = 0.0;
  const Bounds casters = casterBounds(scene_, Casters::transparent, own, farthest);
  const double faces = light.kind == LightKind::directional ? 1.0 : 2.0;  // faces of cubes have half the edge
  const LightViews views = lightViews(light, casters, farthest, casters, faces * kMargin / settings_.size);
  LightViews opaqueViews = opaqueViewsOf(light, own, casters, faces);
  // One unit of depth for both kinds.
  const LightViews& metric = views.faces.empty() ? opaqueViews : views;
  const glm::dmat4 ownFromView = own * glm::inverse(camera_.viewFromWorld);
  if (metric.radial)
    block.metric =
        glm::vec4(glm::dvec4(glm::dvec3(camera_.viewFromWorld * glm::dvec4(light.position, 1.0)), metric.scale));
  else
    for (int c = 0; c < 4; ++c)
      block.metric[c] = static_cast<float>(-metric.scale * ownFromView[c][2] + (c == 3 ? metric.offset : 0.0));
  block.faces[0] = static_cast<int>(maps.faces.size());
  for (const LightView& view : views.faces)
    transparentFace(view, views,
                    shading::mapSeedOf(settings_.seed, index, static_cast<std::uint32_t>(maps.faces.size())));
  block.faces[1] = static_cast<int>(maps.faces.size()) - block.faces[0];
  if (block.faces[1] > 0 && settings_.form != Form::published) transparentBias(views, metric, block);
  block.faces[2] = static_cast<int>(maps.faces.size());
  opaqueViews.scale = metric.scale;
  opaqueViews.offset = metric.offset;
  for (const LightView& view : opaqueViews.faces) opaqueFace(view, opaqueViews);
  block.faces[3] = static_cast<int>(maps.faces.size()) - block.faces[2];
  if (block.faces[3] > 0) opaqueBias(opaqueViews, block);
  maps.lights.push_back(block);
}

}  // namespace

ShadowMaps renderShadowMaps(GlContext&, const Scene& scene, const Camera& camera, const GBuffer* gbuffer,
                            const ShadowMapSettings& settings, ShadowMapStatistics* statistics) {
  const auto whole = [](int size, int least) { return size >= least && size <= 16384 && size % least == 0; };
  if (!whole(settings.size, 64) || (settings.opaqueSize != 0 && !whole(settings.opaqueSize, 64)))
    throw std::logic_error("shadow maps have an edge that is a multiple of 64, up to 16384");
  MapMaker maker(scene, camera, gbuffer, settings);
  std::uint32_t index = 0;
  for (const Light& light : scene.lights) maker.light(light, index++);
  if (statistics) {
    *statistics = maker.statistics;
    statistics->faces = maker.maps.faces.size();
    statistics->bytes = maker.maps.texels.size() * sizeof(glm::vec4);
  }
  return std::move(maker.maps);
}

}  // namespace pellucid
