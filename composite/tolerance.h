// The error a user can live with, guaranteed: pixels whose weighted mean provably lies within it keep it, the others
// are composited exactly. MODEL section 9
#pragma once
#include <cstddef>

#include "composite/methods/method.h"
#include "composite/veil.h"
#include "gbuffer/accum.h"
#include "gbuffer/fragments.h"

namespace pellucid {

struct ToleranceCounts {
  std::size_t certified = 0, recomputed = 0;  // touched pixels
};

// Largest possible |weighted - sorted| of a pixel, per channel: truth and estimate are means of the same U = C / o, so
// they differ by at most (1 - beta)(Umax - Umin), and additive light by (1 - beta) of it. Includes a bound on the
// rounding of the float sums.
glm::dvec3 errorBound(const std::vector<MethodLayer>& layers);

// |x - truth| <= tolerance * max(1, |x|) for every pixel and channel x of the picture over `background`, without its
// own rounding to float. Writes the veil of the lists' window, which lies inside `data`; transmission is exact.
//   background  planes of `data`, or null: not known, so that the error stays below `tolerance` whatever it is
//   scatter     says which pixels look the background up elsewhere, where it is not known yet; or null
void compositeWithin(const FragmentLists& lists, const MethodChoice& choice, const Window& data,
                     const Image<glm::vec4>* background, const OitPlanes* scatter, double tolerance, Veil& veil,
                     ToleranceCounts& counts);

}  // namespace pellucid
