#include "engine_bridge/scene/meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

namespace pellucid::gltf {

namespace {

// The vertex codec spends at least one header byte on 64 values of one byte each; the index codecs spend more.
constexpr std::size_t kMostPerByte = 64;
constexpr std::size_t kMostStride = 256;

struct Packed {
  std::string mode, filter;
  std::size_t count = 0, stride = 0;
};

void checkStride(const JsonView& extension, const Packed& packed) {
  const auto refuse = [&](const char* expected) {
    extension.at("byteStride")
        .refuse(fmt::format("is {} in mode {}, filter {}; expected {}", packed.stride, packed.mode, packed.filter,
                            expected));
  };
  if (packed.mode != "ATTRIBUTES") {
    if (packed.stride != 2 && packed.stride != 4) refuse("2 or 4");
    return;
  }
  if (packed.stride < 4 || packed.stride > kMostStride || packed.stride % 4 != 0) refuse("a multiple of 4 up to 256");
  if (packed.filter == "OCTAHEDRAL" && packed.stride != 4 && packed.stride != 8) refuse("4 or 8");
  if (packed.filter == "QUATERNION" && packed.stride != 8) refuse("8");
}

Packed checked(const JsonView& view, const JsonView& extension, std::size_t compressedSize) {
  Packed packed;
  packed.mode = extension.at("mode").string();
  packed.filter = extension.string("filter", "NONE");
  packed.count = extension.at("count").unsignedInteger();
  packed.stride = extension.at("byteStride").unsignedInteger();
  if (packed.mode != "ATTRIBUTES" && packed.mode != "TRIANGLES" && packed.mode != "INDICES")
    extension.at("mode").refuse(fmt::format("is {}; expected ATTRIBUTES, TRIANGLES or INDICES", packed.mode));
  const bool filtered = packed.filter != "NONE";
  if (filtered && packed.filter != "OCTAHEDRAL" && packed.filter != "QUATERNION" && packed.filter != "EXPONENTIAL")
    extension.at("filter").refuse(
        fmt::format("is {}; expected NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL", packed.filter));
  if (filtered && packed.mode != "ATTRIBUTES")
    extension.at("filter").refuse(fmt::format("is {} in mode {}; expected NONE", packed.filter, packed.mode));
  checkStride(extension, packed);
  const JsonView count = extension.at("count");
  if (packed.count < 1 || (packed.mode == "TRIANGLES" && packed.count % 3 != 0))
    count.refuse(fmt::format("is {}; expected at least 1, and a multiple of 3 for triangles", packed.count));
  // In this order no product overflows.
  if (packed.count > kMostPerByte * compressedSize || packed.count * packed.stride > kMostPerByte * compressedSize)
    count.refuse(fmt::format("is {}, of {} bytes each; {} compressed bytes hold at most {}", packed.count,
                             packed.stride, compressedSize, kMostPerByte * compressedSize));
  const std::size_t promised = view.at("byteLength").unsignedInteger();
  if (promised != packed.count * packed.stride)
    view.at("byteLength")
        .refuse(fmt::format("is {}; its {} compressed elements of {} bytes make {}", promised, packed.count,
                            packed.stride, packed.count * packed.stride));
  const std::size_t stride = view.unsignedInteger("byteStride", packed.stride);
  if (stride != packed.stride)
    view.at("byteStride").refuse(fmt::format("is {}; its compressed elements have {} bytes", stride, packed.stride));
  return packed;
}

}  // namespace

std::vector<std::uint8_t> unpackMeshopt(const JsonView& view, const JsonView& extension, Bytes compressed) {
  const Packed packed = checked(view, extension, compressed.size());
  std::vector<std::uint8_t> bytes(packed.count * packed.stride);
  int problem = 0;
  if (packed.mode == "ATTRIBUTES")
    problem =
        meshopt_decodeVertexBuffer(bytes.data(), packed.count, packed.stride, compressed.data(), compressed.size());
  else if (packed.mode == "TRIANGLES")
    problem =
        meshopt_decodeIndexBuffer(bytes.data(), packed.count, packed.stride, compressed.data(), compressed.size());
  else
    problem =
        meshopt_decodeIndexSequence(bytes.data(), packed.count, packed.stride, compressed.data(), compressed.size());
  if (problem != 0)
    extension.refuse(fmt::format("is damaged: {} bytes do not decode to {} elements of {} bytes in mode {}",
                                 compressed.size(), packed.count, packed.stride, packed.mode));
  if (packed.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), packed.count, packed.stride);
  if (packed.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), packed.count, packed.stride);
  if (packed.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), packed.count, packed.stride);
  return bytes;
}

}  // namespace pellucid::gltf
