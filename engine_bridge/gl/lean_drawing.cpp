#include "engine_bridge/gl/lean_drawing.h"

#include <algorithm>
#include <stdexcept>

#include "engine_bridge/gl/fragment_lists.h"
#include "gbuffer/errors.h"

namespace pellucid::gl {
namespace {

constexpr GLuint kFragments = 3, kCursors = 4;  // storage bindings of gl/list_output.glsl
constexpr std::size_t kTileArea = std::size_t{kRasterTile} * kRasterTile;
constexpr std::size_t kFirstPlaces = 8, kFewestPlaces = 4;

using Block = std::function<void(LeanLists&, const Window&)>;

class LeanWriter {
 public:
  LeanWriter(Renderer& renderer, const Block& block)
      : renderer_(renderer), block_(block), solid_(drawnSolids(renderer)) {}

  // Gives each pixel of the window this many places and delivers the lists if no pixel has more fragments than that.
  // Returns how many the deepest has. With 0 it only counts.
  std::size_t guess(const Window& window, std::size_t places) {
    std::vector<LeanLists::Range>& ranges = lists_.ranges;
    ranges.resize(static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height()));
    for (std::size_t i = 0; i < ranges.size(); ++i) ranges[i].begin = static_cast<std::uint32_t>(i * places);
    draw(window, ranges.size() * places);
    std::uint32_t deepest = 0;
    for (const LeanLists::Range& range : ranges) deepest = std::max(deepest, range.count);
    if (deepest <= places) deliver(window, ranges.size() * places);
    return deepest;
  }

  // Gives each pixel of the window what `count` says it has, and delivers the lists.
  void counted(const Window& window, const Image<float>& count) {
    lists_.ranges.clear();
    std::size_t places = 0;
    for (int y = window.y0; y < window.y1; ++y)
      for (int x = window.x0; x < window.x1; ++x) {
        lists_.ranges.push_back({static_cast<std::uint32_t>(places), 0});
        places += static_cast<std::size_t>(count.at(x, y));
      }
    if (places > 0) draw(window, places);
    std::size_t i = 0;
    for (int y = window.y0; y < window.y1; ++y)
      for (int x = window.x0; x < window.x1; ++x, ++i)
        if (lists_.ranges[i].count != static_cast<std::uint32_t>(count.at(x, y)))
          throw std::logic_error("fragments counted and fragments listed differ");
    deliver(window, places);
  }

  // What the last guess() found.
  void copyCounts(const Window& window, Image<float>& count) const {
    std::size_t i = 0;
    for (int y = window.y0; y < window.y1; ++y)
      for (int x = window.x0; x < window.x1; ++x) count.at(x, y) = static_cast<float>(lists_.ranges[i++].count);
  }

 private:
  // Each pixel's fragments go where its range begins, one after the other, into the next pixel's where there are too
  // many.
  void draw(const Window& window, std::size_t places) {
    std::vector<LeanLists::Range>& ranges = lists_.ranges;
    places_.resize(ranges.size());
    for (std::size_t i = 0; i < ranges.size(); ++i) places_[i] = ranges[i].begin;
    const std::size_t cursorBytes = places_.size() * sizeof(std::uint32_t);
    fragments_.atLeast(std::max<std::size_t>(places, 1) * sizeof(LeanFragment), kFragments,
                       "making room for fragment lists");
    // Too small for any fragment.
    if (places == 0) glBindBufferRange(GL_SHADER_STORAGE_BUFFER, kFragments, fragments_.name(), 0, sizeof(glm::vec2));
    cursors_.atLeast(cursorBytes, kCursors, "making room for the cursors of fragment lists");
    glNamedBufferSubData(cursors_.name(), 0, static_cast<GLsizeiptr>(cursorBytes), places_.data());
    renderer_.setBand(window);
    renderer_.targets().beginNothing();
    renderer_.draw(Output::leanList, {window});
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(cursors_.name(), 0, static_cast<GLsizeiptr>(cursorBytes), places_.data());
    checkGl("reading the cursors of fragment lists back");
    for (std::size_t i = 0; i < ranges.size(); ++i) ranges[i].count = places_[i] - ranges[i].begin;
  }

  void deliver(const Window& window, std::size_t places) {
    lists_.fragments = {};
    const LeanFragment* mapped = nullptr;
    if (places > 0) {
      mapped = static_cast<const LeanFragment*>(glMapNamedBufferRange(
          fragments_.name(), 0, static_cast<GLsizeiptr>(places * sizeof(LeanFragment)), GL_MAP_READ_BIT));
      checkGl("reading fragment lists back");
      if (!mapped) throw ResourceError("GL: fragment lists cannot be read back");
      lists_.fragments = {mapped, places};
    }
    if (!solid_.empty()) lists_.solid = solidOf(solid_, renderer_.targets().part(), window);
    block_(lists_, window);
    if (mapped && !glUnmapNamedBuffer(fragments_.name()))
      throw ResourceError("GL: fragment lists were lost while being read");
  }

  Renderer& renderer_;
  const Block& block_;
  Image<glm::vec4> solid_;
  ListBuffer fragments_, cursors_;
  std::vector<std::uint32_t> places_;
  LeanLists lists_;
};

void listCounted(Renderer& renderer, std::size_t bytes, LeanWriter& writer) {
  Image<float> count;
  for (const Window& window : countedWindows(renderer, sizeof(LeanFragment), bytes, count)) {
    requireListable(count, window, sizeof(LeanFragment));
    writer.counted(window, count);
  }
}

// Blocks of whole tiles in rows. A tile too deep to give all its pixels as many places as the deepest needs is counted.
void listGuessed(Renderer& renderer, std::size_t bytes, LeanWriter& writer) {
  const Window& drawn = renderer.targets().part();
  constexpr std::size_t kCached = kListCache / sizeof(LeanFragment);
  const std::size_t most = std::clamp<std::size_t>(bytes, 1, largestStorageBlock()) / sizeof(LeanFragment);
  const std::size_t mostPlaces = std::min(most, 4 * kCached) / kTileArea;
  Image<float> count;
  std::size_t places = std::min(kFirstPlaces, mostPlaces);
  const auto tileOf = [](int place) { return place / kRasterTile * kRasterTile; };
  for (int top = tileOf(drawn.y0); top < drawn.y1; top += kRasterTile)
    for (int x = drawn.x0; x < drawn.x1;) {
      const auto tiles = std::max<int>(1, static_cast<int>(kCached / (std::max(places, kFewestPlaces) * kTileArea)));
      const Window window{x, std::max(top, drawn.y0), std::min(tileOf(x) + tiles * kRasterTile, drawn.x1),
                          std::min(top + kRasterTile, drawn.y1)};
      const std::size_t deepest = writer.guess(window, places);
      if (deepest <= places) {
        places = std::min(std::max({deepest, places - places / 4, kFewestPlaces}), mostPlaces);
        x = window.x1;
      } else if (deepest <= mostPlaces) {
        places = deepest;
      } else {
        if (count.empty()) count = Image<float>(drawn.x1, drawn.y1);
        writer.copyCounts(window, count);
        for (const Window& part : bandsOf(count, window, std::max<std::size_t>(most, 1))) {
          requireListable(count, part, sizeof(LeanFragment));
          writer.counted(part, count);
        }
        places = 0;
        x = window.x1;
      }
    }
}

}  // namespace

void listLean(Renderer& renderer, std::size_t bytes, const Block& block) {
  LeanWriter writer(renderer, block);
  const GeometryStream& geometry = renderer.geometry();
  const bool light =
      lightFragments(geometry.sceneTriangles(), geometry.sceneInstances()) <= kListCache / sizeof(LeanFragment);
  if (renderer.picksTiles() && light)
    listGuessed(renderer, bytes, writer);
  else
    listCounted(renderer, bytes, writer);
}

}  // namespace pellucid::gl
