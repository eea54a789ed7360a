#include "gbuffer/deep_io.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineInputPart.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfDeepTiledInputPart.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <iterator>
#include <new>
#include <optional>
#include <stdexcept>

#include "gbuffer/atomic_file.h"
#include "gbuffer/deep_line.h"
#include "gbuffer/errors.h"
#include "gbuffer/exr_header.h"
#include "gbuffer/exr_layout.h"
#include "gbuffer/exr_stream.h"

namespace pellucid {
namespace {

// Rows whose sample counts are looked at together: as many as keep two cores busy on one-line chunks.
constexpr int kBandRows = 64;
constexpr std::uint64_t kChunkHead = 28;  // before the packed counts of a line
// No byte of a deflated stream expands further.
constexpr std::uint64_t kLargestExpansion = 1032;

// Calls of OpenEXR on an input: what they throw is damage.
template <class Work>
auto reading(const std::string& path, Work&& work) {
  try {
    return work();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw ResourceError(path + ": cannot be read: memory ran out");
  } catch (const std::length_error&) {
    throw ResourceError(path + ": cannot be read: memory ran out");
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: damaged: {}", path, error.what()));
  }
}

// OpenEXR addresses memory by absolute pixel: the base that puts (x0, y0) at `first`.
char* baseFor(void* first, const Window& window, std::size_t stride) {
  const auto back =
      (static_cast<std::ptrdiff_t>(window.y0) * window.width() + window.x0) * static_cast<std::ptrdiff_t>(stride);
  return reinterpret_cast<char*>(reinterpret_cast<std::intptr_t>(first) - back);
}

// Pointers to each pixel's samples, for each channel, and the counts: what a DeepFrameBuffer refers to.
struct DeepMemory {
  std::vector<std::uint32_t> counts;
  std::vector<std::vector<char*>> pointers;

  exr::DeepFrameBuffer frame(const Window& window, const std::vector<std::string>& names) {
    const auto pixels = static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
    const auto width = static_cast<std::size_t>(window.width());
    counts.resize(pixels);
    pointers.resize(names.size());
    exr::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(exr::Slice(exr::UINT, baseFor(counts.data(), window, sizeof(std::uint32_t)),
                                             sizeof(std::uint32_t), sizeof(std::uint32_t) * width));
    for (std::size_t c = 0; c < names.size(); ++c) {
      pointers[c].assign(pixels, nullptr);
      buffer.insert(names[c], exr::DeepSlice(exr::FLOAT, baseFor(pointers[c].data(), window, sizeof(char*)),
                                             sizeof(char*), sizeof(char*) * width, sizeof(float)));
    }
    return buffer;
  }
  void pointInto(const std::vector<std::uint64_t>& offsets, std::size_t pixels,
                 std::vector<std::vector<float>>& channels) {
    for (std::size_t c = 0; c < pointers.size(); ++c)
      for (std::size_t i = 0; i < pixels; ++i)
        pointers[c][i] = reinterpret_cast<char*>(channels[c].data() + offsets[i]);
  }
};

// How to decode the lines of a part ourselves; nothing for compressions that are left to OpenEXR.
std::optional<DeepLineFormat> formatOf(const exr::Header& header, const std::vector<std::string>& names) {
  if (header.compression() != exr::ZIPS_COMPRESSION && header.compression() != exr::NO_COMPRESSION) return std::nullopt;
  DeepLineFormat format;
  format.zips = header.compression() == exr::ZIPS_COMPRESSION;
  format.width = static_cast<std::size_t>(windowOf(header.dataWindow()).width());
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    const exr::PixelType type = it.channel().type;
    format.types.push_back(type == exr::UINT   ? PixelType::uint32
                           : type == exr::HALF ? PixelType::half
                                               : PixelType::float32);
    format.size.push_back(bytesOf(format.types.back()));
    const auto wanted = std::find(names.begin(), names.end(), it.name());
    format.wanted.push_back(wanted == names.end() ? -1 : static_cast<int>(wanted - names.begin()));
  }
  return format;
}

}  // namespace

struct DeepReader::Impl {
  std::string path;
  std::vector<std::string> names;
  ExrSource source;
  std::optional<exr::MultiPartInputFile> file;
  std::optional<exr::DeepScanLineInputPart> part;
  std::optional<exr::DeepTiledInputPart> tiles;
  Window display, data;
  DeepMemory memory;
  DeepRows tileRow;  // of tiled files, the row of tiles read last
  // Of scanline files whose lines we decode ourselves: the lines read last, from row linesFrom on, and done ones whose
  // memory the next ones take.
  std::optional<DeepLineFormat> format;
  std::vector<DeepLine> lines, spare;
  int linesFrom = 0;
  Impl(const std::string& from, const std::vector<std::string>& channels) : path(from), names(channels), source(from) {}

  // Memory for the samples that rows.offsets speak of.
  void makeRoom(DeepRows& rows) {
    const std::uint64_t samples = rows.offsets.back();
    if (samples > source.size() * kLargestExpansion)
      throw InputError(fmt::format("{}: damaged: rows {} to {} claim {} samples, more than {} bytes can hold", path,
                                   rows.window.y0, rows.window.y1 - 1, samples, source.size()));
    rows.channels.resize(names.size());
    for (std::vector<float>& channel : rows.channels) channel.resize(samples);
  }
  void pointInto(DeepRows& rows) {
    memory.pointInto(rows.offsets,
                     static_cast<std::size_t>(rows.window.width()) * static_cast<std::size_t>(rows.window.height()),
                     rows.channels);
  }

  [[noreturn]] void damagedLine(int y) const {
    throw InputError(fmt::format("{}: damaged: row {} does not unpack", path, y));
  }

  void readLine(int y, DeepLine& line) {
    std::uint64_t size = line.chunk.size();
    part->rawPixelData(y, line.chunk.data(), size);
    if (size > source.size() + kChunkHead) damagedLine(y);
    const bool read = size <= line.chunk.size();
    line.chunk.resize(size);
    if (!read) part->rawPixelData(y, line.chunk.data(), size);
    line.counts.clear();
  }

  // Reads rows y0 <= y < y1, packed, behind `to`.
  void readPacked(int y0, int y1, std::vector<DeepLine>& to) {
    std::size_t guess = 0;
    for (int y = y0; y < y1; ++y) {
      DeepLine line;
      if (!spare.empty()) {
        line = std::move(spare.back());
        spare.pop_back();
      }
      if (line.chunk.size() < guess) line.chunk.resize(guess);
      readLine(y, line);
      guess = line.chunk.size() * 5 / 4;
      to.push_back(std::move(line));
    }
  }

  // Makes `lines` begin at row y0 and hold rows up to y1 at least, with their counts.
  void readLines(int y0, int y1) {
    const auto held = static_cast<std::ptrdiff_t>(lines.size());
    const auto done = y0 < linesFrom ? held : std::min<std::ptrdiff_t>(y0 - linesFrom, held);
    std::move(lines.begin(), lines.begin() + done, std::back_inserter(spare));
    lines.erase(lines.begin(), lines.begin() + done);
    linesFrom = y0;
    readPacked(y0 + static_cast<int>(lines.size()), y1, lines);
    tbb::parallel_for(std::size_t{0}, lines.size(), [&](std::size_t i) {
      if (lines[i].counts.empty() && !lines[i].readCounts(*format)) damagedLine(y0 + static_cast<int>(i));
    });
  }

  DeepRows rowsOfLines(int y0, int y1, std::uint64_t most, DeepRows rows) {
    readLines(y0, most == UINT64_MAX ? y1 : std::min(y1, y0 + kBandRows));
    rows.offsets.assign(1, 0);
    std::vector<std::uint64_t> first{0};
    for (const DeepLine& line : lines) {
      if (static_cast<int>(first.size()) - 1 == y1 - y0) break;
      if (first.size() > 1 && first.back() + line.samples > most) break;
      for (const std::uint32_t count : line.counts) rows.offsets.push_back(rows.offsets.back() + count);
      first.push_back(rows.offsets.back());
    }
    rows.window = {data.x0, y0, data.x1, y0 + static_cast<int>(first.size()) - 1};
    makeRoom(rows);
    // While these rows are unpacked, as many come from the file.
    const int next = y0 + static_cast<int>(lines.size());
    std::vector<DeepLine> ahead;
    tbb::parallel_invoke([&] { readPacked(next, std::min(rows.window.y1 + rows.window.height(), y1), ahead); },
                         [&] {
                           tbb::parallel_for(std::size_t{0}, first.size() - 1, [&](std::size_t i) {
                             std::vector<float*> channels;
                             for (std::vector<float>& channel : rows.channels)
                               channels.push_back(channel.data() + first[i]);
                             if (!lines[i].readSamples(*format, channels)) damagedLine(y0 + static_cast<int>(i));
                           });
                         });
    std::move(ahead.begin(), ahead.end(), std::back_inserter(lines));
    return rows;
  }

  // Fills tileRow with the row of tiles that holds row y.
  void readTileRow(int y) {
    const int height = static_cast<int>(tiles->tileYSize()), row = (y - data.y0) / height;
    tileRow = {};
    tileRow.window = {data.x0, data.y0 + row * height, data.x1, std::min(data.y0 + (row + 1) * height, data.y1)};
    const exr::DeepFrameBuffer frame = memory.frame(tileRow.window, names);
    tiles->setFrameBuffer(frame);
    tiles->readPixelSampleCounts(0, tiles->numXTiles(0) - 1, row, row, 0, 0);
    tileRow.offsets.assign(1, 0);
    for (const std::uint32_t count : memory.counts) tileRow.offsets.push_back(tileRow.offsets.back() + count);
    makeRoom(tileRow);
    pointInto(tileRow);
    if (!names.empty()) tiles->readTiles(0, tiles->numXTiles(0) - 1, row, row, 0, 0);
  }

  // Rows of tileRow from y0 on.
  DeepRows rowsOfTiles(int y0, int y1, std::uint64_t most) {
    if (tileRow.offsets.empty() || y0 < tileRow.window.y0 || y0 >= tileRow.window.y1) readTileRow(y0);
    const auto width = static_cast<std::size_t>(data.width());
    const auto first = static_cast<std::size_t>(y0 - tileRow.window.y0) * width;
    const std::uint64_t begin = tileRow.offsets[first];
    int end = y0 + 1;
    const auto endOf = [&](int row) {
      return tileRow.offsets[static_cast<std::size_t>(row - tileRow.window.y0) * width];
    };
    while (end < std::min(y1, tileRow.window.y1) && endOf(end + 1) - begin <= most) ++end;
    DeepRows rows;
    rows.window = {data.x0, y0, data.x1, end};
    for (std::size_t i = first; i <= first + width * static_cast<std::size_t>(end - y0); ++i)
      rows.offsets.push_back(tileRow.offsets[i] - begin);
    for (const std::vector<float>& channel : tileRow.channels)
      rows.channels.emplace_back(channel.begin() + static_cast<std::ptrdiff_t>(begin),
                                 channel.begin() + static_cast<std::ptrdiff_t>(begin + rows.offsets.back()));
    return rows;
  }
};

DeepReader::DeepReader(const std::string& path, int part, const std::vector<std::string>& channels)
    : impl_(std::make_unique<Impl>(path, channels)) {
  const ExrLayout layout = checkLayout(impl_->source, path);
  if (part < 0 || part >= static_cast<int>(layout.parts.size()))
    throw InputError(fmt::format("{}: no part {}: found {} parts", path, part, layout.parts.size()));
  const ExrPartLayout& chosen = layout.parts[static_cast<std::size_t>(part)];
  if (!chosen.deep)
    throw InputError(fmt::format("{}: part {}: found a flat picture, expected deep samples", path, part));
  reading(path, [&] {
    impl_->file.emplace(impl_->source, exrThreads(), false);
    if (!impl_->file->partComplete(part))
      throw InputError(fmt::format("{}: cut short: part {} is not whole", path, part));
    const exr::Header& header = impl_->file->header(part);
    for (const std::string& name : channels)
      if (!header.channels().findChannel(name))
        throw MeaningError(fmt::format("{}: part {}: found no channel {}", path, part, name));
    impl_->display = windowOf(header.displayWindow());
    impl_->data = windowOf(header.dataWindow());
    if (chosen.tiled)
      impl_->tiles.emplace(*impl_->file, part);
    else
      impl_->part.emplace(*impl_->file, part);
    if (!chosen.tiled) impl_->format = formatOf(header, channels);
  });
}

DeepReader::~DeepReader() = default;

const Window& DeepReader::data() const {
  return impl_->data;
}
const Window& DeepReader::display() const {
  return impl_->display;
}

DeepRows DeepReader::read(int y0, int y1, std::uint64_t most, DeepRows reused) {
  Impl& in = *impl_;
  if (y0 < in.data.y0 || y1 > in.data.y1 || y0 >= y1) throw std::logic_error("DeepReader: rows outside the file");
  if (in.tiles) return reading(in.path, [&] { return in.rowsOfTiles(y0, y1, most); });
  if (in.format) return reading(in.path, [&] { return in.rowsOfLines(y0, y1, most, std::move(reused)); });
  DeepRows rows = std::move(reused);
  return reading(in.path, [&] {
    Window window{in.data.x0, y0, in.data.x1, most == UINT64_MAX ? y1 : std::min(y1, y0 + kBandRows)};
    const exr::DeepFrameBuffer frame = in.memory.frame(window, in.names);
    in.part->setFrameBuffer(frame);
    in.part->readPixelSampleCounts(window.y0, window.y1 - 1);

    const auto width = static_cast<std::size_t>(window.width());
    rows.offsets.assign(1, 0);
    int end = window.y0;
    while (end < window.y1) {
      const std::size_t row = static_cast<std::size_t>(end - window.y0) * width;
      std::uint64_t samples = rows.offsets.back();
      for (std::size_t x = 0; x < width; ++x) samples += in.memory.counts[row + x];
      if (samples > most && end > window.y0) break;
      for (std::size_t x = 0; x < width; ++x) rows.offsets.push_back(rows.offsets.back() + in.memory.counts[row + x]);
      ++end;
    }
    window.y1 = end;
    rows.window = window;
    in.makeRoom(rows);
    in.pointInto(rows);
    if (!in.names.empty()) in.part->readPixels(window.y0, window.y1 - 1);
    return std::move(rows);
  });
}

struct DeepWriter::Impl {
  std::string path;
  DeepHeader header;
  AtomicFile target;
  ExrSink sink;
  std::optional<exr::MultiPartOutputFile> file;
  std::optional<exr::DeepScanLineOutputPart> part;
  int next = 0;
  DeepMemory memory;
  Impl(const std::string& to, const DeepHeader& h) : path(to), header(h), target(to), sink(target.temporary(), to) {}

  template <class Work>
  void writing(Work&& work) {
    try {
      work();
    } catch (const std::logic_error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw ResourceError(path + ": cannot be written: memory ran out");
    } catch (const std::exception& error) {
      sink.finish();  // says so when it was the disk
      throw ResourceError(fmt::format("{}: cannot be written: {}", path, error.what()));
    }
  }
};

DeepWriter::DeepWriter(const std::string& path, const DeepHeader& header)
    : impl_(std::make_unique<Impl>(path, header)) {
  impl_->writing([&] {
    exr::Header out(boxOf(header.display), boxOf(header.data), static_cast<float>(header.pixelAspect));
    out.setType(exr::DEEPSCANLINE);
    out.compression() = exr::ZIPS_COMPRESSION;
    for (const std::string& name : header.channels) out.channels().insert(name, exr::Channel(exr::FLOAT));
    for (const auto& [name, text] : header.attributes) out.insert(name, exr::StringAttribute(text));
    if (const std::vector<float>& xy = header.chromaticities; xy.size() == 8)
      exr::addChromaticities(out, exr::Chromaticities({xy[0], xy[1]}, {xy[2], xy[3]}, {xy[4], xy[5]}, {xy[6], xy[7]}));
    if (header.camera) {
      float matrices[2][4][4];
      cameraToExr(*header.camera, matrices[0], matrices[1]);
      exr::addWorldToCamera(out, IMATH_NAMESPACE::M44f(matrices[0]));
      exr::addWorldToNDC(out, IMATH_NAMESPACE::M44f(matrices[1]));
    }
    impl_->file.emplace(impl_->sink, &out, 1, false, exrThreads());
    impl_->part.emplace(*impl_->file, 0);
  });
  impl_->next = header.data.y0;
}

DeepWriter::~DeepWriter() = default;

void DeepWriter::write(const DeepRows& rows) {
  Impl& out = *impl_;
  if (rows.window.y0 != out.next || rows.window.x0 != out.header.data.x0 || rows.window.x1 != out.header.data.x1 ||
      rows.channels.size() != out.header.channels.size())
    throw std::logic_error("DeepWriter: rows do not follow");
  out.writing([&] {
    const exr::DeepFrameBuffer frame = out.memory.frame(rows.window, out.header.channels);
    const std::size_t pixels = out.memory.counts.size();
    for (std::size_t i = 0; i < pixels; ++i) {
      const std::uint64_t count = rows.offsets[i + 1] - rows.offsets[i];
      if (count > 0x7fffffffu) throw std::length_error("too many samples on one pixel");
      out.memory.counts[i] = static_cast<std::uint32_t>(count);
    }
    // OpenEXR does not say const, but only reads.
    for (std::size_t c = 0; c < rows.channels.size(); ++c)
      for (std::size_t i = 0; i < pixels; ++i)
        out.memory.pointers[c][i] =
            reinterpret_cast<char*>(const_cast<float*>(rows.channels[c].data()) + rows.offsets[i]);
    out.part->setFrameBuffer(frame);
    out.part->writePixels(rows.window.height());
  });
  out.next = rows.window.y1;
}

void DeepWriter::finish() {
  Impl& out = *impl_;
  if (out.next != out.header.data.y1) throw std::logic_error("DeepWriter: rows are missing");
  out.part.reset();
  out.file.reset();
  out.sink.finish();
  out.target.commit();
}

}  // namespace pellucid
