// Accessors as floats or indices, every bound checked against its buffer view before a byte is read.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "engine_bridge/scene/gltf_file.h"

namespace pellucid::gltf {

// Which integer components an attribute may have, next to floats. `any` with KHR_mesh_quantization only.
// `asNormalised`: bytes and shorts are parts of the largest, whether the file says so or not.
enum class Integers { none, normalised, any, asNormalised };

// What an accessor says that its elements are, checked.
struct ElementType {
  std::size_t width = 0, component = 0, count = 0;
  bool normalised = false;
  bool integer() const;
  // A component's value as glTF reads it.
  float valueOf(double component) const;
};

// Decoded; or in place, where each is decoded when it is asked for.
struct Elements {
  std::size_t count = 0;
  std::size_t width = 0;      // components of one element
  std::vector<float> values;  // count * width, may be non-finite as the file has them; empty when in place
  ElementType type;           // in place
  SharedBytes bytes;          // in place: from the first element to the last
  std::size_t stride = 0;     // in place: bytes from one element to the next
  float at(std::size_t element, std::size_t component) const {
    return values.empty() ? placedAt(element, component) : values[element * width + component];
  }
  // These are about to be read; what was announced before is read no more.
  void announce(std::size_t first, std::size_t last) const;
  void settle() const;
  void requireWhole() const;

 private:
  float placedAt(std::size_t element, std::size_t component) const;
};

ElementType elementType(GltfFile& file, const JsonView& reference, std::initializer_list<std::size_t> widths,
                        Integers integers);

// Throws InputError naming the accessor: wrong type, past its view, absurd count, sparse index out of range.
//   reference  the JSON number that names the accessor, as in attributes.POSITION
//   widths     components allowed: {3} for VEC3, {3, 4} for VEC3 or VEC4, {16} for MAT4
//   inPlace    leave them where they lie, unless some are sparse or none lies anywhere
Elements readElements(GltfFile& file, const JsonView& reference, std::initializer_list<std::size_t> widths,
                      Integers integers, bool inPlace = false);

// SCALAR of unsigned byte, short or int. Throws InputError.
std::vector<std::uint32_t> readIndices(GltfFile& file, const JsonView& reference);

// The same, in place where they can be.
struct Indices {
  std::size_t count = 0;
  std::vector<std::uint32_t> values;  // empty when in place
  std::size_t component = 0;          // in place: 5121, 5123 or 5125
  SharedBytes bytes;
  std::size_t stride = 0;
  std::uint32_t at(std::size_t i) const { return values.empty() ? placedAt(i) : values[i]; }
  void announce(std::size_t first, std::size_t last) const;
  void settle() const;
  void requireWhole() const;

 private:
  std::uint32_t placedAt(std::size_t i) const;
};
Indices placeIndices(GltfFile& file, const JsonView& reference);

}  // namespace pellucid::gltf
