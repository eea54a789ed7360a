// Exact per-pixel lists: counted first, then written into ranges of that size, in bands that fit the memory allowed.
#pragma once
#include <functional>

#include "engine_bridge/gl/renderer.h"
#include "gbuffer/fragments.h"

namespace pellucid::gl {

// Cuts `area` into windows of at most `most` fragments each, in rows from the top; a row that holds more is cut in x,
// and a pixel that holds more stands alone.
std::vector<Window> bandsOf(const Image<float>& count, const Window& area, std::size_t most);

// Cuts `window` into blocks of whole tiles of `edge` pixels, row by row, that hold at most `most` fragments each or are
// one tile.
std::vector<Window> blocksOf(const Image<float>& count, const Window& window, int edge, std::size_t most);

// After Renderer::begin(). `band` gets each band's lists and its window in pixels of the super-tile. Record is Fragment
// or LeanFragment.
//   bytes  what the device's copy of a band may have, and ours
template <class Record>
void listFragments(Renderer& renderer, std::size_t bytes, const std::function<void(ListsOf<Record>&, const Window&)>& band);

}  // namespace pellucid::gl
