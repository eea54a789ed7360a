// Fog as runs between the surfaces of fragment lists.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "composite/denormals.h"
#include "composite/fog.h"
#include "composite/fog_march.h"

namespace pellucid {
namespace {

constexpr std::uint32_t kFogIdentity = 0x666f6721u;
constexpr float kMostCoverage = 0.99999994f;  // a run of fog is never solid

// One ray's march in pieces that end where a surface stands.
class Runs {
 public:
  //   spread  of the whole ray: given to the run that lies where it does
  Runs(std::vector<Fragment>& made, const shading::FogSpread& spread)
      : made_(made), first_(made.size()), spread_(spread) {}
  void add(float depth, float z, glm::vec3 source) {
    const float hides = shading::pldOneMinusExp(depth);
    const float seen = passed_ * hides;
    radiance_ += seen * source;
    z_ += seen * z;
    hidden_ += seen;
    passed_ *= shading::pldExp(-depth);
    depth_ += depth;
  }
  // What a piece emits, before its add().
  void emit(float z, glm::vec3 sent) {
    const glm::vec3 seen = passed_ * sent;
    const float mean = shading::meanOf(seen);
    radiance_ += seen;
    emitted_ += mean;
    emittedZ_ += mean * z;
  }
  //   last  depth of the surface that ends the run
  void end(float first, float last) {
    if (depth_ > 0.0f || emitted_ > 0.0f) {
      Fragment run{};
      run.radiance = radiance_;
      run.coverage = std::min(shading::pldOneMinusExp(depth_), kMostCoverage);
      run.transmission = glm::vec3(0.0f);
      run.identity = shading::identityOf(kFogIdentity, number_);
      // Strictly between the two, or it would merge with one of them.
      const float middle = hidden_ > 0.0f ? z_ / hidden_ : emitted_ > 0.0f ? emittedZ_ / emitted_ : first;
      run.z = std::clamp(middle, std::nextafter(first, last), std::max(std::nextafter(last, first), first));
      if (spread_.variance > 0.0f && spread_.z < last) {
        run.z = std::clamp(spread_.z, std::nextafter(first, last), std::max(std::nextafter(last, first), first));
        run.variance = std::exchange(spread_.variance, 0.0f);
      }
      if (run.z > 0.0f) made_.push_back(run);
    }
    radiance_ = glm::vec3(0.0f);
    passed_ = 1.0f;
    z_ = hidden_ = depth_ = emitted_ = emittedZ_ = 0.0f;
    ++number_;
  }

  // After the last run: where it lies in a gap of the fog, the farthest run before it spreads.
  void finish() {
    if (spread_.variance > 0.0f && made_.size() > first_) made_.back().variance = spread_.variance;
  }

 private:
  std::vector<Fragment>& made_;
  std::size_t first_;
  shading::FogSpread spread_;
  glm::vec3 radiance_{0.0f};
  std::uint32_t number_ = 0;
  float passed_ = 1.0f, z_ = 0.0f, hidden_ = 0.0f, depth_ = 0.0f, emitted_ = 0.0f, emittedZ_ = 0.0f;
};

// `cuts` ascending, planar metres.
void marchRuns(const FogMarcher& marcher, const shading::FogSpan& span, const std::vector<float>& cuts, float behind,
               std::vector<Fragment>& made) {
  const shading::Medium& medium = marcher.fog.medium;
  const bool emits = shading::mediumEmits(medium);
  shading::FogSpread spread{0.0f, 0.0f};
  if (marcher.fog.diffuses()) spread = marcher.spread(span, behind);
  Runs runs(made, spread);
  std::size_t next = 0;
  float first = 0.0f;
  const int count = static_cast<int>(medium.march.y);
  for (int i = 0; i < count; ++i) {
    const shading::FogStep step = marcher.text->fogStep(medium, span, i);
    const float z0 = step.begin * span.zPerMetre, z1 = step.end * span.zPerMetre;
    const bool lit = step.depth > 0.0f;
    const glm::vec3 source = lit ? marcher.text->scatteredAt(medium, step.middle, span.direction) : glm::vec3(0.0f);
    // Even within the step.
    const auto addPiece = [&](float from, float to) {
      if (!(to > from)) return;
      const float share = (to - from) / (z1 - z0), z = 0.5f * (from + to);
      shading::FogStep piece = step;
      piece.depth = step.depth * share;
      piece.end = step.begin + (step.end - step.begin) * share;
      if (emits) runs.emit(z, marcher.text->emittedInStep(medium, piece));
      if (lit) runs.add(piece.depth, z, source);
    };
    float from = z0;
    for (; next < cuts.size() && cuts[next] < z1; ++next) {
      const float to = std::max(cuts[next], from);
      addPiece(from, to);
      runs.end(first, cuts[next]);
      first = cuts[next];
      from = to;
    }
    addPiece(from, z1);
  }
  runs.end(first, behind);
  runs.finish();
}

// Depths of a deep picture's samples, so that no run reaches past one.
void cutBySamples(const DeepOpaque& deep, int x, int y, float behind, std::vector<float>& cuts) {
  const std::size_t pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(deep.data.width()) + static_cast<std::size_t>(x);
  for (std::uint64_t k = deep.offsets[pixel]; k < deep.offsets[pixel + 1]; ++k)
    if (deep.samples[k].z < behind) cuts.push_back(deep.samples[k].z);
}

// The fragments of a row of pixels, and how many each pixel has.
struct RowOfRuns {
  std::vector<Fragment> made;
  std::vector<std::uint64_t> counts;
};

// The lists with the runs of their rows behind each pixel's own fragments.
FragmentLists joined(const FragmentLists& lists, const std::vector<RowOfRuns>& rows) {
  FragmentLists result = emptyLike(lists);
  std::size_t pixel = 0;
  for (const RowOfRuns& row : rows) {
    std::size_t taken = 0;
    for (const std::uint64_t count : row.counts) {
      result.append(lists, lists.offsets[pixel], lists.offsets[pixel + 1]);
      for (const std::uint64_t end = taken + count; taken < end; ++taken) result.append(row.made[taken]);
      result.endPixel();
      ++pixel;
    }
  }
  return result;
}

// Runs before every pixel of the lists.
//   marched         the corner of the marcher's window in the data window
//   placeOf(i, x, y)  where a pixel lies in the data window; nothing where it is none
template <class PlaceOf>
FragmentLists withRuns(const FogMarcher& marcher, const GBuffer& gbuffer, const FragmentLists& lists,
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
  const FogMarcher marcher(fog, gbuffer, lists.window, sample);
  const glm::ivec2 corner(lists.window.x0 - gbuffer.data.x0, lists.window.y0 - gbuffer.data.y0);
  return withRuns(marcher, gbuffer, lists, deep, corner,
                  [&](std::size_t, int x, int y) { return std::optional<glm::ivec2>(corner + glm::ivec2(x, y)); });
}

FragmentLists withFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const FragmentLists& lists,
                      const PixelPlaces& places) {
  const FogMarcher marcher(fog, gbuffer, gbuffer.data, sample);
  return withRuns(marcher, gbuffer, lists, nullptr, glm::ivec2(0), [&](std::size_t pixel, int, int) {
    return pixel < places.size() ? std::optional<glm::ivec2>(places[pixel]) : std::nullopt;
  });
}

}  // namespace pellucid
