#include "composite/fog.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "composite/denormals.h"
#include "composite/fold_published.h"

namespace pellucid {
namespace shading {

// The shared text of the march, with the functions by which it reads volumes.
struct FogText {
  const Fog& fog;
  ivec3 gridSize;
  bool hasVisibility;
  mat4 volumeFromView;
  int lightsOfFog;

  explicit FogText(const Fog& given)
      : fog(given),
        gridSize(given.grid ? given.grid->density.size : ivec3(1)),
        hasVisibility(given.visibility != nullptr),
        volumeFromView(given.visibility ? given.visibility->texelFromView : mat4(1.0f)),
        lightsOfFog(static_cast<int>(given.lights.size())) {}
  float densityTexel(ivec3 texel) const { return fog.grid->density.clamped(texel); }
  vec3 visibilityTexel(int light, ivec3 texel) const {
    const LightVolume& volume = *fog.visibility;
    const ivec3 inside = clamp(texel, ivec3(0), volume.size - 1);
    return vec3(volume.visibility.at(ivec3(inside.x, inside.y, inside.z + light * volume.size.z)));
  }
  const PunctualLight& lightNumber(int light) const { return fog.lights[static_cast<std::size_t>(light)]; }

#define PLD_FN inline
#define precise
#include "shaders/shared/march.glsl"
#undef precise
#undef PLD_FN
};

}  // namespace shading

namespace {

constexpr std::uint32_t kFogIdentity = 0x666f6721u;
constexpr float kMostCoverage = 0.99999994f;  // a run of fog is never solid

struct Marcher {
  const Fog& fog;
  std::unique_ptr<shading::FogText> text;
  PixelRays rays;

  Marcher(const Fog& given, const GBuffer& gbuffer, const Window& window, glm::dvec2 sample)
      : fog(given),
        text(new shading::FogText(given)),
        rays(pixelRays(given.camera, gbuffer.display, {window.x0, window.y0}, sample)) {}

  shading::FogSpan span(int x, int y, float z) const {
    const glm::vec2 at = rays.offset + rays.scale * glm::vec2(static_cast<float>(x), static_cast<float>(y));
    return shading::spanOfPixel(fog.medium, at, rays.orthographic ? 1 : 0, z);
  }
};

// One ray's march in pieces that end where a surface stands.
class Runs {
 public:
  explicit Runs(std::vector<Fragment>& made) : made_(made) {}
  void add(float depth, float z, glm::vec3 source) {
    const float hides = shading::pldOneMinusExp(depth);
    const float seen = passed_ * hides;
    radiance_ += seen * source;
    z_ += seen * z;
    hidden_ += seen;
    passed_ *= shading::pldExp(-depth);
    depth_ += depth;
  }
  //   last  depth of the surface that ends the run
  void end(float first, float last) {
    if (depth_ > 0.0f) {
      Fragment run{};
      run.radiance = radiance_;
      run.coverage = std::min(shading::pldOneMinusExp(depth_), kMostCoverage);
      run.transmission = glm::vec3(0.0f);
      run.identity = shading::identityOf(kFogIdentity, number_);
      // Strictly between the two, or it would merge with one of them.
      const float middle = hidden_ > 0.0f ? z_ / hidden_ : first;
      run.z = std::clamp(middle, std::nextafter(first, last), std::max(std::nextafter(last, first), first));
      if (run.z > 0.0f) made_.push_back(run);
    }
    radiance_ = glm::vec3(0.0f);
    passed_ = 1.0f;
    z_ = hidden_ = depth_ = 0.0f;
    ++number_;
  }

 private:
  std::vector<Fragment>& made_;
  glm::vec3 radiance_{0.0f};
  std::uint32_t number_ = 0;
  float passed_ = 1.0f, z_ = 0.0f, hidden_ = 0.0f, depth_ = 0.0f;
};

// `cuts` ascending, planar metres.
void marchRuns(const Marcher& marcher, const shading::FogSpan& span, const std::vector<float>& cuts, float behind,
               std::vector<Fragment>& made) {
  const shading::Medium& medium = marcher.fog.medium;
  Runs runs(made);
  std::size_t next = 0;
  float first = 0.0f;
  const int count = static_cast<int>(medium.march.y);
  for (int i = 0; i < count; ++i) {
    const shading::FogStep step = marcher.text->fogStep(medium, span, i);
    const float z0 = step.begin * span.zPerMetre, z1 = step.end * span.zPerMetre;
    const bool lit = step.depth > 0.0f;
    const glm::vec3 source = lit ? marcher.text->scatteredAt(medium, step.middle, span.direction) : glm::vec3(0.0f);
    float from = z0;
    for (; next < cuts.size() && cuts[next] < z1; ++next) {
      const float to = std::max(cuts[next], from);
      // Even within the step.
      if (lit && to > from) runs.add(step.depth * ((to - from) / (z1 - z0)), 0.5f * (from + to), source);
      runs.end(first, cuts[next]);
      first = cuts[next];
      from = to;
    }
    if (lit && z1 > from) runs.add(step.depth * ((z1 - from) / (z1 - z0)), 0.5f * (from + z1), source);
  }
  runs.end(first, behind);
}

// A ray's fog to the sums of its pixel.
void addMarched(const shading::FogSums& sums, int order, OitPlanes& planes, int x, int y, PublishedClamps& clamps) {
  if (!(sums.share > 0.0f)) return;
  const shading::OitSums own = shading::fogOitSums(sums, order);
  if (planes.published()) {
    blendPublished(publishedLayer(own), planes, x, y, clamps);
    return;
  }
  const shading::OitTargets added = shading::packSums(own);
  planes.radiance.at(x, y) += added.radiance;
  planes.weight.at(x, y) += added.weight;
  planes.opacity.at(x, y) += added.opacity;
  planes.depth.at(x, y) += added.depth;
  planes.light.at(x, y) += added.light;
  planes.frontZ.at(x, y) = std::min(planes.frontZ.at(x, y), shading::fogZ(sums));
}

void addRay(const Marcher& marcher, const shading::FogSpan& span, OitPlanes& planes, int x, int y,
            PublishedClamps& clamps) {
  const Fog& fog = marcher.fog;
  addMarched(marcher.text->marchFog(fog.medium, span, planes.info.weight, fog.order), fog.order, planes, x, y, clamps);
}

// Depths of a deep picture's samples, so that no run reaches past one.
void cutBySamples(const DeepOpaque& deep, int x, int y, float behind, std::vector<float>& cuts) {
  const std::size_t pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(deep.data.width()) + static_cast<std::size_t>(x);
  for (std::uint64_t k = deep.offsets[pixel]; k < deep.offsets[pixel + 1]; ++k)
    if (deep.samples[k].z < behind) cuts.push_back(deep.samples[k].z);
}

}  // namespace

void addFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, OitPlanes& planes, PublishedClamps* clamps) {
  const Marcher marcher(fog, gbuffer, planes.data, sample);
  tbb::enumerable_thread_specific<PublishedClamps> own;
  tbb::parallel_for(tbb::blocked_range<int>(0, planes.data.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    PublishedClamps& counted = own.local();
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < planes.data.width(); ++x) {
        const float z = std::min(gbuffer.viewZ.at(x, y), planes.solid.at(x, y).a);
        addRay(marcher, marcher.span(x, y, z), planes, x, y, counted);
      }
  });
  if (clamps)
    for (const PublishedClamps& each : own) *clamps += each;
}

void addFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const HeldOutRow& row, OitPlanes& planes,
            PublishedClamps* clamps) {
  const Marcher marcher(fog, gbuffer, gbuffer.data, sample);
  const FlushDenormals flush;
  PublishedClamps counted;
  for (int i = 0; i < planes.data.width(); ++i) {
    const auto entry = static_cast<std::size_t>(i);
    const glm::ivec2 at = row.pixel[entry] - glm::ivec2(gbuffer.data.x0, gbuffer.data.y0);
    const float z = std::min({gbuffer.viewZ.at(at.x, at.y), row.z[entry], planes.solid[entry].a});
    addRay(marcher, marcher.span(at.x, at.y, z), planes, i, 0, counted);
  }
  if (clamps) *clamps += counted;
}

namespace {

// The fragments of a row of pixels, and how many each pixel has.
struct RowOfRuns {
  std::vector<Fragment> made;
  std::vector<std::uint64_t> counts;
};

// The lists with the runs of their rows behind each pixel's own fragments.
FragmentLists joined(const FragmentLists& lists, const std::vector<RowOfRuns>& rows) {
  FragmentLists result;
  result.window = lists.window;
  result.solid = lists.solid;
  result.offsets.assign(1, 0);
  const bool disperses = lists.disperses();
  std::size_t pixel = 0;
  for (const RowOfRuns& row : rows) {
    std::size_t taken = 0;
    for (const std::uint64_t count : row.counts) {
      const auto begin = static_cast<std::ptrdiff_t>(lists.offsets[pixel]),
                 end = static_cast<std::ptrdiff_t>(lists.offsets[pixel + 1]);
      result.fragments.insert(result.fragments.end(), lists.fragments.begin() + begin, lists.fragments.begin() + end);
      const auto own = row.made.begin() + static_cast<std::ptrdiff_t>(taken);
      result.fragments.insert(result.fragments.end(), own, own + static_cast<std::ptrdiff_t>(count));
      taken += count;
      result.offsets.push_back(result.fragments.size());
      if (disperses) {
        result.dispersion.insert(result.dispersion.end(), lists.dispersion.begin() + begin,
                                 lists.dispersion.begin() + end);
        result.dispersion.resize(result.fragments.size(), glm::vec4(0.0f));
      }
      ++pixel;
    }
  }
  return result;
}

// Runs before every pixel of the lists.
//   marched         the corner of the marcher's window in the data window
//   placeOf(i, x, y)  where a pixel lies in the data window; nothing where it is none
template <class PlaceOf>
FragmentLists withRuns(const Marcher& marcher, const GBuffer& gbuffer, const FragmentLists& lists,
                       const DeepOpaque* deep, glm::ivec2 marched, const PlaceOf& placeOf) {
  const int width = lists.window.width(), height = lists.window.height();
  std::vector<RowOfRuns> rows(static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int y) {
    const FlushDenormals flush;
    RowOfRuns& row = rows[static_cast<std::size_t>(y)];
    std::vector<float> cuts;
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      const std::size_t before = row.made.size();
      if (const std::optional<glm::ivec2> at = placeOf(pixel, x, y)) {
        const float behind = std::min(gbuffer.viewZ.at(at->x, at->y), lists.solid.at(x, y).a);
        cuts.clear();
        for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i)
          cuts.push_back(lists.fragments[i].z);
        if (deep) cutBySamples(*deep, at->x, at->y, behind, cuts);
        std::sort(cuts.begin(), cuts.end());
        marchRuns(marcher, marcher.span(at->x - marched.x, at->y - marched.y, behind), cuts, behind, row.made);
      }
      row.counts.push_back(row.made.size() - before);
    }
  });
  return joined(lists, rows);
}

}  // namespace

FragmentLists withFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const FragmentLists& lists,
                      const DeepOpaque* deep) {
  const Marcher marcher(fog, gbuffer, lists.window, sample);
  const glm::ivec2 corner(lists.window.x0 - gbuffer.data.x0, lists.window.y0 - gbuffer.data.y0);
  return withRuns(marcher, gbuffer, lists, deep, corner,
                  [&](std::size_t, int x, int y) { return std::optional<glm::ivec2>(corner + glm::ivec2(x, y)); });
}

FragmentLists withFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const FragmentLists& lists,
                      const PixelPlaces& places) {
  const Marcher marcher(fog, gbuffer, gbuffer.data, sample);
  return withRuns(marcher, gbuffer, lists, nullptr, glm::ivec2(0), [&](std::size_t pixel, int, int) {
    return pixel < places.size() ? std::optional<glm::ivec2>(places[pixel]) : std::nullopt;
  });
}

MarchedFog::MarchedFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const PixelPlaces& places,
                       const Image<glm::vec4>& solid)
    : order_(fog.order), steps_(places.size()), netOpacity_(places.size(), 0.0f) {
  const Marcher marcher(fog, gbuffer, gbuffer.data, sample);
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    const FlushDenormals flush;
    const glm::ivec2 at = places[i];
    const shading::FogSpan span = marcher.span(at.x, at.y, std::min(gbuffer.viewZ.at(at.x, at.y), solid[i].a));
    const float whole = marcher.text->fogDepth(fog.medium, span);
    if (!(whole > 0.0f)) return;
    netOpacity_[i] = shading::pldOneMinusExp(whole);
    for (int k = 0; k < static_cast<int>(fog.medium.march.y); ++k) {
      const shading::FogStep step = marcher.text->fogStep(fog.medium, span, k);
      if (step.depth > 0.0f)
        steps_[i].push_back({marcher.text->scatteredAt(fog.medium, step.middle, span.direction), step.depth, step.z});
    }
  });
}

void MarchedFog::addTo(OitPlanes& planes, PublishedClamps& clamps) const {
  const auto width = static_cast<std::size_t>(planes.data.width());
  tbb::enumerable_thread_specific<PublishedClamps> own;
  tbb::parallel_for(std::size_t{0}, steps_.size(), [&](std::size_t i) {
    const FlushDenormals flush;
    shading::FogSums sums = shading::noFog();
    for (const Step& step : steps_[i])
      sums = shading::addStep(sums, step.depth, step.z, step.source, planes.info.weight, netOpacity_[i], order_);
    addMarched(sums, order_, planes, static_cast<int>(i % width), static_cast<int>(i / width), own.local());
  });
  for (const PublishedClamps& each : own) clamps += each;
}

FogRay fogThrough(const Fog& fog, glm::vec3 origin, glm::vec3 direction, float zPerMetre, float z) {
  shading::FogText text(fog);
  const shading::FogSpan span = shading::fogSpan(fog.medium, origin, direction, zPerMetre, z);
  shading::WeightSettings uniform{shading::PLD_WEIGHT_UNIFORM, 0.1f, 1000.0f, 1.0f, 1.0f};
  const shading::FogSums sums = text.marchFog(fog.medium, span, uniform, shading::PLD_FOG_ORDERED);
  return {sums.radiance, sums.passed, sums.depth};
}

}  // namespace pellucid
