// One shot, drawn again and again in other orders, chunks and tiles: what changes, and how far the sums are from true.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid::test {

enum class Tier { exact, floats, published };
constexpr Tier kTiers[] = {Tier::exact, Tier::floats, Tier::published};
const char* nameOf(Tier tier);

struct OrderShot {
  Scene scene;
  GBuffer gbuffer;
  Camera camera;
  PassSettings settings;
};

struct OrderResult {
  std::uint64_t digest = 0;  // of the first drawing's planes: equal for every number of threads in `exact`
  std::uint64_t values = 0, pictureValues = 0, turns = 0;
  std::uint64_t leastChunks = 0, mostChunks = 0, mostTiles = 0;
  // Of the first drawing's planes against the long double sums of its fragments, where those are not 0.
  double worstError = 0, error99 = 0;
  // |a - b| / max(1, a) over the pictures of every tenth turn, and channels.
  double worstPictureChange = 0;
};

// Where the parts of a trial, which may be processes, mark what ever changed: one byte a value.
struct Marks {
  std::uint8_t* planes;
  std::uint8_t* picture;
};
// Most values that a picture of so many pixels marks.
constexpr std::size_t planeValues(std::size_t pixels) {
  return pixels * 32;
}

// Which turns a part plays. A turn's number decides its order, chunk size and tile size.
struct TurnRange {
  std::uint64_t first, last, step;
};

OrderResult runOrderTrial(TransparentPass& pass, const OrderShot& shot, Tier tier, const TurnRange& turns,
                          const Marks& marks);

}  // namespace pellucid::test
