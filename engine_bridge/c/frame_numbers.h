// Whether the numbers of a frame can be drawn by: one sentence for each thing that cannot. Textures: frame_checks.h
#pragma once
#include <cstddef>

#include "engine_bridge/c/pass_permutation.h"

namespace pellucid::c {

// All of pld_fixed.
constexpr uint32_t kEveryField = PLD_FIXED_UNITS | PLD_FIXED_EXPOSURE | PLD_FIXED_WEIGHT | PLD_FIXED_REFRACTION |
                                 PLD_FIXED_DIFFUSION | PLD_FIXED_PROJECTION | PLD_FIXED_LENS;

// A frame of any version that this one knows; false for a size that none had.
bool takeWhole(const pld_frame& frame, pld_frame& whole);

// By whom a frame is judged, and where the sentence goes. Nothing is allocated.
struct FrameJudge {
  const Permutation& permutation;
  uint32_t version;  // of the host's header: earlier hosts were asked less
  char* message;
  std::size_t size;

  bool isHostSince(uint32_t minor) const { return isSince(version, minor); }
  [[gnu::format(printf, 3, 4)]] pld_status fail(pld_status status, const char* format, ...) const;
};

// Those that `fields` (pld_fixed) names.
pld_status judgeNumbers(const FrameJudge& judge, const char* call, const pld_frame& frame, uint32_t fields);
// What was fixed is as it was.
//   by  who fixed it
pld_status judgeFixed(const FrameJudge& judge, const char* call, const char* by, const pld_frame& frame);
// The form of PLD_FEATURE_RIMS.
pld_status judgeOcclusion(const FrameJudge& judge, const char* call, const pld_frame& frame);
// The opacity of PLD_VIEW_OPACITY_DEPTH.
pld_status judgeOpacity(const FrameJudge& judge, const char* call, const pld_frame& frame);
pld_status judgeLow(const FrameJudge& judge, const char* call, const pld_frame& frame);

}  // namespace pellucid::c
