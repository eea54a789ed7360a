// The precision tiers of the sums, a row each: what --precision takes, what files of planes say, and what is promised.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace pellucid {

enum class Tier { published, float32, exact };

struct PrecisionTier {
  Tier tier;
  const char* name;  // of --precision, and of the header of planes
  // Of the sums, a pixel, in the full model, before planes that nothing needs are left out; 0: lists of every fragment
  // are kept instead, whose size is the scene's.
  int bits;
  const char* promise;
};

inline constexpr std::array kTiers{
    PrecisionTier{Tier::published, "published", 112,
                  "the papers' 112 bits a pixel (88 where no layer is coloured), normalisation and self-modulation, "
                  "with their losses; clamped values are counted"},
    PrecisionTier{Tier::float32, "float", 960,
                  "32-bit float planes: the CPU and GL have the same bits for the same fragments in the same order"},
    PrecisionTier{Tier::exact, "exact", 0,
                  "the same bits for every order, chunk, tile and thread count, within 1e-6 of the true sum"},
};

constexpr std::optional<Tier> tierNamed(std::string_view name) {
  for (const PrecisionTier& row : kTiers)
    if (name == row.name) return row.tier;
  return std::nullopt;
}

constexpr const PrecisionTier& tierRow(Tier tier) {
  return kTiers[static_cast<std::size_t>(tier)];
}

static_assert(tierRow(Tier::published).tier == Tier::published && tierRow(Tier::float32).tier == Tier::float32 &&
              tierRow(Tier::exact).tier == Tier::exact);

}  // namespace pellucid
