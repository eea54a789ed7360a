// What of a texel is seen where not all of it is: parts of shaders/shared/spread_pyramid.glsl for eight texels at once.
// Whoever includes this compiles it into a function of PLD_CLONES.
#pragma once
#include "composite/lanes.h"
#include "composite/spread_pyramid.h"

namespace pellucid::shading {

// Eight texels of a column.
struct TexelLanes {
  const float* first;  // number of the first plane of the upper one
  std::size_t stride;  // from a plane to the next
  void load(int plane, lanes::Float8& to) const { lanes::load(first + static_cast<std::size_t>(plane) * stride, to); }
};

// Four of a column, and four of the next.
struct TwoColumns {
  const float *first, *second;
  std::size_t stride;
  void load(int plane, lanes::Float8& to) const {
    const std::size_t from = static_cast<std::size_t>(plane) * stride;
    lanes::loadTwo(first + from, second + from, to);
  }
};

// GLM's, whose choice between equal numbers is kept.
inline void clampLanes(const lanes::Float8& x, const lanes::Float8& least, const lanes::Float8& most,
                       lanes::Float8& result) {
  const lanes::Float8 above = x < least ? least : x;
  result = most < above ? most : above;
}

// withinReach()
inline void withinLanes(const lanes::Float8& reach, const lanes::Float8& away, float edge, lanes::Float8& part) {
  const lanes::Float8 raw = (reach - away) * (0.5f / (PLD_SPREAD_PARTS * edge)) + 0.5f;
  clampLanes(raw, lanes::Float8{}, lanes::Float8{} + 1.0f, part);
}

// isCut()
inline void cutLanes(const lanes::Float8& least, const lanes::Float8& most, const lanes::Float8& before,
                     const lanes::Float8& behind, lanes::Int8& cut) {
  cut = ((least > before) & (least < behind)) | ((most > before) & (most < behind));
}

// Texels of two sorts, told apart by a moment: what of each number is of the sort that has the most.
struct SortedLanes {
  lanes::Float8 least, most, span;
  lanes::Int8 two;
  // sum, moment  over both sorts
  void mostOf(const lanes::Float8& sum, const lanes::Float8& moment, const lanes::Float8& low,
              const lanes::Float8& high, lanes::Float8& result) const {
    lanes::Float8 part;
    clampLanes((moment - least * sum) * span, low, high, part);
    result = two ? part : sum;
  }
};

// The colour and the mass of passingPart(), into `sums`.
//   away  from the centre to the texels', pixels
template <class Texels>
inline void passingLanes(const Texels& texels, const lanes::Float8& away, float edge, float rateLimit,
                         lanes::Float8 (&sums)[kSpreadSums]) {
  using lanes::Float8;
  SortedLanes reach, rate;
  texels.load(kLeastReach, reach.least);
  texels.load(kMostReach, reach.most);
  texels.load(kLeastRate, rate.least);
  texels.load(kMostRate, rate.most);
  Float8 low, high;
  withinLanes(reach.least, away, edge, low);
  withinLanes(reach.most, away, edge, high);
  const lanes::Int8 cut = low<1.0f, nearer = rate.most> rateLimit;
  reach.two = reach.least < reach.most;
  reach.span = 1.0f / (reach.most - reach.least);
  rate.two = (rate.least < rate.most) & (rateLimit >= rate.least);
  rate.span = 1.0f / (rate.most - rate.least);
  Float8 mass, kept;
  texels.load(kSpreadMass, mass);
  for (int k = kSpreadMass; k >= 0; --k) {  // the mass first: what is kept of it is kept of the colours
    const bool ofMass = k == kSpreadMass;
    Float8 sum, byReach, byRate, most, front;
    texels.load(k, sum);
    texels.load(ofMass ? int(kReachMass) : int(kReachColour) + k, byReach);
    texels.load(ofMass ? int(kRateMass) : int(kRateColour) + k, byRate);
    Float8 least{}, all = sum;
    if (!ofMass) {
      least = Float8{} < sum ? Float8{} : sum;
      all = sum < 0.0f ? Float8{} : sum;
    }
    reach.mostOf(sum, byReach, least, all, most);
    rate.mostOf(sum, byRate, least, all, front);
    const Float8 within = cut ? low * (sum - most) + high * most : sum;
    if (ofMass) kept = within / mass;
    sums[k] = nearer ? kept * (sum - front) : within;
  }
}

}  // namespace pellucid::shading
