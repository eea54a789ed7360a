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

// Where a texel of a coarser level lies among those of the finer one: its first, and the share of each that it takes.
struct Span {
  int first = 0;
  std::vector<double> shares;  // sum to 1
};

std::vector<Span> spans(int coarse, int fine) {
  std::vector<Span> all(static_cast<std::size_t>(coarse));
  const double edge = static_cast<double>(fine) / coarse;
  for (int i = 0; i < coarse; ++i) {
    Span& span = all[static_cast<std::size_t>(i)];
    const double begin = i * edge, end = i + 1 == coarse ? fine : (i + 1) * edge;
    span.first = static_cast<int>(begin);
    for (int k = span.first; k < end; ++k)
      span.shares.push_back((std::min(end, k + 1.0) - std::max(begin, static_cast<double>(k))) / (end - begin));
  }
  return all;
}

// Colours averaged by what is left of them, unless nothing is.
Image<glm::vec4> halved(const Image<glm::vec4>& fine) {
  Image<glm::vec4> coarse(std::max(fine.width() / 2, 1), std::max(fine.height() / 2, 1));
  const std::vector<Span> columns = spans(coarse.width(), fine.width()), rows = spans(coarse.height(), fine.height());
  for (int y = 0; y < coarse.height(); ++y)
    for (int x = 0; x < coarse.width(); ++x) {
      const Span &row = rows[static_cast<std::size_t>(y)], &column = columns[static_cast<std::size_t>(x)];
      glm::dvec3 left(0.0), plain(0.0);
      double kept = 0.0;
      for (std::size_t v = 0; v < row.shares.size(); ++v)
        for (std::size_t u = 0; u < column.shares.size(); ++u) {
          const glm::dvec4 texel(fine.at(column.first + static_cast<int>(u), row.first + static_cast<int>(v)));
          const double share = row.shares[v] * column.shares[u];
          left += share * texel.a * glm::dvec3(texel);
          plain += share * glm::dvec3(texel);
          kept += share * texel.a;
        }
      coarse.at(x, y) = glm::vec4(glm::dvec4(kept > 0.0 ? left / kept : plain, kept));
    }
  return coarse;
}

constexpr int kTests = 4;  // of the cut along a texel's edge

// Alpha of the texels around one, row by row.
struct Around {
  float alpha[3][3];
  float at(float u, float v) const {  // between -1/2 and 1/2 from the middle one's centre
    const int x = u < 0.0f ? 0 : 1, y = v < 0.0f ? 0 : 1;
    const float fx = u < 0.0f ? u + 1.0f : u, fy = v < 0.0f ? v + 1.0f : v;
    const float upper = alpha[y][x] + fx * (alpha[y][x + 1] - alpha[y][x]);
    const float lower = alpha[y + 1][x] + fx * (alpha[y + 1][x + 1] - alpha[y + 1][x]);
    return upper + fy * (lower - upper);
  }
};

int across(int i, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) return wrapped(i, size);
  return std::clamp(i, 0, size - 1);  // a mirror shows the last texel once more
}

// Part of a texel's area that the cut leaves of the filtered alpha.
float keptOf(const Around& around, float cutoff) {
  float least = around.alpha[0][0], most = least;
  for (const auto& row : around.alpha)
    for (const float alpha : row) {
      least = std::min(least, alpha);
      most = std::max(most, alpha);
    }
  if (least >= cutoff) return 1.0f;
  if (most < cutoff) return 0.0f;
  int kept = 0;
  for (int j = 0; j < kTests; ++j)
    for (int i = 0; i < kTests; ++i)
      kept += around.at((static_cast<float>(i) + 0.5f) / kTests - 0.5f,
                        (static_cast<float>(j) + 0.5f) / kTests - 0.5f) >= cutoff;
  return static_cast<float>(kept) / (kTests * kTests);
}

// The texture with what the cut leaves of each texel for its alpha.
Image<glm::vec4> keptTexels(const Image<glm::vec4>& texels, float cutoff, const Sampling& sampling) {
  Image<glm::vec4> kept = texels;
  for (int y = 0; y < texels.height(); ++y)
    for (int x = 0; x < texels.width(); ++x) {
      if (sampling.nearest) {
        kept.at(x, y).a = texels.at(x, y).a >= cutoff ? 1.0f : 0.0f;
        continue;
      }
      Around around;
      for (int v = 0; v < 3; ++v)
        for (int u = 0; u < 3; ++u)
          around.alpha[v][u] = texels
                                   .at(across(x + u - 1, texels.width(), sampling.wrapS),
                                       across(y + v - 1, texels.height(), sampling.wrapT))
                                   .a;
      kept.at(x, y).a = keptOf(around, cutoff);
    }
  return kept;
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

std::vector<Image<glm::vec4>> keptLevels(const Image<glm::vec4>& texels, float cutoff, const Sampling& sampling) {
  std::vector<Image<glm::vec4>> levels{texels};
  Image<glm::vec4> finer = keptTexels(texels, cutoff, sampling);
  while (finer.width() > 1 || finer.height() > 1) {
    finer = halved(finer);
    levels.push_back(finer);
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
