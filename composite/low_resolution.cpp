#include "composite/low_resolution.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "composite/denormals.h"
#include "composite/fold.h"
#include "composite/fold_published.h"
#include "composite/low_runs.h"

namespace pellucid {
namespace {

template <class Row>
void eachRow(int height, const Row& row) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y) row(y);
  });
}

// The same lens, with NDC over the low view's window.
Camera cameraOver(const Camera& camera, const Window& display, const Window& covered) {
  Camera low = camera;
  const double ax = static_cast<double>(display.width()) / covered.width(),
               ay = static_cast<double>(display.height()) / covered.height();
  const double bx = (2.0 * (display.x0 - covered.x0) + display.width()) / covered.width() - 1.0,
               by = 1.0 - (2.0 * (display.y0 - covered.y0) + display.height()) / covered.height();
  low.focal = {camera.focal.x * ax, camera.focal.y * ay};
  low.centre = {camera.centre.x * ax + bx, camera.centre.y * ay + by};
  return low;
}

// Sums of one pixel, and what scattering adds to them.
struct Upsampled {
  shading::LowSums sums = shading::noTexels();
  ScatterTerms scatter{};
  float refractionZ = 0.0f, diffuseZ = INFINITY;
};

class Upsampler {
 public:
  Upsampler(const OitPlanes& low, const LowView& view, glm::dvec2 sample)
      : low_(low), view_(view), shares_(view, sample), texels_(low.data.width(), low.data.height()) {
    eachRow(texels_.height(), [this](int y) {
      for (int x = 0; x < texels_.width(); ++x)
        texels_.at(x, y) = shading::lowTexelOf(shading::unpackSums(low_.at(x, y)), low_.solid.at(x, y),
                                               low_.frontZ.at(x, y), low_.info.weight);
    });
    readScatter();
    markNear();
    surface_.emplace(view, texels_, sample);
  }

  // Nothing where no texel reaches.
  std::optional<UpsampledLayer> at(int x, int y) const {
    if (!near_.at(x / view_.factor, y / view_.factor)) return std::nullopt;
    const Upsampled up = around(x, y);
    UpsampledLayer layer;
    layer.low = shading::lowLayerOf(up.sums);
    layer.nearestZ = up.sums.nearestZ;
    // What only bends or spreads counts too, or nobody would look where to.
    const glm::vec4& refraction = up.scatter.front();
    layer.bends = low_.scatters() && (refraction.z > 0.0f || refraction.w > 0.0f);
    if (low_.scatters()) setScatter(up, layer);
    return layer;
  }

 private:
  // Its planes of scattering, and what brings their numbers from texels to pixels.
  void readScatter() {
    const auto factor = static_cast<float>(view_.factor);
    const float powers[] = {1.0f, factor, factor * factor};
    for (const PlaneSpec& plane : planesOf(modelOf(low_))) {
      if (!isOfScattering(plane.sum)) continue;
      const auto sum = static_cast<std::size_t>(plane.sum), k = sum - kFirstScatterSum;
      scatter_[k] = low_.sums()[sum];
      for (int c = 0; c < 4; ++c) inPixels_[k][c] = powers[plane.pixelPower[static_cast<std::size_t>(c)]];
    }
  }

  // Blocks within reach of a texel that holds something.
  void markNear() {
    near_ = Image<std::uint8_t>(texels_.width(), texels_.height(), 0);
    for (int y = 0; y < texels_.height(); ++y)
      for (int x = 0; x < texels_.width(); ++x)
        if (low_.weight.at(x, y).a > 0.0f || low_.solid.at(x, y).a < INFINITY)
          shares_.texels(x, y, shading::PLD_UPSAMPLE_REACH + 1, [this](int i, int j) { near_.at(i, j) = 1; });
  }

  Upsampled around(int x, int y) const {
    const LowSurface::Pixel pixel = surface_->pixel(x, y);
    Upsampled up;
    shares_.around(x, y, [&](int i, int j, float share) { addTexel(up, i, j, pixel, share); });
    return up;
  }

  void addTexel(Upsampled& up, int i, int j, const LowSurface::Pixel& pixel, float share) const {
    const shading::LowTexel& texel = texels_.at(i, j);
    const float before = surface_->standingBefore(pixel, i, j);
    up.sums = shading::addTexel(up.sums, texel, share, before);
    if (low_.scatters()) scatterTexel(up, i, j, share * before);
  }

  void scatterTexel(Upsampled& up, int i, int j, float share) const {
    for (std::size_t k = 0; k < kScatterSums; ++k)
      if (scatter_[k]) up.scatter[k] += share * scatter_[k]->at(i, j);
    up.refractionZ += share * low_.light.at(i, j).a;
    if (share > 0.0f) up.diffuseZ = std::min(up.diffuseZ, low_.diffuseZ.at(i, j));
  }

  // Offsets and spreads of the low view are in texels.
  void setScatter(const Upsampled& up, UpsampledLayer& layer) const {
    if (!(up.sums.share > 0.0f)) return;
    for (std::size_t k = 0; k < kScatterSums; ++k) layer.scatter[k] = inPixels_[k] * (up.scatter[k] / up.sums.share);
    layer.refractionZ = up.refractionZ / up.sums.share;
    layer.diffuseZ = layer.refraction().w > 0.0f ? up.diffuseZ : INFINITY;
  }

  const OitPlanes& low_;
  const LowView& view_;
  std::array<const Image<glm::vec4>*, kScatterSums> scatter_{};  // null: the planes lack it
  ScatterTerms inPixels_{};
  LowShares shares_;
  Image<shading::LowTexel> texels_;
  Image<std::uint8_t> near_;
  std::optional<LowSurface> surface_;
};

}  // namespace

LowView lowViewOf(const GBuffer& gbuffer, const Image<glm::vec4>& solid, const Camera& camera, int factor,
                  const DepthPlanes* planes) {
  Image<float> opaqueZ = gbuffer.viewZ;
  for (std::size_t i = 0; i < solid.size(); ++i) opaqueZ[i] = std::min(opaqueZ[i], solid[i].a);
  return lowViewOf(gbuffer, std::move(opaqueZ), camera, factor, planes);
}

LowView lowViewOf(const GBuffer& gbuffer, Image<float> opaqueZ, const Camera& camera, int factor,
                  const DepthPlanes* planes) {
  LowView view;
  view.factor = factor;
  view.planes = planes;
  view.opaqueZ = std::move(opaqueZ);
  const int width = (gbuffer.data.width() + factor - 1) / factor,
            height = (gbuffer.data.height() + factor - 1) / factor;
  view.gbuffer.display = view.gbuffer.data = {0, 0, width, height};
  view.gbuffer.depthPrecision = gbuffer.depthPrecision;
  view.gbuffer.viewZ = Image<float>(width, height, 0.0f);
  eachRow(height, [&](int y) {
    for (int py = y * factor; py < std::min((y + 1) * factor, gbuffer.data.height()); ++py)
      for (int px = 0; px < gbuffer.data.width(); ++px) {
        float& farthest = view.gbuffer.viewZ.at(px / factor, y);
        farthest = std::max(farthest, view.opaqueZ.at(px, py));
      }
  });
  const Window covered{gbuffer.data.x0, gbuffer.data.y0, gbuffer.data.x0 + width * factor,
                       gbuffer.data.y0 + height * factor};
  view.camera = cameraOver(camera, gbuffer.display, covered);
  return view;
}

void upsample(const OitPlanes& low, const LowView& view, glm::dvec2 sample,
              const std::function<void(int, int, const UpsampledLayer&)>& each) {
  const Upsampler upsampler(low, view, sample);
  eachRow(view.opaqueZ.height(), [&](int y) {
    for (int x = 0; x < view.opaqueZ.width(); ++x)
      if (const std::optional<UpsampledLayer> layer = upsampler.at(x, y)) each(x, y, *layer);
  });
}

namespace {

void addLayer(const UpsampledLayer& layer, OitPlanes& planes, int x, int y) {
  const shading::OitTargets added = shading::packSums(shading::lowLayerSums(layer.low, planes.info.normalisation));
  planes.radiance.at(x, y) += added.radiance;
  planes.weight.at(x, y) += added.weight;
  planes.opacity.at(x, y) += added.opacity;
  planes.depth.at(x, y) += added.depth;
  planes.light.at(x, y) += added.light;
  planes.frontZ.at(x, y) = std::min(planes.frontZ.at(x, y), layer.nearestZ);
}

void addLayerScatter(const UpsampledLayer& layer, OitPlanes& planes, int x, int y) {
  for (std::size_t k = 0; k < kScatterSums; ++k)
    if (Image<glm::vec4>& plane = *planes.sums()[kFirstScatterSum + k]; !plane.empty())
      plane.at(x, y) += layer.scatter[k];
  planes.light.at(x, y).a += layer.refractionZ;
  planes.diffuseZ.at(x, y) = std::min(planes.diffuseZ.at(x, y), layer.diffuseZ);
}

// Mean offset of a layer, float pixels.
glm::vec2 offsetOf(const UpsampledLayer& layer) {
  const glm::vec4& sums = layer.refraction();
  return sums.z > 0.0f ? glm::vec2(sums) / sums.z : glm::vec2(0.0f);
}

shading::PublishedTargets publishedOf(const UpsampledLayer& layer) {
  shading::Scatter scatter;
  scatter.offset = offsetOf(layer);
  scatter.variance = layer.refraction().w;
  const glm::vec3 opacity = glm::vec3(1.0f) - layer.low.layer.transmission;
  return shading::publishedTargets(layer.low.weight * layer.low.layer.radiance,
                                   layer.low.weight * shading::meanOf(opacity), opacity, scatter);
}

}  // namespace

namespace {

// Adds what texels become in a pixel to the sums at (x, y).
void addUpsampled(const UpsampledLayer& layer, const OitPlanes& low, OitPlanes& planes, int x, int y,
                  PublishedClamps& clamps) {
  if (planes.published()) {
    if (layer.isThere()) blendPublished(publishedOf(layer), planes, x, y, clamps);
    return;
  }
  if (layer.isThere()) addLayer(layer, planes, x, y);
  if (low.scatters()) addLayerScatter(layer, planes, x, y);
}

}  // namespace

void addLowResolution(const OitPlanes& low, const LowView& view, glm::dvec2 sample, OitPlanes& planes,
                      PublishedClamps* clamps) {
  addPlanes(planes, modelOf(low));
  tbb::enumerable_thread_specific<PublishedClamps> own;
  upsample(low, view, sample,
           [&](int x, int y, const UpsampledLayer& layer) { addUpsampled(layer, low, planes, x, y, own.local()); });
  if (clamps)
    for (const PublishedClamps& each : own) *clamps += each;
}

void addLowResolution(const OitPlanes& low, const LowView& view, glm::dvec2 sample, const PixelPlaces& places,
                      OitPlanes& planes, PublishedClamps& clamps) {
  addPlanes(planes, modelOf(low));
  const Upsampler upsampler(low, view, sample);
  const auto width = static_cast<std::size_t>(planes.data.width());
  tbb::enumerable_thread_specific<PublishedClamps> own;
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    const FlushDenormals flush;
    if (const std::optional<UpsampledLayer> layer = upsampler.at(places[i].x, places[i].y))
      addUpsampled(*layer, low, planes, static_cast<int>(i % width), static_cast<int>(i / width), own.local());
  });
  for (const PublishedClamps& each : own) clamps += each;
}

OitPlanes planesOfVeil(const Veil& veil, const Image<float>& meanZ, const LowView& view, const OitPlanes* scatter) {
  OitPlanes planes = emptyPlanes(view.gbuffer.display, view.gbuffer.data);
  planes.info.weight.kind = shading::PLD_WEIGHT_UNIFORM;
  if (scatter) {
    for (std::size_t k = kFirstScatterSum; k < kAddedSums; ++k) *planes.sums()[k] = *scatter->sums()[k];
    planes.diffuseZ = scatter->diffuseZ;
  }
  for (std::size_t i = 0; i < veil.touched.size(); ++i) {
    if (!veil.touched[i]) continue;
    shading::Layer layer;
    layer.radiance = veil.light[i];
    layer.coverage = 1.0f;
    layer.transmission = veil.transmission[i];
    layer.z = meanZ[i];
    const shading::OitTargets targets =
        shading::packSums(shading::weighedSums(layer, 1.0f, 1.0f, shading::PLD_NORMALISE_SPECTRAL));
    planes.radiance[i] = targets.radiance;
    planes.weight[i] = targets.weight;
    planes.opacity[i] = targets.opacity;
    planes.depth[i] = targets.depth;
    planes.light[i] = targets.light;
    if (scatter) planes.light[i].a = scatter->light[i].a;
    planes.frontZ[i] = veil.frontZ[i];
  }
  return planes;
}

namespace {

constexpr std::uint32_t kLowIdentity = 0x6c6f7721u;

Fragment fragmentOf(const UpsampledLayer& layer) {
  Fragment fragment{};
  fragment.radiance = layer.low.layer.radiance;
  fragment.coverage = layer.low.layer.coverage;
  fragment.transmission = layer.low.layer.transmission;
  fragment.z = layer.low.shows ? layer.low.layer.z : layer.nearestZ;
  fragment.offset = offsetOf(layer);
  fragment.variance = layer.refraction().w;
  fragment.identity = kLowIdentity;
  // What hides all is still a layer here, not the pixel's solid.
  if (shading::isSolid(fragment.coverage, fragment.transmission)) fragment.coverage = std::nextafter(1.0f, 0.0f);
  return fragment;
}

}  // namespace

struct LowResolutionFragments::Source {
  OitPlanes low;
  std::shared_ptr<const LowView> view;
  Upsampler upsampler;
  Source(OitPlanes planes, std::shared_ptr<const LowView> seen, glm::dvec2 sample)
      : low(std::move(planes)), view(std::move(seen)), upsampler(low, *view, sample) {}
};

LowResolutionFragments::LowResolutionFragments(OitPlanes low, std::shared_ptr<const LowView> view, glm::dvec2 sample,
                                               const Window& data)
    : data_(data),
      scatters_(low.scatters()),
      layers_(modelOf(low)),
      source_(std::make_shared<const Source>(std::move(low), std::move(view), sample)) {}

LowResolutionFragments::Added LowResolutionFragments::addedAt(glm::ivec2 place) const {
  Added added;
  const FlushDenormals flush;
  const std::optional<UpsampledLayer> layer = source_->upsampler.at(place.x, place.y);
  if (!layer || !layer->isThere()) return added;
  added.isThere = true;
  added.whole = fragmentOf(*layer);
  added.scatter = layer->scatter;
  return added;
}

template <class PlaceOf>
std::vector<LowResolutionFragments::Added> LowResolutionFragments::addedTo(const FragmentLists& lists,
                                                                           const PlaceOf& placeOf, std::size_t begin,
                                                                           std::size_t end) const {
  std::vector<Added> all(end - begin);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, 64), [&](const auto& pixels) {
    std::vector<float> depths;
    for (std::size_t pixel = pixels.begin(); pixel != pixels.end(); ++pixel) {
      const std::optional<glm::ivec2> at = placeOf(pixel);
      if (!at) continue;
      Added& added = all[pixel - begin];
      added = addedAt(*at);
      if (!added.isThere || !runs_ || scatters_) continue;
      depths.clear();
      for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i)
        if (takesPart(lists.fragments[i], lists.solid[pixel])) depths.push_back(lists.fragments[i].z);
      runs_->addCuts(at->x, at->y, depths);
      if (depths.empty()) continue;
      std::sort(depths.begin(), depths.end());
      depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
      runs_->between(at->x, at->y, depths, kLowIdentity, added.runs);
    }
  });
  return all;
}

//   one  list of one fragment, with the columns that these layers have
void LowResolutionFragments::append(const Added& added, float solidZ, FragmentLists& one, FragmentLists& lists) {
  for (const Fragment& run : added.runs)
    if (run.z <= solidZ) lists.append(run);
  if (!added.runs.empty() || !added.isThere || added.whole.z > solidZ) return;
  one.fragments.front() = added.whole;
  setColumns(one, 0, added.scatter);
  lists.append(one, 0, 1);
}

template <class PlaceOf>
FragmentLists LowResolutionFragments::amongThose(const FragmentLists& lists, const PlaceOf& placeOf) const {
  constexpr std::size_t kAtOnce = std::size_t{1} << 15;  // pixels
  FragmentLists one, result = emptyLike(lists);
  std::size_t joined = 0;
  one.resize(1, layers_);
  result.offsets.reserve(lists.offsets.size());
  result.fragments.reserve(lists.fragments.size());
  for (std::size_t first = 0; first < lists.solid.size(); first += kAtOnce) {
    const std::size_t end = std::min(first + kAtOnce, lists.solid.size());
    const std::vector<Added> added = addedTo(lists, placeOf, first, end);
    for (const Added& own : added) joined += own.isThere ? std::max<std::size_t>(own.runs.size(), 1) : 0;
    // As many as there will be, if the others get as many as these: doubling would hold three times what is needed.
    const std::size_t expected =
        lists.fragments.size() +
        static_cast<std::size_t>(1.05 * static_cast<double>(joined) * static_cast<double>(lists.solid.size()) /
                                 static_cast<double>(end));
    if (result.fragments.capacity() < lists.fragments.size() + joined) result.fragments.reserve(expected);
    for (std::size_t pixel = first; pixel < end; ++pixel) {
      result.append(lists, lists.offsets[pixel], lists.offsets[pixel + 1]);
      append(added[pixel - first], lists.solid[pixel].a, one, result);
      result.endPixel();
    }
  }
  result.addColumnsOf(one);
  return result;
}

FragmentLists LowResolutionFragments::among(const FragmentLists& lists) const {
  const auto width = static_cast<std::size_t>(lists.window.width());
  const glm::ivec2 corner(lists.window.x0 - data_.x0, lists.window.y0 - data_.y0);
  return amongThose(lists, [&](std::size_t pixel) {
    return std::optional<glm::ivec2>(corner +
                                     glm::ivec2(static_cast<int>(pixel % width), static_cast<int>(pixel / width)));
  });
}

FragmentLists LowResolutionFragments::among(const FragmentLists& lists, const PixelPlaces& places) const {
  return amongThose(lists, [&](std::size_t pixel) {
    return pixel < places.size() ? std::optional<glm::ivec2>(places[pixel]) : std::nullopt;
  });
}

}  // namespace pellucid
