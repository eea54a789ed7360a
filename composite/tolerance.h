// The error a user can live with, guaranteed: samples of pixels whose weighted mean provably lies near enough keep it,
// the others are composited exactly. MODEL section 9
#pragma once
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "composite/methods/method.h"
#include "composite/veil.h"
#include "gbuffer/accum.h"
#include "gbuffer/fragments.h"

namespace pellucid {

struct ToleranceCounts {
  std::size_t certified = 0, recomputed = 0;  // touched pixels, each pass anew
  double bound = 0.0;                         // largest bound of a pixel's error, as a part of what is promised of it
  std::optional<double> measured;             // largest error against the truth, likewise
};

// Where the light of a pixel's layers lies in the truth, per channel, whatever their order: that of layers that hide
// is a mean of U = C / o times what they hide together, that of light that adds lies between beta of it and all of it.
struct LightRange {
  glm::dvec3 least, most;
};
LightRange lightRangeOf(const std::vector<MethodLayer>& layers);

// What is promised of a picture that is the mean of N passes: |x - truth| <= E * max(1, |truth|) for every pixel and
// channel. The bounds of a pixel's passes add up to N times that of its mean, so each pixel has an account: a pass may
// show an estimate while the sum of all bounds stays below E times the larger of N and the least that the truths of
// its passes add up to.
class PromisedError {
 public:
  // Of a pass whose truth may be anything: nothing is relative to it.
  static constexpr double kUnknown = -std::numeric_limits<double>::infinity();

  //   pixels  of the data window, or the places of a deep picture; a number beyond them has no account, and is exact
  PromisedError(std::size_t pixels, double tolerance, int passes);
  // What one value may be off by rounding alone, relative: floats of the veils and of their mean, here and in the
  // truth.
  double rounding() const { return rounding_; }

  // Whether an estimate that is off by `bound` at most may stand in a pixel's pass; if so, it is booked.
  //   least  of the truth of this pass, per channel, or kUnknown
  bool allows(std::size_t pixel, const glm::dvec3& bound, const glm::dvec3& least);
  // Books a pass that shows the truth.
  void bookExact(std::size_t pixel, const glm::dvec3& truth);
  // After all passes. False where a truth has become less than it was known to be (negative light, lookups): such
  // pixels are exact from now on, and all passes are to be made again.
  bool settle();
  double largestBound() const { return largest_; }  // after settle(), as a part of what is promised

 private:
  struct Account {
    glm::vec3 spent{0.0f}, least{0.0f};  // sums over passes, rounded away from what they must not exceed
    bool exact = false;
  };
  double limit(double least) const;
  std::vector<Account> accounts_;
  double tolerance_, rounding_, passes_, largest_ = 0.0;
};

// One pass of a picture, as far as its lists go.
struct WithinInput {
  const FragmentLists& lists;
  const MethodChoice& choice;
  const Window& data;                                // of the veil; the lists' window lies inside
  const Image<glm::vec4>* background = nullptr;      // of `data`; null: not known, so that nothing is relative to it
  const OitPlanes* scatter = nullptr;                // which pixels look the background up elsewhere, or null
  const Image<float>* weight = nullptr;              // of the pass in each pixel's mean, of `data`; null: 1
  const std::vector<std::size_t>* places = nullptr;  // the account of each entry; null: pixels of `data`, row by row
};
// Writes the veil of the lists' window; transmission is exact.
void compositeWithin(const WithinInput& input, PromisedError& promised, Veil& veil, ToleranceCounts& counts);

// The largest |x - truth| / (tolerance * max(1, |truth|)) over finite values; 0 where both are equal.
double brokenPart(const Image<glm::vec4>& picture, const Image<glm::vec4>& truth, double tolerance);

}  // namespace pellucid
