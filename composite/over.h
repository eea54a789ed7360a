// The truth: layers sorted by depth and composited back to front in double precision. MODEL section 1, PS16 eq. 1
#pragma once
#include "composite/veil.h"
#include "gbuffer/fragments.h"
#include "gbuffer/lean_lists.h"

namespace pellucid {

// Writes the veil of the lists' window, which lies inside `data`. Layers at equal depth merge by OpenEXR's symmetric
// rule, so that no order matters: not even between coincident layers.
//   only  one entry a pixel of the lists' window, 0 leaves the pixel as it is; null: all of them
void compositeSorted(const FragmentLists& lists, const Window& data, Veil& veil,
                     const std::vector<std::uint8_t>* only = nullptr);
void compositeSorted(const LeanLists& lists, const Window& data, Veil& veil);

}  // namespace pellucid
