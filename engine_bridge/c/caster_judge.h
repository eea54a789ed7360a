// Whether what a host asks of shadow maps can be kept, as far as numbers tell: one sentence for each thing that cannot.
// Textures and what a device has: caster_checks.h
#pragma once
#include <climits>
#include <cstddef>

#include "engine_bridge/include/pellucid/pellucid.h"

namespace pellucid::c {

constexpr int kMostFaces = 96;

// Which call asks, and where the sentence goes. Nothing is allocated.
struct CasterJudge {
  const char* call;
  char* message;
  std::size_t size;

  // The sentence begins with the call.
  [[gnu::format(printf, 3, 4)]] pld_status fail(pld_status status, const char* format, ...) const;
};

// Of textures.
struct TexelLimits {
  int edge = 16384, layers = INT_MAX;
};
pld_status judgeMaps(const CasterJudge& judge, const pld_shadow_info& info, const TexelLimits& limits);
//   room  of the maps
pld_status judgeView(const CasterJudge& judge, const pld_shadow_info& room, const pld_shadow_view& view);

}  // namespace pellucid::c
