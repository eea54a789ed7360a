// What is done for a picture, decided before anything is painted: a pure function of the request and of what the shot
// holds. Everything below it obeys; nothing below it decides.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "composite/pipeline/facts.h"
#include "composite/pipeline/request.h"
#include "composite/resolve.h"

namespace pellucid {

// How the layers become a veil.
enum class Route {
  drawnSums,        // the device blends the sums, which are then resolved
  foldedSums,       // the sums are added from fragment lists, then resolved
  lists,            // a mixer takes each pixel's fragment list
  samplesOnDevice,  // the device draws stochastic samples
  systems,          // a pass for each system, the nearer veils over the farther ones
};
const char* nameOf(Route route);

struct Plan {
  std::string method;
  std::string methodReason;  // where nobody asked for one
  Paint paint = PaintSorted{};
  Route route = Route::lists;
  Tier tier = Tier::float32;
  PassSettings pass;         // of every pass; the light, and where in the pixel, are still to come
  bool fitsWeight = false;   // the weight above is only where the fit starts
  std::string weightReason;  // where nobody asked for the fit
  ResolveSettings resolve;
  LookupSettings lookup;
  bool resolvesOnDevice = false;
  bool heldOut = false;    // the picture is deep: each of its samples holds layers out on its own
  bool deepFiles = false;  // among the layers
  bool fog = false;
  int passes = 1;                  // jittered
  PixelFilter pixelFilter;         // that they are drawn from
  int supersampled = 1;            // N: the result's pixels are means of N x N of the picture's
  std::optional<Shutter> shutter;  // as asked for, or as the picture's header has it
  bool pictureMoves = false;       // from pass to pass: the camera moves, or a lens is open
  bool edges = false;              // filtered edges of the picture are taken apart
  int lowResolution = 1;           // pixels per texel of marked materials
  // Of sums that resolve as a method which counts its layers, the method: fog enters them in runs, and what is drawn at
  // low resolution as layers that it has composited, as in its own lists.
  std::optional<ChosenMethod> counts;
  std::uint64_t bytes = 0;         // held at once besides the picture, about
  std::vector<std::string> notes;  // what was left out or done otherwise than asked, and why: one sentence each

  template <class Kind>
  const Kind* as() const {
    return std::get_if<Kind>(&paint);
  }
  // From pass to pass: what shows in one pass may stand elsewhere in the next.
  bool layersMove() const { return pictureMoves || (shutter && shutter->opens()); }
  bool isExact() const { return tier == Tier::exact; }
  bool isPublished() const { return tier == Tier::published; }
};

// Throws UsageError for what the shot cannot honour; what no shot can, validate() has refused.
Plan planFor(const Request& request, const ShotFacts& facts);

// The plan of the truth that --measure compares with: the same, sorted.
Plan truthOf(const Plan& plan);

// The plan of the sums alone, whatever paints: for `accumulate` and the debug layers. Those of a request for the truth
// are the phenomenological ones.
Plan sumsPlanOf(const Plan& plan, const ShotFacts& facts);

// Pass `index` of the plan's: where in the pixel, and how much of it that place stands for where the filter weighs
// most.
PassSettings samplePass(const PassSettings& pass, const Plan& plan, int index);

// One line per decision, for --explain and --stats.
std::vector<std::string> describe(const Plan& plan, const ShotFacts& facts);

}  // namespace pellucid
