// Lists for compositing by depth. Where the geometry is light nothing is counted first: every pixel of a block gets as
// many places as the deepest one needed in the last block, and a block that needs more is drawn again.
#pragma once
#include <functional>

#include "engine_bridge/gl/renderer.h"
#include "gbuffer/lean_lists.h"

namespace pellucid::gl {

// After Renderer::begin(). `block` gets each block's lists, which hold until it returns, and its window in pixels of
// the super-tile.
//   bytes  what the lists of a block may have
void listLean(Renderer& renderer, std::size_t bytes, const std::function<void(LeanLists&, const Window&)>& block);

}  // namespace pellucid::gl
