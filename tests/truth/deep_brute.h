// The unshared voice for deep pixels: OpenEXR's pairwise rules, in long double, over every elementary interval.
// Includes nothing of composite/.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pellucid::test {

struct BruteSample {
  long double z = 0, zBack = 0;
  std::array<long double, 4> light{}, opacity{};  // R, G, B, A
};

using BruteFlat = std::array<std::array<long double, 4>, 2>;  // light, opacity

inline void brutePair(long double& c1, long double& a1, long double c2, long double a2) {
  // "Interpreting Deep Pixels", mergeOverlappingSamples
  a1 = std::clamp(a1, 0.0L, 1.0L);
  a2 = std::clamp(a2, 0.0L, 1.0L);
  const long double am = a1 == 1 || a2 == 1 ? 1 : a1 + a2 - a1 * a2;  // the sum would round beside 1
  if (a1 == 1 && a2 == 1) {
    c1 = (c1 + c2) / 2;
  } else if (a1 == 1) {
  } else if (a2 == 1) {
    c1 = c2;
  } else {
    const long double u1 = -std::log1p(-a1), u2 = -std::log1p(-a2);
    const long double v1 = a1 > 0 ? u1 / a1 : 1, v2 = a2 > 0 ? u2 / a2 : 1;
    const long double u = u1 + u2, w = u > 0 ? am / u : 1;
    c1 = (c1 * v1 + c2 * v2) * w;
  }
  a1 = am;
}

inline BruteFlat bruteFlatten(const std::vector<BruteSample>& samples) {
  std::vector<long double> edges;
  for (const BruteSample& s : samples) {
    edges.push_back(s.z);
    edges.push_back(s.zBack);
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  BruteFlat flat{};
  std::array<long double, 4> left{1, 1, 1, 1};
  const auto over = [&](const std::vector<BruteSample>& parts) {
    if (parts.empty()) return;
    BruteSample merged = parts[0];
    for (std::size_t i = 1; i < parts.size(); ++i)
      for (std::size_t c = 0; c < 4; ++c)
        brutePair(merged.light[c], merged.opacity[c], parts[i].light[c], parts[i].opacity[c]);
    for (std::size_t c = 0; c < 4; ++c) {
      flat[0][c] += left[c] * merged.light[c];
      left[c] *= 1 - merged.opacity[c];
    }
  };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    std::vector<BruteSample> points, stretches;
    for (const BruteSample& s : samples) {
      if (s.zBack <= s.z && s.z == edges[e]) points.push_back(s);
      if (e + 1 < edges.size() && s.zBack > s.z && s.z <= edges[e] && s.zBack >= edges[e + 1]) {
        BruteSample part = s;
        const long double x = (edges[e + 1] - edges[e]) / (s.zBack - s.z);
        for (std::size_t c = 0; c < 4; ++c) {
          part.opacity[c] = s.opacity[c] >= 1 ? 1 : -std::expm1(x * std::log1p(-s.opacity[c]));
          part.light[c] = s.opacity[c] > 0 ? s.light[c] * part.opacity[c] / s.opacity[c] : s.light[c] * x;
        }
        stretches.push_back(part);
      }
    }
    over(points);
    over(stretches);
  }
  for (std::size_t c = 0; c < 4; ++c) flat[1][c] = 1 - left[c];
  return flat;
}

}  // namespace pellucid::test
