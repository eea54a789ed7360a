#include "engine_bridge/scene/mask_levels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "shaders/shading.h"

namespace pellucid {
namespace {

constexpr int kLines = 4;        // across a quarter of a texel that the cut crosses
constexpr int kReads = 1 << 14;  // of a level that is measured

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

// Colours averaged by alpha, unless there is none. The mean of alpha stays that of the finer level.
Image<glm::vec4> halved(const Image<glm::vec4>& fine) {
  Image<glm::vec4> coarse(std::max(fine.width() / 2, 1), std::max(fine.height() / 2, 1));
  const std::vector<Span> columns = spans(coarse.width(), fine.width()), rows = spans(coarse.height(), fine.height());
  tbb::parallel_for(0, coarse.height(), [&](int y) {
    const Span& row = rows[static_cast<std::size_t>(y)];
    for (int x = 0; x < coarse.width(); ++x) {
      const Span& column = columns[static_cast<std::size_t>(x)];
      glm::dvec3 weighted(0.0), plain(0.0);
      double alpha = 0.0;
      for (std::size_t v = 0; v < row.shares.size(); ++v)
        for (std::size_t u = 0; u < column.shares.size(); ++u) {
          const glm::dvec4 texel(fine.at(column.first + static_cast<int>(u), row.first + static_cast<int>(v)));
          const double share = row.shares[v] * column.shares[u];
          weighted += share * texel.a * glm::dvec3(texel);
          plain += share * glm::dvec3(texel);
          alpha += share * texel.a;
        }
      coarse.at(x, y) = glm::vec4(glm::dvec4(alpha > 0.0 ? weighted / alpha : plain, alpha));
    }
  });
  return coarse;
}

int across(int i, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) return ((i % size) + size) % size;
  return std::clamp(i, 0, size - 1);  // a mirror shows the last texel once more
}

// Part of a line from value a to value b that reaches the cutoff.
float reached(float a, float b, float cutoff) {
  if (std::min(a, b) >= cutoff) return 1.0f;
  if (std::max(a, b) < cutoff) return 0.0f;
  return (std::max(a, b) - cutoff) / std::abs(a - b);
}

// Part of a bilinear patch with these corners that reaches the cutoff. It is linear along lines; they run the way it
// is steeper, so that straight edges count exactly.
float reached(float a, float b, float c, float d, float cutoff) {
  const auto [low, high] = std::minmax({a, b, c, d});
  if (low >= cutoff) return 1.0f;
  if (high < cutoff) return 0.0f;
  if (std::abs(c + d - a - b) > std::abs(b + d - a - c)) std::swap(b, c);
  float sum = 0.0f;
  for (int i = 0; i < kLines; ++i) {
    const float t = (static_cast<float>(i) + 0.5f) / kLines;
    sum += reached(a * (1 - t) + c * t, b * (1 - t) + d * t, cutoff) / kLines;
  }
  return sum;
}

// The texels around one.
struct Around {
  glm::vec4 texel[3][3];  // row, column

  // In four quarters, each a part of the patch between four texels' centres.
  float kept(float cutoff) const {
    float sum = 0.0f;
    for (const int v : {0, 2})
      for (const int u : {0, 2}) {
        const float centre = texel[1][1].a, beside = 0.5f * (centre + texel[1][u].a),
                    above = 0.5f * (centre + texel[v][1].a),
                    corner = 0.25f * (centre + texel[1][u].a + texel[v][1].a + texel[v][u].a);
        sum += 0.25f * reached(centre, beside, above, corner, cutoff);
      }
    return sum;
  }
  // Filtered over the middle one's area, weighted by alpha.
  glm::vec3 colour() const {
    constexpr float kShares[3] = {0.125f, 0.75f, 0.125f};
    glm::vec3 sum(0.0f);
    float alpha = 0.0f;
    for (int v = 0; v < 3; ++v)
      for (int u = 0; u < 3; ++u) {
        const float share = kShares[v] * kShares[u] * texel[v][u].a;
        sum += share * glm::vec3(texel[v][u]);
        alpha += share;
      }
    return alpha > 0.0f ? sum / alpha : glm::vec3(texel[1][1]);
  }
};

// Alpha of a level at a place in its texels.
class Reader {
 public:
  Reader(const Image<glm::vec4>& level, const Sampling& sampling) : level_(level), sampling_(sampling) {}
  float at(glm::dvec2 place) const {
    const glm::dvec2 from = glm::floor(place - 0.5);
    const glm::vec2 part(place - 0.5 - from);
    const auto alpha = [&](int dx, int dy) {
      return level_
          .at(across(static_cast<int>(from.x) + dx, level_.width(), sampling_.wrapS),
              across(static_cast<int>(from.y) + dy, level_.height(), sampling_.wrapT))
          .a;
    };
    const float upper = glm::mix(alpha(0, 0), alpha(1, 0), part.x), lower = glm::mix(alpha(0, 1), alpha(1, 1), part.x);
    return glm::mix(upper, lower, part.y);
  }
  glm::dvec2 size() const { return {level_.width(), level_.height()}; }

 private:
  const Image<glm::vec4>& level_;
  const Sampling& sampling_;
};

// Coverage of a sample one step wide, as the pass draws it: with the rim that differences to its neighbours give.
template <class Alpha>
float coverage(const Alpha& alpha, glm::dvec2 place, double step, float cutoff) {
  const float here = alpha(place), beside = alpha(place + glm::dvec2(step, 0)),
              below = alpha(place + glm::dvec2(0, step));
  return shading::rimCoverage(here, cutoff, std::abs(beside - here) + std::abs(below - here));
}

// Whether a level shows the pattern to samples one of its texels wide, alone and mixed with the level before it.
//   kept  what the cut leaves of the finest level under each texel
bool holds(const Image<glm::vec4>& finer, const Image<glm::vec4>& level, const Image<glm::vec4>& kept, double wanted,
           float cutoff, const Sampling& sampling) {
  const Reader coarse(level, sampling), fine(finer, sampling);
  const glm::dvec2 scale = fine.size() / coarse.size();
  const auto alone = [&](glm::dvec2 place) { return coarse.at(place); };
  const auto mixed = [&](glm::dvec2 place) { return 0.5f * (coarse.at(place) + fine.at(place * scale)); };
  double bare = 0.0, mean = 0.0, meanMixed = 0.0, off = 0.0;  // bare: without rims, which several passes make narrow
  for (int i = 0; i < kReads; ++i) {
    // Steps of the plastic number fill the square evenly, with no period that a pattern could share.
    const glm::dvec2 place = glm::fract(glm::dvec2(0.7548776662466927, 0.5698402909980532) * (i + 1.0)) * coarse.size();
    const double step = i % 2 == 0 ? 1.0 : -1.0;
    bare += alone(place) >= cutoff ? 1.0 : 0.0;
    mean += static_cast<double>(coverage(alone, place, step, cutoff));
    meanMixed += static_cast<double>(coverage(mixed, place, step * std::sqrt(0.5), cutoff));
    const glm::dvec2 centre = glm::floor(place) + 0.5;
    const float under = kept.at(static_cast<int>(centre.x), static_cast<int>(centre.y)).a;
    off += static_cast<double>(std::abs(coverage(alone, centre, step, cutoff) - under));
  }
  const auto isRight = [&](double sum) { return std::abs(sum / kReads - wanted) <= kMostOffInTheMean; };
  return isRight(bare) && isRight(mean) && isRight(meanMixed) && off / kReads <= kMostOffInATexel;
}

double meanAlpha(const Image<glm::vec4>& texels) {
  double sum = 0.0;
  for (std::size_t i = 0; i < texels.size(); ++i) sum += static_cast<double>(texels[i].a);
  return sum / static_cast<double>(texels.size());
}

}  // namespace

Image<glm::vec4> keptTexels(const Image<glm::vec4>& texels, float cutoff, const Sampling& sampling) {
  Image<glm::vec4> kept = texels;
  tbb::parallel_for(0, texels.height(), [&](int y) {
    for (int x = 0; x < texels.width(); ++x) {
      glm::vec4& out = kept.at(x, y);
      if (sampling.nearest) {
        out.a = out.a >= cutoff ? 1.0f : 0.0f;
        continue;
      }
      Around around;
      for (int v = 0; v < 3; ++v)
        for (int u = 0; u < 3; ++u)
          around.texel[v][u] = texels.at(across(x + u - 1, texels.width(), sampling.wrapS),
                                         across(y + v - 1, texels.height(), sampling.wrapT));
      out.a = around.kept(cutoff);
      if (texels.at(x, y).a < 1.0f) out = glm::vec4(around.colour(), out.a);
    }
  });
  return kept;
}

std::vector<Image<glm::vec4>> averagedLevels(const Image<glm::vec4>& texels) {
  std::vector<Image<glm::vec4>> levels{texels};
  while (levels.back().size() > 1) levels.push_back(halved(levels.back()));
  return levels;
}

MaskLevels maskLevels(std::vector<Image<glm::vec4>> tested, float cutoff, const Sampling& sampling) {
  MaskLevels mask;
  mask.levels = std::move(tested);
  Image<glm::vec4> kept = keptTexels(mask.levels[0], cutoff, sampling);
  const double wanted = meanAlpha(kept);
  bool resolved = true;
  for (std::size_t i = 1; i < mask.levels.size(); ++i) {
    kept = halved(kept);
    resolved = resolved && holds(mask.levels[i - 1], mask.levels[i], kept, wanted, cutoff, sampling);
    if (resolved)
      mask.resolved = static_cast<int>(i);
    else
      mask.levels[i] = kept;
  }
  return mask;
}

}  // namespace pellucid
