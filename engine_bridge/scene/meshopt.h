// EXT_meshopt_compression: buffer views unpacked, every mode and filter.
#pragma once
#include <cstdint>
#include <vector>

#include "engine_bridge/scene/gltf_file.h"
#include "engine_bridge/scene/json_view.h"

namespace pellucid::gltf {

// What the view's bytes are once unpacked.
//   extension   of the view: mode, filter, count, byteStride
//   compressed  the bytes it names
// Throws InputError before anything is allocated when the sizes contradict each other or no encoder could have packed
// that much into so little, and when the data is damaged.
std::vector<std::uint8_t> unpackMeshopt(const JsonView& view, const JsonView& extension, Bytes compressed);

}  // namespace pellucid::gltf
