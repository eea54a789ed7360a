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

// Cuts `window` into whole rows of at most `most` pixels together, or one row each.
std::vector<Window> rowsOf(const Window& window, std::size_t most);

// Draws the count of fragments per pixel and cuts the super-tile into windows: tiles as the settings want them, such
// that each window's records fit `bytes` or are of one pixel, and blocks that a cache holds where blockSize() says so.
std::vector<Window> countedWindows(Renderer& renderer, std::size_t recordBytes, std::size_t bytes, Image<float>& count);

// Throws ResourceError for a pixel that stands alone and has more fragments than the device can list.
void requireListable(const Image<float>& count, const Window& window, std::size_t recordBytes);

// Solids of the part of the targets that is drawn; empty where there are none. After Renderer::begin().
Image<glm::vec4> drawnSolids(Renderer& renderer);
// A window's part of a plane of them, or +inf for an empty one.
//   part  that the plane is of
Image<glm::vec4> solidOf(const Image<glm::vec4>& solid, const Window& part, const Window& window);

// Fragments beside which drawing the geometry once more is a small part of the work.
std::size_t lightFragments(std::size_t triangles, std::size_t draws);

// Fragments of a block, after a sweep. Few, so that they are still in the cache when they are read, but as many as
// lightFragments(). 0: blocks do not pay.
std::size_t blockSize(const Renderer& renderer, std::size_t recordBytes);

// Bytes that one storage block may have.
std::size_t largestStorageBlock();

constexpr int kRasterTile = 64;                           // edge of what software rasterisers give to one thread
constexpr std::size_t kListCache = std::size_t{9} << 19;  // bytes of lists that a cache holds beside all else

// A buffer that only grows: fresh memory for every band costs more than the lists themselves.
class ListBuffer {
 public:
  void atLeast(std::size_t wanted, GLuint binding, const char* what);  // bytes; bound to the storage binding
  GLuint name() const { return buffer_.name(); }

 private:
  Buffer buffer_ = Buffer::make();
  std::size_t bytes_ = 0;
};

// After Renderer::begin(). `band` gets each band's lists and its window in pixels of the super-tile.
//   bytes  what the device's copy of a band may have, and ours
void listFragments(Renderer& renderer, std::size_t bytes,
                   const std::function<void(FragmentLists&, const Window&)>& band);

}  // namespace pellucid::gl
