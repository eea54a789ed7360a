#include "composite/wide_resolve.h"

#include <cmath>

#include "composite/lanes.h"

namespace pellucid {

using lanes::Float8;
using lanes::Int8;
using lanes::kLanes;

namespace {

// Eight pixels of a plane, number by number.
inline void loadPixels(const glm::vec4* pixels, Float8 (&numbers)[4]) {
  Float8 pairs[4];
  for (int k = 0; k < 4; ++k) lanes::load(&pixels[2 * k].x, pairs[k]);
  const Float8 a = __builtin_shufflevector(pairs[0], pairs[2], 0, 1, 2, 3, 8, 9, 10, 11);
  const Float8 b = __builtin_shufflevector(pairs[0], pairs[2], 4, 5, 6, 7, 12, 13, 14, 15);
  const Float8 c = __builtin_shufflevector(pairs[1], pairs[3], 0, 1, 2, 3, 8, 9, 10, 11);
  const Float8 d = __builtin_shufflevector(pairs[1], pairs[3], 4, 5, 6, 7, 12, 13, 14, 15);
  const Float8 ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 abHigh = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
  const Float8 cdHigh = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
  numbers[0] = __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13);
  numbers[1] = __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15);
  numbers[2] = __builtin_shufflevector(abHigh, cdHigh, 0, 1, 8, 9, 4, 5, 12, 13);
  numbers[3] = __builtin_shufflevector(abHigh, cdHigh, 2, 3, 10, 11, 6, 7, 14, 15);
}

// meanOf()
inline void meanOfThree(const Float8 (&colour)[4], Float8& mean) {
  mean = (colour[0] + colour[1] + colour[2]) * 0.333333343f;
}

// pldOneMinusPower()
inline void oneMinusPower(const Float8& x, const Float8& power, Float8& result) {
  const Float8 thin =
      x * (1.0f -
           x * (0.5f - x * (0.166666667f -
                            x * (0.0416666667f - x * (0.00833333333f - x * (0.00138888889f - x * 0.000198412698f))))));
  result = x < 0.35f ? thin : 1.0f - power;
}

// The sums of eight pixels, as OitPlanes hold them.
struct SumLanes {
  Float8 radiance[4], weight[4], opacity[4], depth[4], light[4], solid[4];
  SumLanes(const OitPlanes& planes, int x, int y) {
    loadPixels(planes.radiance.row(y) + x, radiance);
    loadPixels(planes.weight.row(y) + x, weight);
    loadPixels(planes.opacity.row(y) + x, opacity);
    loadPixels(planes.depth.row(y) + x, depth);
    loadPixels(planes.light.row(y) + x, light);
    loadPixels(planes.solid.row(y) + x, solid);
  }
};

// Ratio of the mean weights of light and occluders, and where there are both.
inline void lightRatio(const SumLanes& sums, Float8& ratio, Int8& both) {
  Float8 meanLight, meanHidden;
  meanOfThree(sums.light, meanLight);
  meanOfThree(sums.opacity, meanHidden);
  const Float8& opacityWeight = sums.radiance[3];
  both = (meanLight > 0.0f) & (meanHidden > 0.0f) & (opacityWeight > 0.0f);
  const Float8 raw = (sums.depth[3] / meanLight) / (opacityWeight / meanHidden);
  ratio = raw > 1e12f ? Float8{} + 1e12f : raw;
}

// resolveSums() and overBackground() of the solid, of one channel.
inline void resolveChannel(const SumLanes& sums, int c, const Float8& ratio, const Int8& both, const Int8& hasSolid,
                           Float8& transparent, Float8& transmission) {
  const Float8& tau = sums.depth[c];
  Float8 beta, net;
  lanes::expOf(-tau, beta);
  oneMinusPower(tau, beta, net);
  const Float8 mean = sums.weight[c] <= 0.0f ? Float8{} : sums.radiance[c] / sums.weight[c];
  const Float8 seen = beta + net * (ratio / (1.0f + ratio));
  const Float8 visible = both & (sums.opacity[c] > 0.0f) ? seen : Float8{} + 1.0f;
  const Float8 own = net * mean + visible * sums.light[c];
  transparent = hasSolid ? own + beta * sums.solid[c] : own;
  transmission = hasSolid ? Float8{} : beta;
}

// Puts eight pixels where something is into the veil.
inline void store(const float (&light)[3][kLanes], const float (&transmission)[3][kLanes], const float* frontZ,
                  const std::int32_t* there, int x, int y, Veil& veil) {
  for (int i = 0; i < kLanes; ++i) {
    if (!there[i]) continue;
    veil.light.at(x + i, y) = glm::vec3(light[0][i], light[1][i], light[2][i]);
    veil.transmission.at(x + i, y) = glm::vec3(transmission[0][i], transmission[1][i], transmission[2][i]);
    veil.frontZ.at(x + i, y) = frontZ[i];
    veil.touched.at(x + i, y) = 1;
  }
}

}  // namespace

PLD_CLONES int resolveWide(const OitPlanes& planes, int y, Veil& veil) {
  const int end = planes.data.width() / kLanes * kLanes;
  for (int x = 0; x < end; x += kLanes) {
    const SumLanes sums(planes, x, y);
    const Int8 hasSolid = (sums.solid[3] < INFINITY) & (sums.solid[3] > -INFINITY);
    const Int8 there = ~(sums.weight[3] == 0.0f) | hasSolid;
    if (!lanes::anyOf(there)) continue;
    Float8 ratio, front;
    Int8 both;
    lightRatio(sums, ratio, both);
    alignas(32) float light[3][kLanes], transmission[3][kLanes], frontZ[kLanes];
    for (int c = 0; c < 3; ++c) {
      Float8 own, passed;
      resolveChannel(sums, c, ratio, both, hasSolid, own, passed);
      lanes::store(own, light[c]);
      lanes::store(passed, transmission[c]);
    }
    lanes::load(planes.frontZ.row(y) + x, front);
    lanes::store(sums.solid[3] < front ? sums.solid[3] : front, frontZ);
    std::int32_t which[kLanes];
    std::memcpy(which, &there, sizeof which);
    store(light, transmission, frontZ, which, x, y, veil);
  }
  return end;
}

}  // namespace pellucid
