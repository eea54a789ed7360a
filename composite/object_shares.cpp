#include "composite/object_shares.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "gbuffer/object_coverage.h"

namespace pellucid {
namespace {

constexpr int kClearly = 3;  // so many times as many pixels of one side as of the other show an object of that side

struct Objects {
  std::vector<std::uint32_t> own, beside;
};

// Which objects show on either side, by the pixels about that mostly show them. Nothing where one shows on both, as
// before itself.
std::optional<Objects> objectsBeside(const ObjectCoverage& coverage, const SurfaceSides& sides, int x, int y,
                                     Side other) {
  struct Votes {
    std::uint32_t object;
    int own, beside;
  };
  std::vector<Votes> votes;
  for (int v = y - 2; v <= y + 2; ++v)
    for (int u = x - 2; u <= x + 2; ++u) {
      const Side side = sides.inside(u, v) ? sides.sideOf(x, y, u, v) : Side::own;
      if (!sides.inside(u, v) || (side != Side::own && side != other)) continue;
      const std::uint32_t object = coverage.mostOf(u, v);
      auto vote = std::find_if(votes.begin(), votes.end(), [&](const Votes& one) { return one.object == object; });
      if (vote == votes.end()) vote = votes.insert(vote, {object, 0, 0});
      ++(side == Side::own ? vote->own : vote->beside);
    }
  Objects objects;
  for (const Votes& vote : votes) {
    // A pixel across the edge may mostly show what its centre does not.
    if (kClearly * std::min(vote.own, vote.beside) > std::max(vote.own, vote.beside)) return std::nullopt;
    (vote.own > vote.beside ? objects.own : objects.beside).push_back(vote.object);
  }
  return objects;
}

}  // namespace

std::optional<double> nearerShare(const GBuffer& gbuffer, const SurfaceSides& sides, int x, int y, Side other) {
  if (!gbuffer.objects) return std::nullopt;
  const std::optional<Objects> objects = objectsBeside(*gbuffer.objects, sides, x, y, other);
  if (!objects) return std::nullopt;
  const double own = gbuffer.objects->coverage(x, y, objects->own);
  const double beside = gbuffer.objects->coverage(x, y, objects->beside);
  if (!(own + beside > 0.0)) return std::nullopt;
  return (other == Side::nearer ? beside : own) / (own + beside);
}

}  // namespace pellucid
