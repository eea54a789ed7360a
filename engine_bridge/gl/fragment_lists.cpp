#include "engine_bridge/gl/fragment_lists.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "engine_bridge/gl/frame_blocks.h"
#include "gbuffer/errors.h"

namespace pellucid::gl {
namespace {

std::size_t countAt(const Image<float>& count, int x, int y) {
  return static_cast<std::size_t>(count.at(x, y));
}

std::size_t countIn(const Image<float>& count, int x0, int x1, int y) {
  std::size_t sum = 0;
  for (int x = x0; x < x1; ++x) sum += countAt(count, x, y);
  return sum;
}

std::size_t countIn(const Image<float>& count, const Window& window) {
  std::size_t sum = 0;
  for (int y = window.y0; y < window.y1; ++y) sum += countIn(count, window.x0, window.x1, y);
  return sum;
}

class BandWriter {
 public:
  void write(Renderer& renderer, const Image<float>& count, const Window& band, FragmentLists& lists);

 private:
  ListBuffer fragments_, cursors_, columns_[kFragmentColumns];
  std::vector<std::uint32_t> places_;
};

void BandWriter::write(Renderer& renderer, const Image<float>& count, const Window& band, FragmentLists& lists) {
  lists.offsets.assign(1, 0);
  places_.clear();
  for (int y = band.y0; y < band.y1; ++y)
    for (int x = band.x0; x < band.x1; ++x) {
      places_.push_back(static_cast<std::uint32_t>(lists.offsets.back()));
      lists.offsets.push_back(lists.offsets.back() + countAt(count, x, y));
    }
  lists.resize(lists.offsets.back(), renderer.listedLayers());
  if (lists.fragments.empty()) return;

  const auto bytes = static_cast<GLsizeiptr>(lists.fragments.size() * sizeof(Fragment));
  const auto cursorBytes = static_cast<GLsizeiptr>(places_.size() * sizeof(std::uint32_t));
  fragments_.atLeast(lists.fragments.size() * sizeof(Fragment), 3, "making room for fragment lists");
  cursors_.atLeast(places_.size() * sizeof(std::uint32_t), 4, "making room for the cursors of fragment lists");
  glNamedBufferSubData(cursors_.name(), 0, cursorBytes, places_.data());
  const auto bytesOf = [](const FragmentColumn& column) { return column.size() * sizeof(glm::vec4); };
  for (std::size_t k = 0; k < kFragmentColumns; ++k)
    if (const FragmentColumn& column = *lists.columns()[k]; !column.empty())
      columns_[k].atLeast(bytesOf(column), kFirstColumn + static_cast<GLuint>(k), "making room for a list's columns");
  renderer.setBand(band);
  renderer.targets().beginNothing();
  renderer.draw(Output::list, {band});
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(fragments_.name(), 0, bytes, lists.fragments.data());
  glGetNamedBufferSubData(cursors_.name(), 0, cursorBytes, places_.data());
  for (std::size_t k = 0; k < kFragmentColumns; ++k)
    if (FragmentColumn& column = *lists.columns()[k]; !column.empty())
      glGetNamedBufferSubData(columns_[k].name(), 0, static_cast<GLsizeiptr>(bytesOf(column)), column.data());
  checkGl("reading fragment lists back");
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (places_[i] != lists.offsets[i + 1]) throw std::logic_error("fragments counted and fragments listed differ");
}

}  // namespace

void ListBuffer::atLeast(std::size_t wanted, GLuint binding, const char* what) {
  if (wanted > bytes_) {
    // With an eighth to spare: where the lists of every pass are a little longer than those of the one before, each
    // would have new memory beside the old, which the device has not let go yet.
    const std::size_t spare = std::min(wanted / 8, largestStorageBlock() - std::min(largestStorageBlock(), wanted));
    glNamedBufferData(buffer_.name(), static_cast<GLsizeiptr>(wanted + spare), nullptr, GL_STREAM_READ);
    checkGl(what);
    bytes_ = wanted + spare;
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer_.name());
}

std::size_t largestStorageBlock() {
  GLint64 bytes = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
  return static_cast<std::size_t>(std::max<GLint64>(bytes, 0));
}

std::size_t lightFragments(std::size_t triangles, std::size_t draws) {
  constexpr std::size_t kPerTriangle = 128, kPerDraw = 4096;  // a draw costs some microseconds, a fragment 40 ns
  return triangles * kPerTriangle + draws * kPerDraw;
}

namespace {

// Records, or pixels, of a band: few, so that the device's copy and ours are small, but as many as take longer than
// drawing the geometry once more.
std::size_t bandSize(const GeometryStream& geometry) {
  constexpr std::size_t kLeast = (std::size_t{16} << 20) / sizeof(Fragment), kPerTriangle = 16, kPerDraw = 512;
  return std::max(kLeast, geometry.sceneTriangles() * kPerTriangle + geometry.sceneInstances() * kPerDraw);
}

}  // namespace

std::vector<Window> rowsOf(const Window& window, std::size_t most) {
  const auto fit = std::max<std::size_t>(most / static_cast<std::size_t>(std::max(window.width(), 1)), 1);
  const int rows = static_cast<int>(std::min(fit, static_cast<std::size_t>(window.height())));
  std::vector<Window> parts;
  for (int y = window.y0; y < window.y1; y += rows)
    parts.push_back({window.x0, y, window.x1, std::min(y + rows, window.y1)});
  return parts;
}

std::size_t blockSize(const Renderer& renderer, std::size_t recordBytes) {
  const GeometryStream& geometry = renderer.geometry();
  if (!renderer.picksTiles() || !geometry.resident()) return 0;
  return std::max(kListCache / recordBytes, lightFragments(geometry.triangles(), geometry.draws()));
}

std::vector<Window> bandsOf(const Image<float>& count, const Window& area, std::size_t most) {
  std::vector<Window> bands;
  int top = area.y0;
  std::size_t held = 0;
  for (int y = area.y0; y < area.y1; ++y) {
    const std::size_t row = countIn(count, area.x0, area.x1, y);
    if (held + row > most && y > top) {
      bands.push_back({area.x0, top, area.x1, y});
      top = y;
      held = 0;
    }
    held += row;
    if (held <= most) continue;
    // This row alone is too much.
    int left = area.x0;
    std::size_t part = 0;
    for (int x = area.x0; x < area.x1; ++x) {
      const std::size_t pixel = countAt(count, x, y);
      if (part + pixel > most && x > left) {
        bands.push_back({left, y, x, y + 1});
        left = x;
        part = 0;
      }
      part += pixel;
    }
    bands.push_back({left, y, area.x1, y + 1});
    top = y + 1;
    held = 0;
  }
  if (top < area.y1) bands.push_back({area.x0, top, area.x1, area.y1});
  return bands;
}

std::vector<Window> blocksOf(const Image<float>& count, const Window& window, int edge, std::size_t most) {
  std::vector<Window> blocks;
  const auto nextTile = [edge](int place, int end) { return std::min((place / edge + 1) * edge, end); };
  for (int y0 = window.y0, y1; y0 < window.y1; y0 = y1) {
    y1 = nextTile(y0, window.y1);
    int left = window.x0;
    std::size_t held = 0;
    for (int x0 = window.x0, x1; x0 < window.x1; x0 = x1) {
      x1 = nextTile(x0, window.x1);
      const std::size_t tile = countIn(count, {x0, y0, x1, y1});
      if (held + tile > most && x0 > left) {
        blocks.push_back({left, y0, x0, y1});
        left = x0;
        held = 0;
      }
      held += tile;
    }
    blocks.push_back({left, y0, window.x1, y1});
  }
  return blocks;
}

std::vector<Window> countedWindows(Renderer& renderer, std::size_t recordBytes, std::size_t bytes,
                                   Image<float>& count) {
  Targets& targets = renderer.targets();
  const std::vector<Window> tiles = renderer.tiles();
  targets.beginCount();
  renderer.draw(Output::count, tiles);
  count = targets.readCount();
  const std::size_t most = std::clamp<std::size_t>(bytes / recordBytes, 1, largestStorageBlock() / recordBytes);
  const std::size_t few = blockSize(renderer, recordBytes);
  std::vector<Window> windows;
  for (const Window& tile : tiles)
    for (const Window& window : bandsOf(count, tile, most)) {
      if (few == 0 || countIn(count, window) <= few) {
        windows.push_back(window);
        continue;
      }
      const std::vector<Window> blocks = blocksOf(count, window, kRasterTile, few);
      windows.insert(windows.end(), blocks.begin(), blocks.end());
    }
  return windows;
}

void requireListable(const Image<float>& count, const Window& window, std::size_t recordBytes) {
  const std::size_t limit = largestStorageBlock() / recordBytes;
  if (window.width() != 1 || window.height() != 1 || countAt(count, window.x0, window.y0) <= limit) return;
  throw ResourceError(fmt::format("GL: {} transparent fragments on one pixel: the device lists at most {}",
                                  countAt(count, window.x0, window.y0), limit));
}

Image<glm::vec4> drawnSolids(Renderer& renderer) {
  Image<glm::vec4> solid;
  if (!renderer.hasSolids()) return solid;
  const Window& part = renderer.targets().part();
  solid = Image<glm::vec4>(part.width(), part.height());
  renderer.targets().readSolid(solid, 0, 0);
  return solid;
}

Image<glm::vec4> solidOf(const Image<glm::vec4>& solid, const Window& part, const Window& window) {
  Image<glm::vec4> own(window.width(), window.height(), glm::vec4(0, 0, 0, INFINITY));
  if (solid.empty()) return own;
  for (int y = window.y0; y < window.y1; ++y) {
    const glm::vec4* row = solid.row(y - part.y0) + (window.x0 - part.x0);
    std::copy(row, row + window.width(), own.row(y - window.y0));
  }
  return own;
}

void listFragments(Renderer& renderer, std::size_t bytes,
                   const std::function<void(FragmentLists&, const Window&)>& band) {
  Image<float> count;
  const std::size_t most = bandSize(renderer.geometry());
  const std::vector<Window> windows =
      countedWindows(renderer, sizeof(Fragment), std::min(bytes, most * sizeof(Fragment)), count);
  const Image<glm::vec4> solid = drawnSolids(renderer);
  BandWriter writer;
  FragmentLists lists;
  for (const Window& all : windows)
    for (const Window& window : rowsOf(all, most)) {
      requireListable(count, window, sizeof(Fragment));
      writer.write(renderer, count, window, lists);
      lists.solid = solidOf(solid, renderer.targets().part(), window);
      band(lists, window);
    }
}

}  // namespace pellucid::gl
