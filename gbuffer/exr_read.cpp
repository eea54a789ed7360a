#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiView.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledInputPart.h>
#include <fmt/format.h>

#include <Imath/half.h>
#include <algorithm>
#include <cstring>
#include <new>

#include "gbuffer/errors.h"
#include "gbuffer/exr_header.h"
#include "gbuffer/exr_layout.h"
#include "gbuffer/exr_stream.h"

namespace pellucid {
namespace {

// An attribute's value as the file stores it.
class AttributeBytes : public exr::OStream {
 public:
  AttributeBytes() : OStream("attribute") {}
  std::string bytes;
  void write(const char from[], int count) override { bytes.append(from, static_cast<std::size_t>(count)); }
  std::uint64_t tellp() override { return bytes.size(); }
  void seekp(std::uint64_t) override { throw IEX_NAMESPACE::LogicExc("attributes are written in one go"); }
};

std::map<std::string, ExrAttribute> attributesOf(const exr::Header& header) {
  std::map<std::string, ExrAttribute> attributes;
  for (auto it = header.begin(); it != header.end(); ++it) {
    AttributeBytes value;
    it.attribute().writeValueTo(value, 2);
    attributes[it.name()] = {it.attribute().typeName(), std::move(value.bytes)};
  }
  return attributes;
}

const char* compressionName(exr::Compression compression) {
  static constexpr const char* kNames[] = {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"};
  return kNames[compression];
}

ExrPart describePart(const exr::Header& header, const ExrPartLayout& layout) {
  ExrPart part;
  part.header = std::make_shared<ExrPart::Header>(ExrPart::Header{header, !layout.type.empty()});
  part.name = layout.name;
  if (header.hasView()) part.view = header.view();
  part.display = windowOf(header.displayWindow());
  part.data = windowOf(header.dataWindow());
  part.pixelAspect = static_cast<double>(header.pixelAspectRatio());
  part.deep = layout.deep;
  part.tiled = layout.tiled;
  part.levelMode = layout.levelMode;
  part.compression = compressionName(header.compression());
  part.attributes = attributesOf(header);
  if (!layout.type.empty() || !part.attributes.contains("type")) return part;
  part.attributes.erase("type");
  return part;
}

void readChannels(exr::MultiPartInputFile& file, int index, ExrPart& part) {
  const exr::Header& header = file.header(index);
  const std::size_t pixels = static_cast<std::size_t>(part.data.width()) * static_cast<std::size_t>(part.data.height());
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    ExrChannel channel;
    channel.name = it.name();
    const exr::PixelType type = it.channel().type;
    channel.type = type == exr::UINT ? PixelType::uint32 : type == exr::HALF ? PixelType::half : PixelType::float32;
    if (!part.deep) channel.bytes.resize(pixels * bytesOf(channel.type));
    part.channels.push_back(std::move(channel));
  }
  if (part.deep) return;
  exr::FrameBuffer frame;
  for (const ExrChannel& channel : part.channels)
    insertSlice(frame, channel.name, channel.type, channel.bytes.data(), part.data);
  if (part.tiled) {
    exr::TiledInputPart in(file, index);
    in.setFrameBuffer(frame);
    in.readTiles(0, in.numXTiles(0) - 1, 0, in.numYTiles(0) - 1, 0, 0);
  } else {
    exr::InputPart in(file, index);
    in.setFrameBuffer(frame);
    in.readPixels(part.data.y0, part.data.y1 - 1);
  }
}

void noteViews(ExrDocument& document, const exr::Header& first) {
  if (exr::hasMultiView(first)) document.views = exr::multiView(first);
  for (const ExrPart& part : document.parts)
    if (!part.view.empty() &&
        std::find(document.views.begin(), document.views.end(), part.view) == document.views.end())
      document.views.push_back(part.view);
}

void noteOddities(ExrDocument& document) {
  for (const ExrPart& part : document.parts) {
    const std::string where = part.name.empty() ? "" : "part " + part.name + ": ";
    if (part.deep) document.notes.push_back(fmt::format("{}deep samples pass through unread", where));
    if (part.levelMode != 0)
      document.notes.push_back(
          fmt::format("{}{}-mapped: the largest level is read", where, part.levelMode == 1 ? "mip" : "rip"));
  }
}

}  // namespace

const char* nameOf(PixelType type) {
  return type == PixelType::uint32 ? "uint" : type == PixelType::half ? "half" : "float";
}

float ExrChannel::at(std::size_t i) const {
  const std::byte* from = bytes.data() + i * bytesOf(type);
  if (type == PixelType::half) {
    std::uint16_t bits = 0;
    std::memcpy(&bits, from, sizeof bits);
    return imath_half_to_float(bits);
  }
  if (type == PixelType::uint32) {
    std::uint32_t value = 0;
    std::memcpy(&value, from, sizeof value);
    return static_cast<float>(value);
  }
  float value = 0;
  std::memcpy(&value, from, sizeof value);
  return value;
}

const ExrChannel* ExrPart::find(const std::string& channel) const {
  for (const ExrChannel& candidate : channels)
    if (candidate.name == channel) return &candidate;
  return nullptr;
}

std::optional<std::string> ExrPart::text(const std::string& attribute) const {
  const auto found = attributes.find(attribute);
  if (found == attributes.end() || found->second.type != "string") return std::nullopt;
  return found->second.bytes;
}

void insertSlice(exr::FrameBuffer& frame, const std::string& name, PixelType type, const std::byte* bytes,
                 const Window& data) {
  const std::size_t stride = bytesOf(type);
  frame.insert(name, exr::Slice::Make(exrType(type), bytes, boxOf(data), stride,
                                      stride * static_cast<std::size_t>(data.width())));
}

ExrDocument readExr(const std::string& path) {
  const auto source = std::make_shared<ExrSource>(path);
  const ExrLayout layout = checkLayout(*source, path);
  ExrDocument document;
  document.path = path;
  document.multiPart = layout.multiPart;
  try {
    ExrSource stream(*source);
    // Never reconstructing chunk tables: a file that was cut short is refused, not half read.
    exr::MultiPartInputFile file(stream, exrThreads(), false);
    if (file.parts() != static_cast<int>(layout.parts.size()))
      throw InputError(
          fmt::format("{}: damaged: found {} parts, expected {}", path, file.parts(), layout.parts.size()));
    for (int i = 0; i < file.parts(); ++i) {
      if (!file.partComplete(i)) throw InputError(fmt::format("{}: cut short: part {} is not whole", path, i));
      document.parts.push_back(describePart(file.header(i), layout.parts[static_cast<std::size_t>(i)]));
      readChannels(file, i, document.parts.back());
    }
    document.ownParts = document.parts.size();
    noteViews(document, file.header(0));
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw ResourceError(path + ": cannot be read: memory ran out");
  } catch (const std::exception& error) {  // Iex and what OpenEXR's containers throw
    throw InputError(fmt::format("{}: damaged: {}", path, error.what()));
  }
  document.source = source;
  noteOddities(document);
  return document;
}

std::optional<std::string> exrText(const std::string& path, const std::string& name) {
  const auto source = std::make_shared<ExrSource>(path);
  checkLayout(*source, path);
  try {
    exr::MultiPartInputFile file(*source, exrThreads(), false);
    const auto* text = file.header(0).findTypedAttribute<exr::StringAttribute>(name);
    return text ? std::optional<std::string>(text->value()) : std::nullopt;
  } catch (const std::bad_alloc&) {
    throw ResourceError(path + ": cannot be read: memory ran out");
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: damaged: {}", path, error.what()));
  }
}

}  // namespace pellucid
