#include "engine_bridge/gl/fragment_lists.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

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

// Bytes that one storage block may have.
std::size_t largestBlock() {
  GLint64 bytes = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
  return static_cast<std::size_t>(std::max<GLint64>(bytes, 0));
}

class BandWriter {
 public:
  void write(Renderer& renderer, const Image<float>& count, const Window& band, FragmentLists& lists);

 private:
  // A buffer that only grows: fresh memory for every band costs more than the lists themselves.
  struct Room {
    Buffer buffer = Buffer::make();
    GLsizeiptr bytes = 0;
    void atLeast(GLsizeiptr wanted, GLuint binding, const char* what) {
      if (wanted > bytes) {
        glNamedBufferData(buffer.name(), wanted, nullptr, GL_STREAM_READ);
        checkGl(what);
        bytes = wanted;
      }
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.name());
    }
  };
  Room fragments_, cursors_, dispersion_;
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
  lists.fragments.resize(lists.offsets.back());
  if (lists.fragments.empty()) return;

  const auto bytes = static_cast<GLsizeiptr>(lists.fragments.size() * sizeof(Fragment));
  const auto cursorBytes = static_cast<GLsizeiptr>(places_.size() * sizeof(std::uint32_t));
  fragments_.atLeast(bytes, 3, "making room for fragment lists");
  cursors_.atLeast(cursorBytes, 4, "making room for the cursors of fragment lists");
  glNamedBufferSubData(cursors_.buffer.name(), 0, cursorBytes, places_.data());
  lists.dispersion.resize(renderer.disperses() ? lists.fragments.size() : 0);
  const auto dispersionBytes = static_cast<GLsizeiptr>(lists.dispersion.size() * sizeof(glm::vec4));
  if (lists.disperses()) dispersion_.atLeast(dispersionBytes, 7, "making room for dispersion");
  renderer.setBand(band);
  renderer.targets().beginNothing();
  renderer.draw(Output::list, {band});
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(fragments_.buffer.name(), 0, bytes, lists.fragments.data());
  glGetNamedBufferSubData(cursors_.buffer.name(), 0, cursorBytes, places_.data());
  if (lists.disperses()) glGetNamedBufferSubData(dispersion_.buffer.name(), 0, dispersionBytes, lists.dispersion.data());
  checkGl("reading fragment lists back");
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (places_[i] != lists.offsets[i + 1]) throw std::logic_error("fragments counted and fragments listed differ");
}

}  // namespace

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

void listFragments(Renderer& renderer, std::size_t fragmentBytes,
                   const std::function<void(FragmentLists&, const Window&)>& band) {
  Targets& targets = renderer.targets();
  const std::vector<Window> tiles = renderer.tiles();
  targets.beginCount();
  renderer.draw(Output::count, tiles);
  const Image<float> count = targets.readCount();
  Image<glm::vec4> solid(targets.width(), targets.height(), glm::vec4(0, 0, 0, INFINITY));
  if (renderer.hasSolids()) targets.readSolid(solid, 0, 0);

  const std::size_t blockLimit = largestBlock() / sizeof(Fragment);
  const std::size_t most = std::clamp<std::size_t>(fragmentBytes / sizeof(Fragment), 1, blockLimit);
  BandWriter writer;
  FragmentLists lists;
  for (const Window& tile : tiles)
    for (const Window& window : bandsOf(count, tile, most)) {
      if (window.width() == 1 && window.height() == 1 && countAt(count, window.x0, window.y0) > blockLimit)
        throw ResourceError(fmt::format("GL: {} transparent fragments on one pixel: the device lists at most {}",
                                        countAt(count, window.x0, window.y0), blockLimit));
      writer.write(renderer, count, window, lists);
      lists.solid = Image<glm::vec4>(window.width(), window.height());
      for (int y = window.y0; y < window.y1; ++y)
        std::copy(&solid.at(window.x0, y), &solid.at(window.x0, y) + window.width(), lists.solid.row(y - window.y0));
      band(lists, window);
    }
}

}  // namespace pellucid::gl
