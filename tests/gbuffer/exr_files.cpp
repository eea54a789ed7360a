#include "exr_files.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <stdlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

namespace pellucid::test {
namespace {

std::size_t size(exr::PixelType type) {
  return type == exr::HALF ? 2 : 4;
}

IMATH_NAMESPACE::Box2i box(const Window& w) {
  return {{w.x0, w.y0}, {w.x1 - 1, w.y1 - 1}};
}

class Bytes : public exr::OStream {
 public:
  Bytes() : OStream("memory") {}
  std::string bytes;
  void write(const char from[], int count) override { bytes.append(from, static_cast<std::size_t>(count)); }
  std::uint64_t tellp() override { return bytes.size(); }
  void seekp(std::uint64_t) override {}
};

exr::Header headerOf(const Part& part) {
  exr::Header header(box(part.display), box(part.data), static_cast<float>(part.pixelAspect));
  header.compression() = part.compression;
  header.lineOrder() = part.lineOrder;
  if (!part.name.empty()) header.setName(part.name);
  if (!part.view.empty()) header.setView(part.view);
  if (part.environmentMap >= 0) exr::addEnvmap(header, static_cast<exr::Envmap>(part.environmentMap));
  for (const auto& [name, text] : part.strings) header.insert(name, exr::StringAttribute(text));
  for (const auto& [name, numbers] : part.matrices) {
    IMATH_NAMESPACE::M44f m;
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = numbers[static_cast<std::size_t>(i)];
    header.insert(name, exr::M44fAttribute(m));
  }
  for (const Plane& plane : part.planes) header.channels().insert(plane.name, exr::Channel(plane.type));
  if (part.tileSize > 0)
    header.setTileDescription(
        exr::TileDescription(static_cast<unsigned>(part.tileSize), static_cast<unsigned>(part.tileSize), part.levels));
  header.setType(part.tileSize > 0 ? exr::TILEDIMAGE : exr::SCANLINEIMAGE);
  return header;
}

exr::FrameBuffer frameOf(const Part& part) {
  exr::FrameBuffer frame;
  for (const Plane& plane : part.planes)
    frame.insert(plane.name, exr::Slice::Make(plane.type, plane.bytes.data(), box(part.data), size(plane.type),
                                              size(plane.type) * static_cast<std::size_t>(part.data.width())));
  return frame;
}

template <class Output>
void writeLevels(Output& out, const Part& part) {
  out.setFrameBuffer(frameOf(part));
  for (int ly = 0; ly < out.numYLevels(); ++ly)
    for (int lx = 0; lx < out.numXLevels(); ++lx)
      if (out.isValidLevel(lx, ly)) out.writeTiles(0, out.numXTiles(lx) - 1, 0, out.numYTiles(ly) - 1, lx, ly);
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string pattern = std::filesystem::temp_directory_path().string() + "/pellucid-test-XXXXXX";
  folder_ = mkdtemp(pattern.data());
}
TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}
std::vector<std::string> TemporaryFolder::list() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) names.push_back(entry.path().filename());
  return names;
}

std::size_t pixelsOf(const Window& data) {
  return static_cast<std::size_t>(data.width()) * static_cast<std::size_t>(data.height());
}

Plane floatPlane(const std::string& name, const std::vector<float>& values) {
  Plane plane{name, exr::FLOAT, std::vector<std::byte>(values.size() * 4)};
  std::memcpy(plane.bytes.data(), values.data(), plane.bytes.size());
  return plane;
}

Plane halfPlane(const std::string& name, const std::vector<float>& values) {
  Plane plane{name, exr::HALF, std::vector<std::byte>(values.size() * 2)};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint16_t bits = imath_float_to_half(values[i]);
    std::memcpy(plane.bytes.data() + i * 2, &bits, 2);
  }
  return plane;
}

Plane constantPlane(const std::string& name, exr::PixelType type, float value, std::size_t pixels) {
  const std::vector<float> values(pixels, value);
  return type == exr::HALF ? halfPlane(name, values) : floatPlane(name, values);
}

Plane noisePlane(const std::string& name, exr::PixelType type, std::size_t pixels, unsigned seed) {
  Plane plane{name, type, std::vector<std::byte>(pixels * size(type))};
  std::mt19937 random(seed);
  for (std::byte& byte : plane.bytes) byte = static_cast<std::byte>(random() & 255);
  return plane;
}

void writeFile(const std::string& path, const std::vector<Part>& parts) {
  if (parts.size() == 1 && parts[0].tileSize > 0) {
    exr::TiledOutputFile out(path.c_str(), headerOf(parts[0]));
    writeLevels(out, parts[0]);
    return;
  }
  if (parts.size() == 1) {
    exr::OutputFile out(path.c_str(), headerOf(parts[0]));
    out.setFrameBuffer(frameOf(parts[0]));
    out.writePixels(parts[0].data.height());
    return;
  }
  std::vector<exr::Header> headers;
  for (const Part& part : parts) headers.push_back(headerOf(part));
  exr::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].tileSize > 0) {
      exr::TiledOutputPart out(file, static_cast<int>(i));
      writeLevels(out, parts[i]);
    } else {
      exr::OutputPart out(file, static_cast<int>(i));
      out.setFrameBuffer(frameOf(parts[i]));
      out.writePixels(parts[i].data.height());
    }
  }
}

Contents readFile(const std::string& path) {
  exr::MultiPartInputFile file(path.c_str());
  Contents contents;
  for (int i = 0; i < file.parts(); ++i) {
    const exr::Header& header = file.header(i);
    const std::string prefix = std::to_string(i) + "/";
    for (auto it = header.begin(); it != header.end(); ++it) {
      Bytes value;
      it.attribute().writeValueTo(value, 2);
      contents.attributes[prefix + it.name()] = std::string(it.attribute().typeName()) + ":" + value.bytes;
    }
    if (header.hasType() && exr::isDeepData(header.type())) continue;
    Part part;
    const auto& window = header.dataWindow();
    part.data = {window.min.x, window.min.y, window.max.x + 1, window.max.y + 1};
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
      part.planes.push_back(
          {it.name(), it.channel().type, std::vector<std::byte>(pixelsOf(part.data) * size(it.channel().type))});
    exr::InputPart in(file, i);
    in.setFrameBuffer(frameOf(part));
    in.readPixels(window.min.y, window.max.y);
    for (Plane& plane : part.planes) contents.planes[prefix + plane.name] = std::move(plane.bytes);
  }
  return contents;
}

void spit(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace pellucid::test
