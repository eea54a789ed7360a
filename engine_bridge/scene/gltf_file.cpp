#include "engine_bridge/scene/gltf_file.h"

#include <fmt/format.h>

#include <cstring>

#include "engine_bridge/scene/meshopt.h"
#include "engine_bridge/scene/uri.h"
#include "engine_bridge/scene/utf8.h"
#include "gbuffer/errors.h"

namespace pellucid::gltf {

namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN\0"
constexpr int kMostNesting = 200;                 // levels of JSON; real files have about ten

std::uint32_t littleEndian32(Bytes bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

// What compressed views may unpack to, all together.
constexpr std::size_t kFreeUnpacked = std::size_t{1} << 24, kUnpackedPerByte = 64;

// Counted beforehand: the parser's own callback makes it take quadratic time.
bool nestedTooDeep(Bytes text) {
  int depth = 0;
  bool quoted = false, escaped = false;
  for (const std::uint8_t c : text) {
    if (quoted) {
      quoted = escaped || c != '"';
      escaped = !escaped && c == '\\';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMostNesting) return true;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return false;
}

std::vector<std::uint8_t> dataUriBytes(const std::string& uri, const std::string& whose) {
  std::vector<std::uint8_t> bytes;
  if (!decodeDataUri(uri, bytes)) throw InputError(fmt::format("{}: its data: URI is malformed", whose));
  return bytes;
}

}  // namespace

GltfFile::GltfFile(const std::string& path, std::shared_ptr<PageLedger> ledger, const std::string& assetRoot)
    : path_(path),
      named_(path, assetRoot),
      ledger_(std::move(ledger)),
      content_(std::make_shared<MappedFile>(path, "glTF scene", ledger_)) {
  bytesRead_ = content_.size();
  const Bytes all = content_.bytes();
  if (all.size() < 4 || littleEndian32(all, 0) != kGlbMagic) {
    parseJson(all);
    return;
  }
  if (all.size() < 20) throw InputError(fmt::format("{}: has {} bytes; a GLB has at least 20", path_, all.size()));
  const std::uint32_t version = littleEndian32(all, 4);
  const std::uint32_t length = littleEndian32(all, 8);
  if (version != 2) throw InputError(fmt::format("{}: is GLB version {}; expected 2", path_, version));
  if (length > all.size()) {
    throw InputError(
        fmt::format("{}: is cut short: found {} bytes, its header promises {}", path_, all.size(), length));
  }
  Bytes text;
  bool hasText = false;
  // 64-bit positions: chunk lengths up to 2^32 - 1 cannot overflow them.
  for (std::size_t at = 12; at + 8 <= length;) {
    const std::size_t size = littleEndian32(all, at);
    const std::uint32_t kind = littleEndian32(all, at + 4);
    if (size > length - at - 8) {
      throw InputError(
          fmt::format("{}: a chunk of {} bytes starts at {}; the file ends at {}", path_, size, at, length));
    }
    const Bytes chunk = all.subspan(at + 8, size);
    if (kind == kJsonChunk && !hasText) {
      text = chunk;
      hasText = true;
    } else if (kind == kBinChunk && !hasBinary_) {
      binary_ = content_.part(at + 8, size);
      hasBinary_ = true;
    }
    at += 8 + (size + 3) / 4 * 4;
  }
  if (!hasText) throw InputError(fmt::format("{}: has no JSON chunk", path_));
  parseJson(text);
}

void GltfFile::parseJson(Bytes text) {
  if (nestedTooDeep(text)) {
    throw InputError(fmt::format("{}: JSON is nested deeper than {} levels", path_, kMostNesting));
  }
  const std::optional<std::string> repaired = fromLatin1(text);
  repairedText_ = repaired.has_value();
  try {
    json_ = repaired ? nlohmann::json::parse(*repaired) : nlohmann::json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::exception& error) {
    requireWhole();
    throw InputError(printable(fmt::format("{}: is not glTF: {}", path_, error.what())));
  }
  requireWhole();
  content_.file()->letGo(text);
  const std::string version = root().at("asset").at("version").string();
  const std::string least = root().at("asset").string("minVersion", "2.0");
  if (version.substr(0, 2) != "2." || least != "2.0") {
    throw InputError(printable(fmt::format("{}: is glTF version {} (needs {}); expected 2.0", path_, version, least)));
  }
}

bool GltfFile::uses(const char* extension) const {
  const std::optional<JsonView> used = root().find("extensionsUsed");
  for (std::size_t i = 0; used && i < used->size(); ++i)
    if (used->at(i).string() == extension) return true;
  return false;
}

std::size_t GltfFile::count(const char* array) const {
  const std::optional<JsonView> all = root().find(array);
  return all ? all->size() : 0;
}

JsonView GltfFile::item(const char* array, std::size_t index) const {
  return root().at(array).at(index);
}

JsonView GltfFile::item(const char* array, const JsonView& reference) const {
  return item(array, reference.index(count(array), array));
}

SharedBytes GltfFile::viewBytes(const JsonView& view) {
  const std::optional<JsonView> packed = view.extension("EXT_meshopt_compression");
  if (!packed) return rangeOf(view);
  auto cached = unpacked_.find(view.where());
  if (cached == unpacked_.end()) {
    cached = unpacked_.emplace(view.where(), SharedBytes(unpackMeshopt(view, *packed, rangeOf(*packed).bytes()))).first;
    bytesUnpacked_ += cached->second.size();
    // One compressed range that many views name.
    if (bytesUnpacked_ > kFreeUnpacked + kUnpackedPerByte * bytesRead_) {
      view.refuse(fmt::format("takes the file's unpacked views to {} bytes; expected at most {} a byte of it",
                              bytesUnpacked_, kUnpackedPerByte));
    }
  }
  return cached->second;
}

SharedBytes GltfFile::rangeOf(const JsonView& view) {
  const std::size_t offset = view.unsignedInteger("byteOffset", 0);
  const std::size_t length = view.at("byteLength").unsignedInteger();
  const JsonView reference = view.at("buffer");
  const SharedBytes buffer = bufferBytes(reference.index(count("buffers"), "buffers"));
  if (offset > buffer.size() || length > buffer.size() - offset) {
    view.refuse(fmt::format("covers bytes {} to {}; its buffer has {}", offset, offset + length, buffer.size()));
  }
  return buffer.part(offset, length);
}

SharedBytes GltfFile::bufferBytes(std::size_t index) {
  const JsonView buffer = item("buffers", index);
  const std::size_t length = buffer.at("byteLength").unsignedInteger();
  const std::optional<JsonView> uri = buffer.find("uri");
  SharedBytes found;
  if (!uri) {
    if (index != 0 || !hasBinary_) buffer.refuse("has no uri, and the file no binary chunk for it");
    found = binary_;
  } else {
    auto cached = buffers_.find(index);
    if (cached == buffers_.end()) {
      cached = buffers_.emplace(index, uriBuffer(uri->string(), path_ + ": " + buffer.where())).first;
      bytesRead_ += cached->second.size();
    }
    found = cached->second;
  }
  if (found.size() < length) {
    buffer.refuse(fmt::format("is cut short: found {} bytes, byteLength promises {}", found.size(), length));
  }
  return found.part(0, length);
}

void GltfFile::requireWhole() const {
  content_.file()->requireWhole();
  for (const auto& [index, buffer] : buffers_)
    if (buffer.file()) buffer.file()->requireWhole();
}

OpenFile GltfFile::openNamed(const std::string& uri, const std::string& whose) const {
  const std::string_view scheme = uriScheme(uri);
  if (!scheme.empty()) {
    throw InputError(
        fmt::format("{}: its URI has the scheme {}; expected data: or a file beside the scene", whose, scheme));
  }
  if (decodePercent(uri).find('\0') != std::string::npos)
    throw InputError(fmt::format("{}: its URI holds a zero byte", whose));
  return named_.open(uri, printable(whose));
}

SharedBytes GltfFile::uriBuffer(const std::string& uri, const std::string& whose) const {
  if (isDataUri(uri)) return SharedBytes(dataUriBytes(uri, whose));
  return SharedBytes(std::make_shared<MappedFile>(openNamed(uri, whose), printable(whose), ledger_));
}

std::vector<std::uint8_t> GltfFile::uriBytes(const std::string& uri, const std::string& whose) const {
  return isDataUri(uri) ? dataUriBytes(uri, whose) : readWhole(openNamed(uri, whose), printable(whose));
}

}  // namespace pellucid::gltf
