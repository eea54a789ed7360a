#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "engine_bridge/gl/fog_pass.h"
#include "engine_bridge/gl/fragment_lists.h"
#include "engine_bridge/gl/lean_drawing.h"
#include "engine_bridge/gl/published_targets.h"
#include "engine_bridge/gl/renderer.h"
#include "engine_bridge/gl/solid_hash.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid {

struct TransparentPass::Impl {
  const GBuffer* gbuffer;
  Camera camera;
  gl::Renderer renderer;
  PassStatistics statistics;
  std::unique_ptr<gl::PublishedTargets> published;
  gl::FogPass fog;

  gl::PublishedTargets& publishedTargets(int width, int height) {
    if (!published || published->width() != width || published->height() != height)
      published = std::make_unique<gl::PublishedTargets>(width, height);
    return *published;
  }

  template <class Lists>
  void list(const PassSettings& settings, const std::function<void(const Lists&)>& tile);

  void finish(std::chrono::steady_clock::time_point start, std::size_t tiles, std::size_t fragments) {
    statistics.triangles = renderer.geometry().triangles();
    statistics.chunks = renderer.geometry().chunks();
    statistics.tiles = tiles;
    statistics.fragments = fragments;
    const gl::ShadowRayTable::Counts rays = renderer.takeShadowRayCounts();
    statistics.shadowRays = rays.rays;
    statistics.shadowSeconds = rays.seconds;
    statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
};

namespace {

// Bits that a pixel has on the device, and what is not among them.
void describe(const gl::Renderer& renderer, const PassSettings& settings, const LayerModel& layers,
              PassStatistics& statistics) {
  statistics.bitsPerPixel = usedBits(layers);
  statistics.solidBits = renderer.hasSolids() ? bitsOf(planesOf(layers, PlaneStage::solids)) + 32 : 0;  // and depth
  statistics.passes = renderer.hasSolids() ? 3 : 1;
  statistics.pruned = gl::leftOut(renderer.features(), settings, renderer.wouldOcclude(settings));
}

}  // namespace

TransparentPass::TransparentPass(GlContext&, const Scene& scene, const GBuffer& gbuffer, const Camera& camera)
    : impl_(new Impl{&gbuffer, camera, gl::Renderer(scene, gbuffer, camera), {}, {}, {}}) {}

TransparentPass::~TransparentPass() = default;

void TransparentPass::over(const GBuffer& gbuffer, const Camera& camera) {
  impl_->renderer.over(gbuffer, camera);
  impl_->gbuffer = &gbuffer;
  impl_->camera = camera;
}

void TransparentPass::pose(const Camera& camera) {
  impl_->renderer.pose(camera);
  impl_->camera = camera;
}

bool TransparentPass::scatters(const PassSettings& settings) const {
  return impl_->renderer.wouldScatter(settings);
}

bool TransparentPass::wantsOccluders(const PassSettings& settings) const {
  return impl_->renderer.wouldOcclude(settings);
}

Image<float> TransparentPass::solidDepth(const PassSettings& settings) {
  PassSettings centre = settings;
  centre.sample = {0.5, 0.5};
  const Window& data = impl_->gbuffer->data;
  Image<float> z(data.width(), data.height(), std::numeric_limits<float>::infinity());
  for (const Window& part : impl_->renderer.superTiles(centre))
    impl_->renderer.solidDepth(part, centre, settings.budgetBytes, z);
  return z;
}

const PassStatistics& TransparentPass::statistics() const {
  return impl_->statistics;
}

OitPlanes TransparentPass::accumulate(const PassSettings& settings) {
  const auto start = std::chrono::steady_clock::now();
  gl::Renderer& renderer = impl_->renderer;
  const Window &display = impl_->gbuffer->display, &data = impl_->gbuffer->data;
  const bool published = settings.tier == SumsTier::published;
  const Window& area = areaOf(settings, data);
  if (area != data && (published || settings.fog)) throw std::logic_error("an area of sums that are of all pixels");
  OitPlanes planes = published ? emptyPublishedPlanes(display, data) : emptyPlanes(display, area);
  planes.camera = impl_->camera;
  planes.info.weight = settings.weight;
  if (!published) planes.info.normalisation = settings.normalisation;
  impl_->statistics.clamps = {};
  std::size_t tiles = 0;
  for (const Window& part : renderer.superTiles(settings)) {
    renderer.begin(part, settings, settings.chunkBytes ? settings.chunkBytes : settings.budgetBytes);
    const std::vector<Window> scissors = renderer.tiles();
    const Window drawn = renderer.drawnPart();
    const int x = part.x0 + drawn.x0 - (area.x0 - data.x0), y = part.y0 + drawn.y0 - (area.y0 - data.y0);
    tiles += scissors.size();
    const LayerModel layers = renderer.layers();
    addPlanes(planes, layers);
    describe(renderer, settings, layers, impl_->statistics);
    if (published) {
      gl::PublishedTargets& targets = impl_->publishedTargets(part.width(), part.height());
      targets.begin(planesOf(layers));
      renderer.draw(gl::Output::published, scissors);
      targets.read(planes, part.x0, part.y0, impl_->statistics.clamps);
    } else {
      gl::PlaneTargets& targets = renderer.targets().planes();
      targets.setPart(drawn);
      targets.begin(planesOf(layers));
      renderer.draw(gl::Output::sums, scissors);
      if (settings.fog) impl_->fog.draw(*settings.fog, renderer.fogFrame(part));
      targets.read(planes, x, y);
    }
    if (renderer.hasSolids()) renderer.targets().readSolid(planes.solid, x, y);
  }
  if (renderer.hasSolids()) planes.info.solidHash = gl::solidHash(planes.solid);
  std::size_t fragments = 0;
  if (!published)
    for (std::size_t i = 0; i < planes.weight.size(); ++i) fragments += static_cast<std::size_t>(planes.weight[i].a);
  impl_->finish(start, tiles, fragments);
  return planes;
}

RimPlanes TransparentPass::rims(const PassSettings& settings) {
  gl::Renderer& renderer = impl_->renderer;
  const Window& data = impl_->gbuffer->data;
  RimPlanes planes;
  for (const Window& part : renderer.superTiles(settings)) {
    renderer.begin(part, settings, settings.chunkBytes ? settings.chunkBytes : settings.budgetBytes);
    if (!renderer.occludes()) return planes;
    if (planes.empty()) planes = RimPlanes(data.width(), data.height());
    gl::PlaneTargets targets(part.width(), part.height());
    targets.begin(planesOf(renderer.layers(), PlaneStage::rims));
    renderer.draw(gl::Output::rims, renderer.tiles());
    targets.read(planes, part.x0, part.y0);
  }
  return planes;
}

namespace {

std::size_t sizeOf(const FragmentLists& lists) {
  return lists.fragments.size();
}

std::size_t sizeOf(const LeanLists& lists) {
  std::size_t sum = 0;
  for (const LeanLists::Range& range : lists.ranges) sum += range.count;
  return sum;
}

}  // namespace

template <class Lists>
void TransparentPass::Impl::list(const PassSettings& settings, const std::function<void(const Lists&)>& tile) {
  const auto start = std::chrono::steady_clock::now();
  std::size_t bands = 0, fragments = 0;
  statistics.clamps = {};
  for (const Window& part : renderer.superTiles(settings)) {
    // Half for the geometry, half for the fragments: a quarter on the device, a quarter here.
    renderer.begin(part, settings, settings.chunkBytes ? settings.chunkBytes : settings.budgetBytes / 2);
    const auto deliver = [&](Lists& lists, const Window& band) {
      const int x = gbuffer->data.x0 + part.x0, y = gbuffer->data.y0 + part.y0;
      lists.window = {x + band.x0, y + band.y0, x + band.x1, y + band.y1};
      ++bands;
      fragments += sizeOf(lists);
      tile(lists);
    };
    if constexpr (std::is_same_v<Lists, LeanLists>)
      gl::listLean(renderer, settings.budgetBytes / 4, deliver);
    else
      gl::listFragments(renderer, settings.budgetBytes / 4, deliver);
  }
  finish(start, bands, fragments);
}

void TransparentPass::fragments(const PassSettings& settings, const std::function<void(const FragmentLists&)>& tile) {
  impl_->list(settings, tile);
}

void TransparentPass::leanFragments(const PassSettings& settings, const std::function<void(const LeanLists&)>& tile) {
  impl_->list(settings, tile);
}

}  // namespace pellucid
