#include "engine_bridge/scene/foliage.h"

#include <algorithm>
#include <cstdint>

namespace pellucid {
namespace {

enum Texel : std::uint8_t { kClear = 1, kBetween = 2, kFull = 4 };

int wrapped(int i, int size) {
  return ((i % size) + size) % size;
}

// Bits of the kinds of texel within kMaskBorder along one axis.
Image<std::uint8_t> spread(const Image<std::uint8_t>& kinds, int dx, int dy) {
  Image<std::uint8_t> out(kinds.width(), kinds.height());
  for (int y = 0; y < kinds.height(); ++y)
    for (int x = 0; x < kinds.width(); ++x)
      for (int k = -kMaskBorder; k <= kMaskBorder; ++k)
        out.at(x, y) |= kinds.at(wrapped(x + k * dx, kinds.width()), wrapped(y + k * dy, kinds.height()));
  return out;
}

// The rows or columns of a finer level under one of a coarser level; the last one takes what is left over.
struct Span {
  int first, last;
};
Span under(int i, int coarse, int fine) {
  if (fine == 1) return {0, 0};
  return {2 * i, i + 1 == coarse ? fine - 1 : 2 * i + 1};
}

Image<glm::vec4> halved(const Image<glm::vec4>& fine) {
  Image<glm::vec4> coarse(std::max(fine.width() / 2, 1), std::max(fine.height() / 2, 1));
  for (int y = 0; y < coarse.height(); ++y)
    for (int x = 0; x < coarse.width(); ++x) {
      const Span rows = under(y, coarse.height(), fine.height()), columns = under(x, coarse.width(), fine.width());
      glm::dvec3 covered(0.0), plain(0.0);
      double alpha = 0.0, count = 0.0;
      for (int v = rows.first; v <= rows.last; ++v)
        for (int u = columns.first; u <= columns.last; ++u) {
          const glm::dvec4 texel(fine.at(u, v));
          covered += glm::dvec3(texel) * texel.a;
          plain += glm::dvec3(texel);
          alpha += texel.a;
          count += 1.0;
        }
      // What is cut away has no colour to give, unless there is nothing else.
      const glm::dvec3 colour = alpha > 0.0 ? covered / alpha : plain / count;
      coarse.at(x, y) = glm::vec4(glm::dvec4(colour, alpha / count));
    }
  return coarse;
}

constexpr int kLines = 4;  // across a patch that the cut crosses

// Part of a line from value a to value b that reaches the cutoff.
float reached(float a, float b, float cutoff) {
  if (std::min(a, b) >= cutoff) return 1.0f;
  if (std::max(a, b) < cutoff) return 0.0f;
  return (std::max(a, b) - cutoff) / std::abs(a - b);
}

}  // namespace

MaskMeasure measureMask(const Image<glm::vec4>& texels) {
  MaskMeasure measure;
  if (texels.empty()) return measure;
  Image<std::uint8_t> kinds(texels.width(), texels.height());
  std::size_t covered = 0, between = 0, clear = 0, full = 0, unexplained = 0;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const float alpha = texels[i].a;
    const Texel kind = alpha <= kMaskNoise ? kClear : alpha >= 1.0f - kMaskNoise ? kFull : kBetween;
    kinds[i] = kind;
    covered += alpha >= 0.5f;
    clear += kind == kClear;
    full += kind == kFull;
    between += kind == kBetween;
  }
  const auto all = static_cast<double>(texels.size());
  measure.covered = static_cast<double>(covered) / all;
  measure.between = measure.unexplained = static_cast<double>(between) / all;
  if (clear == 0 || full == 0 || measure.between > kMostBetween) return measure;  // no border could explain it
  const Image<std::uint8_t> nearby = spread(spread(kinds, 1, 0), 0, 1);
  for (std::size_t i = 0; i < texels.size(); ++i)
    unexplained += kinds[i] == kBetween && (nearby[i] & (kClear | kFull)) != (kClear | kFull);
  measure.unexplained = static_cast<double>(unexplained) / all;
  measure.binary = measure.unexplained <= kMostUnexplained;
  return measure;
}

bool infersOcclusion(const Material& material, const Scene& scene) {
  if (material.unlit || material.additive || material.transmission > 0.0f) return false;
  if (material.alphaMode == AlphaMode::mask) return true;
  const int texture = material.baseColorTexture.texture;
  if (material.alphaMode != AlphaMode::blend || texture < 0) return false;
  // A factor on alpha leaves nothing solid.
  if (material.baseColor.a * material.coverage.value_or(1.0f) < 1.0f) return false;
  return measureMask(scene.textures.at(static_cast<std::size_t>(texture)).texels).binary;
}

double coveredArea(const Image<glm::vec4>& level, float cutoff, float scale) {
  const auto alpha = [&](int x, int y) {
    return std::min(level.at(std::clamp(x, 0, level.width() - 1), std::clamp(y, 0, level.height() - 1)).a * scale,
                    1.0f);
  };
  double covered = 0.0;
  for (int y = -1; y < level.height(); ++y)
    for (int x = -1; x < level.width(); ++x) {
      // Of the outermost patches half lies beyond the edge.
      const double share =
          (x < 0 || x == level.width() - 1 ? 0.5 : 1.0) * (y < 0 || y == level.height() - 1 ? 0.5 : 1.0);
      // The bilinear patch between four texel centres is linear along lines; they run the way it is steeper, so that
      // straight edges count exactly.
      float a = alpha(x, y), b = alpha(x + 1, y), c = alpha(x, y + 1), d = alpha(x + 1, y + 1);
      const auto [low, high] = std::minmax({a, b, c, d});
      if (low >= cutoff) covered += share;
      if (low >= cutoff || high < cutoff) continue;
      if (std::abs(c + d - a - b) > std::abs(b + d - a - c)) std::swap(b, c);
      for (int i = 0; i < kLines; ++i) {
        const float t = (static_cast<float>(i) + 0.5f) / kLines;
        covered += share / kLines * static_cast<double>(reached(a * (1 - t) + c * t, b * (1 - t) + d * t, cutoff));
      }
    }
  return covered / static_cast<double>(level.size());
}

std::vector<Image<glm::vec4>> coveragePreservingMips(const Image<glm::vec4>& texels, float cutoff) {
  std::vector<Image<glm::vec4>> levels{texels};
  const double wanted = coveredArea(texels, cutoff);
  // Each level is halved from the unscaled one above it, so that no scale is applied twice.
  Image<glm::vec4> averaged = texels;
  while (averaged.width() > 1 || averaged.height() > 1) {
    averaged = halved(averaged);
    // Covered area grows with the scale, at times in steps: the nearest of both ends of the last interval.
    float low = 0.0f, high = 1.0f;
    while (coveredArea(averaged, cutoff, high) < wanted && high < 256.0f) high *= 2.0f;
    for (int i = 0; i < 12; ++i) {
      const float middle = 0.5f * (low + high);
      (coveredArea(averaged, cutoff, middle) < wanted ? low : high) = middle;
    }
    const double below = wanted - coveredArea(averaged, cutoff, low),
                 above = coveredArea(averaged, cutoff, high) - wanted;
    float scale = below < above ? low : high;
    // As good without: what nothing cuts is not brought near the cut. Nor is it by a hole that a level cannot show.
    if (std::abs(coveredArea(averaged, cutoff) - wanted) <= std::min(below, above)) scale = 1.0f;
    scale = std::max(scale, 0.5f * (1.0f + cutoff));
    Image<glm::vec4> level = averaged;
    for (std::size_t i = 0; i < level.size(); ++i) level[i].a = std::min(level[i].a * scale, 1.0f);
    levels.push_back(std::move(level));
  }
  return levels;
}

bool weighsByAlpha(const Material& material, const Scene& scene) {
  if (material.alphaMode == AlphaMode::opaque || material.baseColorTexture.texture < 0) return false;
  // A cut at or below 0 passes every alpha.
  if (material.alphaMode == AlphaMode::mask && material.alphaCutoff <= 0.0f) return false;
  const Image<glm::vec4>& texels =
      scene.textures.at(static_cast<std::size_t>(material.baseColorTexture.texture)).texels;
  for (std::size_t i = 0; i < texels.size(); ++i)
    if (texels[i].a < 1.0f) return true;
  return false;
}

float cutOfBase(const Material& material) {
  if (material.alphaMode != AlphaMode::mask || material.baseColorTexture.texture < 0) return 0.0f;
  if (!(material.baseColor.a > 0.0f)) return 0.0f;
  const float cut = material.alphaCutoff / material.baseColor.a;
  return cut <= 1.0f ? cut : 0.0f;
}

}  // namespace pellucid
