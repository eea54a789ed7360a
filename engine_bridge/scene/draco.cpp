#include "engine_bridge/scene/draco.h"

#include <draco/compression/decode.h>
#include <draco/core/decoder_buffer.h>
#include <draco/metadata/geometry_metadata.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/format.h>

#include <cstring>

namespace pellucid::gltf {

namespace {

// Triangles that compressed data may claim: this many, and so many more for each of its bytes. A flat grid of 50,000
// has 11 a byte.
constexpr std::size_t kFreeTriangles = std::size_t{1} << 16, kTrianglesPerByte = 256;

enum Mode : std::size_t { kTriangles = 4, kTriangleStrip = 5 };

// Draco's variable-length integers: seven bits a byte, the lowest first.
bool readVarint(draco::DecoderBuffer& buffer, std::uint64_t& value) {
  value = 0;
  for (int shift = 0; shift < 35; shift += 7) {
    std::uint8_t byte = 0;
    if (!buffer.Decode(&byte)) return false;
    value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return true;
  }
  return false;
}

// How many triangles the data claims to hold. Draco's decoder allocates by that number before it looks further.
std::size_t claimedTriangles(Bytes bytes, const JsonView& extension) {
  constexpr std::size_t kHeader = 11;
  constexpr std::uint8_t kMesh = 1, kSequential = 0, kEdgebreaker = 1;
  if (bytes.size() < kHeader || std::memcmp(bytes.data(), "DRACO", 5) != 0)
    extension.refuse(fmt::format("is damaged: its {} bytes are not Draco data", bytes.size()));
  const int major = bytes[5], minor = bytes[6];
  if (major != 2 || minor != 2)
    extension.refuse(fmt::format("is Draco bitstream {}.{}; the extension is 2.2", major, minor));
  const std::uint8_t kind = bytes[7], method = bytes[8];
  if (kind != kMesh || method > kEdgebreaker)
    extension.refuse(fmt::format("holds Draco geometry of kind {}, method {}; expected a mesh", kind, method));
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size(), DRACO_BITSTREAM_VERSION(2, 2));
  buffer.Advance(kHeader);
  const bool hasMetadata = (bytes[10] & 0x80) != 0;
  draco::GeometryMetadata metadata;
  bool sound = !hasMetadata || draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata);
  std::uint64_t vertices = 0, triangles = 0;
  if (method == kSequential) {
    sound = sound && readVarint(buffer, triangles) && readVarint(buffer, vertices);
  } else {
    std::uint8_t traversal = 0;
    sound = sound && buffer.Decode(&traversal) && readVarint(buffer, vertices) && readVarint(buffer, triangles);
  }
  if (!sound || triangles == 0 || vertices > 3 * triangles)
    extension.refuse(fmt::format("is damaged: its header tells of {} triangles with {} vertices", triangles, vertices));
  return triangles;
}

void checkTriangles(std::size_t triangles, std::size_t compressed, const JsonView& extension, const JsonView& primitive,
                    GltfFile& file) {
  const std::size_t most = kFreeTriangles + kTrianglesPerByte * compressed;
  if (triangles > most)
    extension.refuse(fmt::format("claims {} triangles in {} bytes; expected at most {}", triangles, compressed, most));
  const std::optional<JsonView> indices = primitive.find("indices");
  if (!indices) return;
  const std::size_t count = file.item("accessors", *indices).at("count").unsignedInteger();
  const bool strip = primitive.unsignedInteger("mode", kTriangles) == kTriangleStrip;
  if (strip ? triangles + 2 > count : 3 * triangles != count)
    indices->refuse(fmt::format("have {} elements; the compressed data has {} triangles", count, triangles));
}

}  // namespace

struct DracoMesh::Impl {
  std::unique_ptr<draco::Mesh> mesh;
  JsonView extension;
};

DracoMesh::DracoMesh(GltfFile& file, const JsonView& primitive, const JsonView& extension) {
  const std::size_t mode = primitive.unsignedInteger("mode", kTriangles);
  if (mode != kTriangles && mode != kTriangleStrip)
    extension.refuse(fmt::format("is on a primitive of mode {}; expected 4 or 5", mode));
  const SharedBytes view = file.viewBytes(file.item("bufferViews", extension.at("bufferView")));
  const Bytes bytes = view.bytes();
  checkTriangles(claimedTriangles(bytes, extension), bytes.size(), extension, primitive, file);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) extension.refuse("is damaged: " + printable(decoded.status().error_msg_string()));
  impl_ = std::make_unique<Impl>(Impl{std::move(decoded).value(), extension});
}

DracoMesh::~DracoMesh() = default;

std::size_t DracoMesh::vertices() const {
  return impl_->mesh->num_points();
}

std::vector<std::uint32_t> DracoMesh::corners() const {
  std::vector<std::uint32_t> corners;
  corners.reserve(std::size_t{3} * impl_->mesh->num_faces());
  for (std::uint32_t i = 0; i < impl_->mesh->num_faces(); ++i) {
    for (const draco::PointIndex& corner : impl_->mesh->face(draco::FaceIndex(i))) {
      if (corner.value() >= vertices())
        impl_->extension.refuse(
            fmt::format("is damaged: a triangle names vertex {} of {}", corner.value(), vertices()));
      corners.push_back(corner.value());
    }
  }
  return corners;
}

bool DracoMesh::has(const char* attribute) const {
  return impl_->extension.at("attributes").find(attribute).has_value();
}

Elements DracoMesh::elements(const char* name, const ElementType& type) const {
  const JsonView reference = impl_->extension.at("attributes").at(name);
  const std::size_t id = reference.unsignedInteger();
  const draco::PointAttribute* attribute =
      id > 0xffffffffu ? nullptr : impl_->mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
  if (!attribute) reference.refuse(fmt::format("is {}; the compressed data has no attribute of that number", id));
  if (attribute->num_components() != type.width)
    reference.refuse(fmt::format("has {} components in the compressed data; its accessor has {}",
                                 attribute->num_components(), type.width));
  const bool floating = attribute->data_type() == draco::DT_FLOAT32 || attribute->data_type() == draco::DT_FLOAT64;
  Elements elements;
  elements.count = vertices();
  elements.width = type.width;
  elements.values.resize(elements.count * elements.width);
  const auto width = static_cast<std::int8_t>(type.width);
  for (std::uint32_t i = 0; i < elements.count; ++i) {
    const draco::AttributeValueIndex at = attribute->mapped_index(draco::PointIndex(i));
    float* const values = &elements.values[i * elements.width];
    std::int32_t integers[4] = {};
    const bool sound = at.value() < attribute->size() && (floating ? attribute->ConvertValue(at, width, values)
                                                                   : attribute->ConvertValue(at, width, integers));
    if (!sound) reference.refuse(fmt::format("is damaged: vertex {} has no value", i));
    for (std::size_t c = 0; !floating && c < type.width; ++c) values[c] = type.valueOf(integers[c]);
  }
  return elements;
}

}  // namespace pellucid::gltf
