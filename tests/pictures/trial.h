// One random picture: drawn, composited by the program's own library, and held against the reference.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "composite/pipeline/kept_work.h"
#include "tests/pictures/statement.h"

namespace pellucid::test {

// Of pixels of one sort.
struct Tally {
  std::size_t pixels = 0, beyond = 0;
  double worst = 0.0;    // the largest error as a part of what is stated
  double largest = 0.0;  // of any channel, whatever is stated
  void add(const Tally& other);
};
using Tallies = std::array<Tally, static_cast<std::size_t>(Judged::count)>;

struct Outcome {
  std::string kind;
  Tallies tallies;
  std::string refusal;  // what the program said where it made no picture
  std::string worst;    // the pixel that differs most, in words; "" where none does
  bool right() const;
};

struct Trial {
  std::string kind;
  std::uint64_t seed = 0;
};
// Draws the trial's scene and flags, and goes on as below.
Outcome runTrial(const Trial& trial, const std::string& folder, const std::shared_ptr<KeptWork>& kept);
// Writes into `folder` opaque.exr, glass.glb and `command`, and where the picture differs out.exr and right.exr: what
// is right, and in the layer `allowed` how far off it sampling may lead.
Outcome compositeAndJudge(const DrawnScene& scene, const DrawnFlags& flags, const std::string& folder,
                          const std::shared_ptr<KeptWork>& kept);

// What the rays of the passes meet in a pixel, by the reference: to look for the cause of a difference.
std::string raysOf(const Trial& trial, int x, int y);

// Row by row: kind, pictures, and of every sort of pixels how many, the worst error over what is stated, and how many
// are beyond it.
std::string tableOf(const std::vector<Outcome>& outcomes);

}  // namespace pellucid::test
