// The table of methods. A method from fragment lists costs its own file and one row here.
#include "composite/methods/method.h"

namespace pellucid {

LayerMix mixAverage(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixBlended(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixFrontTail(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixListing3(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixListing4(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixMlab(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixMoments(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixMonochrome(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixSum(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixUnsorted(const std::vector<MethodLayer>&, const MethodChoice&);
LayerMix mixWavelet(const std::vector<MethodLayer>&, const MethodChoice&);

namespace {

constexpr int kFloat = 32, kHalf = 16;

using enum MethodKind;

std::vector<Method> rows() {
  return {
      {.name = "over",
       .kind = sorted,
       .help = "every layer sorted and composited: exact, in bounded memory; the others are measured against it",
       .source = "Porter, Duff 1984",
       .precision = "double",
       .passes = 2},
      {.name = "phenomenological",
       .kind = planes,
       .help = "weighted sums per channel, in one pass of any order: what an engine draws, and accumulate",
       .source = "PT17",
       .precision = "float",
       .isSum = true,
       .weighs = true,
       .normalises = true,
       .takesPublished = true},
      {.name = "stochastic",
       .kind = stochastic,
       .help =
           "random samples of every pixel: right on the average in any order, with noise that --samples pushes down",
       .source = "ST10",
       .precision = "double",
       .variants = "basic|alpha|depth"},
      {.name = "sum",
       .kind = listed,
       .help = "light of all layers added, right to first order only",
       .source = "WB13 eq. 3 (Meshkin 2007)",
       .precision = "double",
       .mix = mixSum,
       .passes = 1,
       .bits = [](int) { return 6 * kFloat; },
       .isSum = true},
      {.name = "average",
       .kind = listed,
       .help = "as many equal layers of the mean opacity",
       .source = "WB13 eq. 4 (Bavoil, Myers 2008)",
       .precision = "double",
       .mix = mixAverage,
       .passes = 1,
       .bits = [](int) { return 7 * kFloat; },
       .isSum = true},
      {.name = "blended",
       .kind = planes,
       .help = "the mean colour of the layers over the exactly dimmed background",
       .source = "WB13 eq. 5",
       .precision = "float",
       .mix = mixBlended,
       .passes = 1,
       .bits = [](int) { return 9 * kFloat; },
       .isSum = true},
      {.name = "weighted",
       .kind = planes,
       .help = "the same mean, nearer layers weighing more",
       .source = "WB13 eq. 6",
       .precision = "float",
       .mix = mixWeighted,
       .passes = 1,
       .bits = [](int) { return 20 * kFloat; },
       .isSum = true,
       .weighs = true,
       .normalises = true},
      {.name = "listing3",
       .kind = listed,
       .help = "eq. 6 as printed, in half floats with one coverage for all channels",
       .source = "WB13 listing 3",
       .precision = "half",
       .mix = mixListing3,
       .passes = 1,
       .bits = [](int) { return 5 * kHalf; },
       .weighs = true},
      {.name = "listing4",
       .kind = listed,
       .help = "listing 3 with one blend function for both targets",
       .source = "WB13 listing 4: one blend function",
       .precision = "half",
       .mix = mixListing4,
       .passes = 1,
       .bits = [](int) { return 5 * kHalf; },
       .weighs = true},
      {.name = "monochrome",
       .kind = listed,
       .help = "listing 4 in one target, for grey layers",
       .source = "WB13: one target",
       .precision = "half",
       .mix = mixMonochrome,
       .passes = 1,
       .bits = [](int) { return 4 * kHalf; },
       .weighs = true},
      {.name = "unsorted",
       .kind = listed,
       .help = "what a renderer that never sorts shows",
       .source = "over in the order submitted",
       .precision = "double",
       .mix = mixUnsorted,
       .passes = 1,
       .bits = [](int) { return 6 * kFloat; },
       .takesExact = false},
      {.name = "front+tail",
       .kind = listed,
       .help = "the nearest layer exactly, over the weighted mean of the others",
       .source = "exact nearest layer over eq. 6",
       .precision = "float",
       .mix = mixFrontTail,
       .passes = 2,
       .bits = [](int) { return 27 * kFloat; },
       .weighs = true,
       .normalises = true},
      {.name = "wavelet",
       .kind = listed,
       .help = "transmittance in front of each layer from Haar coefficients of rank R",
       .source = "Aizenshtein, Smal, McGuire 2022",
       .precision = "double",
       .mix = mixWavelet,
       .passes = 3,
       .bits = [](int rank) { return (3 * (2 << rank) + 2 + 9) * kFloat; },
       .order = {"R", 2, 0, 6, false}},
      {.name = "moments",
       .kind = listed,
       .help = "transmittance in front of each layer from M power moments of depth",
       .source = "Münstermann et al. 2018",
       .precision = "double",
       .mix = mixMoments,
       .passes = 3,
       .bits = [](int moments) { return (3 * (moments + 1) + 2 + 6) * kFloat; },
       .order = {"M", 4, 4, 8, true}},
      {.name = "mlab",
       .kind = listed,
       .help = "the K nearest layers exactly, the others blended into them as they come",
       .source = "Salvi, Vaidyanathan 2014",
       .precision = "double",
       .mix = mixMlab,
       .passes = 1,
       .bits = [](int layers) { return 7 * layers * kFloat; },
       .order = {"K", 4, 1, 64, false}},
  };
}

}  // namespace

const std::vector<Method>& allMethods() {
  static const std::vector<Method> table = rows();
  return table;
}

}  // namespace pellucid
