// Mesh primitives of a glTF file to indexed triangles.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "engine_bridge/scene/accessor.h"
#include "engine_bridge/scene/draco.h"
#include "engine_bridge/scene/gltf_file.h"
#include "engine_bridge/scene/pose.h"
#include "engine_bridge/scene/scene.h"

namespace pellucid::gltf {

// Reads one file's primitives; remembers only what spares repeated decoding of shared vertex buffers.
class PrimitiveReader {
 public:
  //   metresPerUnit is not applied here: vertices are object space
  PrimitiveReader(GltfFile& file, Notes& notes);

  // Empty when the primitive has no triangle to draw (points, lines, all degenerate), which is noted.
  // Throws InputError (damaged accessors, index out of range, absurd growth).
  //   primitive  meshes[i].primitives[j]; its material is left to the caller
  std::optional<Primitive> read(const JsonView& primitive, const Pose& pose);

  // One note for each kind of thing that was left out or repaired in all primitives read so far.
  void noteCounts();

 private:
  const Elements* attribute(const JsonView& attributes, const char* name, std::initializer_list<std::size_t> widths,
                            Integers integers, std::size_t vertexCount);
  std::vector<std::uint32_t> cornerOrder(const JsonView& primitive, std::size_t vertexCount);
  std::vector<std::uint32_t> triangleCorners(const JsonView& primitive, std::size_t vertexCount);
  void charge(std::size_t elements, const JsonView& user);

  struct Cached {
    std::size_t accessor = 0;
    Elements elements;
  };
  GltfFile* file_;
  Notes* notes_;
  bool quantised_ = false;               // KHR_mesh_quantization
  std::unique_ptr<DracoMesh> draco_;     // of the primitive being read
  std::map<std::string, Cached> cache_;  // by attribute name: the accessor decoded last
  std::vector<std::uint32_t> compact_;   // vertex in the file to vertex kept; kUnused outside read()
  std::size_t charged_ = 0;              // elements decoded and made
  std::size_t degenerate_ = 0, nonFinite_ = 0, repairedNormals_ = 0, repairedValues_ = 0, points_ = 0, unfinished_ = 0,
              unbound_ = 0;
};

// The same triangles seen from the other side: for instances whose transform mirrors.
Primitive withFlippedWinding(Primitive primitive);

}  // namespace pellucid::gltf
