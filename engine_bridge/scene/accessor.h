// Accessors decoded to floats or indices, every bound checked against its buffer view before a byte is read.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "engine_bridge/scene/gltf_file.h"

namespace pellucid::gltf {

struct Elements {
  std::size_t count = 0;
  std::size_t width = 0;      // components of one element
  std::vector<float> values;  // count * width, may be non-finite as the file has them
  float at(std::size_t element, std::size_t component) const { return values[element * width + component]; }
};

// Which integer components an attribute may have, next to floats. `any` with KHR_mesh_quantization only.
enum class Integers { none, normalised, any };

// What an accessor says that its elements are, checked.
struct ElementType {
  std::size_t width = 0, component = 0, count = 0;
  bool normalised = false;
  bool integer() const;
  // A component's value as glTF reads it.
  float valueOf(double component) const;
};
ElementType elementType(GltfFile& file, const JsonView& reference, std::initializer_list<std::size_t> widths,
                        Integers integers);

// Throws InputError naming the accessor: wrong type, past its view, absurd count, sparse index out of range.
//   reference  the JSON number that names the accessor, as in attributes.POSITION
//   widths     components allowed: {3} for VEC3, {3, 4} for VEC3 or VEC4, {16} for MAT4
Elements readElements(GltfFile& file, const JsonView& reference, std::initializer_list<std::size_t> widths,
                      Integers integers);

// SCALAR of unsigned byte, short or int. Throws InputError.
std::vector<std::uint32_t> readIndices(GltfFile& file, const JsonView& reference);

}  // namespace pellucid::gltf
