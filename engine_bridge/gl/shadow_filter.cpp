#include "engine_bridge/gl/shadow_filter.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace pellucid::gl {
namespace {

glm::vec4 texelOf(const DrawnBand& band, int channels, int channel, int x, int y) {
  const glm::vec4& nearest = band.nearest.at(x, y);
  return shading::shadowTexelOf(nearest[channel], channels == 1 ? nearest.a : band.steps.at(x, y)[channel]);
}

// Light that something opaque stops before all of the casters of a texel says nothing of those beside it, which it does
// not stop: counted as empty, such texels would let light through along the rim of the opaque thing's own shadow. They
// count where there are no others.
constexpr float kStopped = 0x1p-12f;

float weightOf(const DrawnBand& band, int channels, int x, int y) {
  const glm::vec4& nearest = band.nearest.at(x, y);
  if (channels == 1) return nearest.b < 0.0f && nearest.a == 0.0f ? kStopped : 1.0f;
  const glm::vec4& steps = band.steps.at(x, y);
  return steps.a > 0.0f && steps.r == 0.0f && steps.g == 0.0f && steps.b == 0.0f ? kStopped : 1.0f;
}

}  // namespace

void shadowTexels(const DrawnBand& band, int channels, glm::vec4* out) {
  const int width = band.nearest.width();
  tbb::parallel_for(0, band.nearest.height(), [&](int y) {
    glm::vec4* row = out + static_cast<std::ptrdiff_t>(y) * width * channels;
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) *row++ = texelOf(band, channels, c, x, y);
  });
}

void filterShadow(const DrawnBand& band, int channels, int edge, int rows, glm::vec4* out, float* weights) {
  const int width = edge / kShadowDivide, height = band.nearest.height();
  const auto stride = static_cast<std::size_t>(width * channels);
  std::vector<glm::vec4> across(stride * static_cast<std::size_t>(height));
  Image<float> acrossWeight(width, height);
  tbb::parallel_for(0, height, [&](int y) {
    std::vector<glm::vec4> texels(static_cast<std::size_t>(edge));
    std::vector<float> drawn(static_cast<std::size_t>(edge));
    for (int x = 0; x < edge; ++x) drawn[static_cast<std::size_t>(x)] = weightOf(band, channels, x, y);
    for (int x = 0; x < width; ++x) {
      float sum = 0.0f;
      const int middle = shading::tentMiddle(x);
      for (int i = -kTentReach; i <= kTentReach; ++i) {
        const bool inside = middle + i >= 0 && middle + i < edge;
        sum += shading::shadowTent(i) * (inside ? drawn[static_cast<std::size_t>(middle + i)] : 1.0f);
      }
      acrossWeight.at(x, y) = sum;
    }
    for (int c = 0; c < channels; ++c) {
      for (int x = 0; x < edge; ++x)
        texels[static_cast<std::size_t>(x)] = drawn[static_cast<std::size_t>(x)] * texelOf(band, channels, c, x, y);
      for (int x = 0; x < width; ++x) {
        glm::vec4 sum(0.0f);
        const int middle = shading::tentMiddle(x);
        for (int i = -kTentReach; i <= kTentReach; ++i)
          if (middle + i >= 0 && middle + i < edge)
            sum = shading::addToTent(sum, i, texels[static_cast<std::size_t>(middle + i)]);
        across[stride * static_cast<std::size_t>(y) + static_cast<std::size_t>(x * channels + c)] = sum;
      }
    }
  });
  tbb::parallel_for(0, rows, [&](int y) {
    glm::vec4* row = out + stride * static_cast<std::size_t>(y);
    std::fill(row, row + stride, glm::vec4(0.0f));
    for (int j = -kTentReach; j <= kTentReach; ++j) {
      const int from = shading::tentMiddle(y) + j + kTentReach;
      if (from >= height) continue;
      const glm::vec4* drawn = &across[stride * static_cast<std::size_t>(from)];
      for (std::size_t i = 0; i < stride; ++i) row[i] = shading::addToTent(row[i], j, drawn[i]);
    }
    for (int x = 0; x < width; ++x) {
      float weight = 0.0f;
      for (int j = -kTentReach; j <= kTentReach; ++j) {
        const int from = shading::tentMiddle(y) + j + kTentReach;
        weight += shading::shadowTent(j) * (from < height ? acrossWeight.at(x, from) : 1.0f);
      }
      weights[static_cast<std::ptrdiff_t>(y) * width + x] = weight;
      if (weight == 1.0f) continue;
      for (int c = 0; c < channels; ++c) row[x * channels + c] /= weight;
    }
  });
}

void fillStopped(const std::vector<float>& weights, int channels, int edge, glm::vec4* texels) {
  const int width = edge / kShadowDivide;
  const auto at = [&](int x, int y) { return static_cast<std::ptrdiff_t>(y) * width + x; };
  const auto stopped = [&](int x, int y) { return weights[static_cast<std::size_t>(at(x, y))] <= kStopped; };
  tbb::parallel_for(0, width, [&](int y) {
    for (int x = 0; x < width; ++x) {
      if (!stopped(x, y)) continue;
      float count = 0.0f;
      glm::vec4 sums[3] = {glm::vec4(0.0f), glm::vec4(0.0f), glm::vec4(0.0f)};
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, width - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
          if (stopped(u, v)) continue;
          count += 1.0f;
          for (int c = 0; c < channels; ++c) sums[c] += texels[at(u, v) * channels + c];
        }
      for (int c = 0; c < channels && count > 0.0f; ++c) texels[at(x, y) * channels + c] = sums[c] / count;
    }
  });
}

}  // namespace pellucid::gl
