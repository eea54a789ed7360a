#include "composite/occlusion.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <vector>

#include "composite/denormals.h"

namespace pellucid {
namespace {

// The layer's planes as the occluders' grid sees them.
class Rims {
 public:
  Rims(const FoliagePlanes& layer, const Window& occluders)
      : layer_(&layer), shift_(layer.data.x0 - occluders.x0, layer.data.y0 - occluders.y0) {}

  // Of a pixel of the layer, in the occluders' window; may lie outside it.
  glm::ivec2 place(int x, int y) const { return glm::ivec2(x, y) + shift_; }

  float coverage(int x, int y) const {
    if (x < 0 || y < 0 || x >= layer_->coverage.width() || y >= layer_->coverage.height()) return 0.0f;
    const float value = layer_->coverage.at(x, y);
    return std::isfinite(value) ? glm::clamp(value, 0.0f, 1.0f) : 0.0f;
  }

  glm::vec2 gradient(int x, int y) const {
    const glm::ivec2 at = place(x, y);
    const int left = x - (at.x & 1), top = y - (at.y & 1);
    return {coverage(left + 1, y) - coverage(left, y), coverage(x, top + 1) - coverage(x, top)};
  }

 private:
  const FoliagePlanes* layer_;
  glm::ivec2 shift_;
};

template <class Row>
void forRows(int height, Row row) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    for (int y = rows.begin(); y != rows.end(); ++y) row(y);
  });
}

glm::ivec2 sizeOf(const Window& window) {
  return {window.width(), window.height()};
}

// Depths beyond this are no depths; the shared text takes them for sky.
bool isDepth(float z) {
  return z > 0.0f && z <= 1e30f;
}

}  // namespace

Image<float> solidDepth(const FoliagePlanes& layer, const Window& window) {
  Image<float> solidZ(window.width(), window.height(), std::numeric_limits<float>::infinity());
  const Rims rims(layer, window);
  for (int y = 0; y < layer.coverage.height(); ++y)
    for (int x = 0; x < layer.coverage.width(); ++x) {
      const glm::ivec2 at = rims.place(x, y);
      if (at.x < 0 || at.y < 0 || at.x >= solidZ.width() || at.y >= solidZ.height()) continue;
      const float z = layer.viewZ.at(x, y);
      if (rims.coverage(x, y) >= 1.0f && isDepth(z)) solidZ.at(at.x, at.y) = z;
    }
  return solidZ;
}

Image<std::uint8_t> occludersWanted(const FoliagePlanes& layer, const Window& occluders, int form) {
  Image<std::uint8_t> wanted(occluders.width(), occluders.height());
  const Rims rims(layer, occluders);
  for (int y = 0; y < layer.coverage.height(); ++y)
    for (int x = 0; x < layer.coverage.width(); ++x) {
      if (!shading::isRim(rims.coverage(x, y)) || !isDepth(layer.viewZ.at(x, y))) continue;
      const shading::OcclusionSearch search = shading::occlusionSearch(rims.gradient(x, y));
      for (int tap = 0; tap < search.taps; ++tap) {
        const glm::ivec2 at = shading::occlusionPixel(rims.place(x, y), search, tap, form, sizeOf(occluders));
        wanted.at(at.x, at.y) = 1;
      }
    }
  return wanted;
}

glm::vec2 neighboursOcclusion(const OccluderPlanes& occluders, glm::ivec2 place, const shading::OcclusionSearch& search,
                              float z, int form) {
  glm::vec2 sum(0.0f);
  for (int tap = 0; tap < search.taps; ++tap) {
    const glm::ivec2 at = shading::occlusionPixel(place, search, tap, form, sizeOf(occluders.data));
    const float open = occluders.occlusion.at(at.x, at.y);
    const float opaqueZ = occluders.viewZ.at(at.x, at.y);
    if (!std::isfinite(open) || !isDepth(opaqueZ)) continue;
    sum += shading::occlusionTap(search, tap, glm::clamp(open, 0.0f, 1.0f), opaqueZ, z, form);
  }
  return sum;
}

InferredOcclusion inferOcclusion(const FoliagePlanes& layer, const OccluderPlanes& occluders, int form) {
  const int width = layer.coverage.width(), height = layer.coverage.height();
  InferredOcclusion result;
  result.occlusion = Image<float>(width, height, 1.0f);
  struct Counts {
    std::size_t rims = 0, withoutDepth = 0, withoutSources = 0;
  };
  std::vector<Counts> counts(static_cast<std::size_t>(height));
  const Rims rims(layer, occluders.data);
  forRows(height, [&](int y) {
    Counts& count = counts[static_cast<std::size_t>(y)];
    for (int x = 0; x < width; ++x) {
      if (!shading::isRim(rims.coverage(x, y))) continue;
      ++count.rims;
      const float z = layer.viewZ.at(x, y);
      if (!isDepth(z)) {
        ++count.withoutDepth;
        continue;
      }
      const shading::OcclusionSearch search = shading::occlusionSearch(rims.gradient(x, y));
      const glm::vec2 sum = neighboursOcclusion(occluders, rims.place(x, y), search, z, form);
      if (sum.y <= 0.0f) ++count.withoutSources;
      result.occlusion.at(x, y) = shading::occlusionFrom(sum, form);
    }
  });
  for (const Counts& count : counts) {
    result.rims += count.rims;
    result.withoutDepth += count.withoutDepth;
    result.withoutSources += count.withoutSources;
  }
  return result;
}

void applyOcclusion(const Image<float>& occlusion, const Image<glm::vec3>& indirect, float directShare,
                    Image<glm::vec4>& beauty, Image<std::uint8_t>& touched) {
  touched = Image<std::uint8_t>(beauty.width(), beauty.height());
  forRows(beauty.height(), [&](int y) {
    for (int x = 0; x < beauty.width(); ++x) {
      const float open = occlusion.at(x, y);
      if (open >= 1.0f) continue;
      glm::vec4& pixel = beauty.at(x, y);
      const glm::vec3 all(pixel), around = indirect.at(x, y);
      const glm::vec3 lit = shading::occludedLight(all - around, around, open, directShare);
      if (!std::isfinite(lit.r + lit.g + lit.b)) continue;
      // An indirect part larger than the whole would leave less than nothing.
      for (int c = 0; c < 3; ++c) pixel[c] = all[c] >= 0.0f ? std::max(lit[c], 0.0f) : lit[c];
      touched.at(x, y) = 1;
    }
  });
}

}  // namespace pellucid
