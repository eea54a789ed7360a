#include "composite/antialias.h"

namespace pellucid {
namespace {

constexpr double kFour[4][2] = {{0.7043, 0.8568}, {0.7643, 0.3808}, {0.2953, 0.1428}, {0.2363, 0.6198}};
constexpr double kEight[8][2] = {{0.3792, 0.8854}, {0.1542, 0.2974}, {0.1312, 0.6824}, {0.7913, 0.1754},
                                 {0.7562, 0.8224}, {0.4202, 0.1224}, {0.8722, 0.5144}, {0.4952, 0.5004}};
constexpr double kSixteen[16][2] = {{0.9203, 0.3921}, {0.4753, 0.7091}, {0.8482, 0.1951}, {0.8982, 0.9261},
                                    {0.3843, 0.9151}, {0.6703, 0.0921}, {0.3763, 0.4951}, {0.1843, 0.8421},
                                    {0.4713, 0.1791}, {0.3073, 0.2251}, {0.8382, 0.6331}, {0.0683, 0.6751},
                                    {0.0623, 0.0881}, {0.6963, 0.7751}, {0.6422, 0.4271}, {0.1573, 0.4301}};

double radicalInverse2(unsigned bits) {
  double value = 0.0, digit = 0.5;
  for (; bits; bits >>= 1u, digit *= 0.5)
    if (bits & 1u) value += digit;
  return value;
}

}  // namespace

glm::dvec2 samplePosition(int index, int count) {
  if (count <= 1) return {0.5, 0.5};
  const double* set = count == 4 ? kFour[index] : count == 8 ? kEight[index] : count == 16 ? kSixteen[index] : nullptr;
  if (set) return {set[0], set[1]};
  // Half a step inwards in both, so that the mean is the centre for powers of two.
  int padded = 1;
  while (padded < count) padded *= 2;
  return {(index + 0.5) / count, radicalInverse2(static_cast<unsigned>(index)) + 0.5 / padded};
}

glm::dvec2 samplePosition(int index, int count, const PixelFilter& filter) {
  const glm::dvec2 even = samplePosition(index, count);
  return count <= 1 ? even : filter.placed(even);
}

}  // namespace pellucid
