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
#include "engine_bridge/scene/file_triangles.h"
#include "engine_bridge/scene/gltf_file.h"
#include "engine_bridge/scene/points.h"
#include "engine_bridge/scene/pose.h"
#include "engine_bridge/scene/scene.h"

namespace pellucid::gltf {

// Reads one file's primitives; remembers only what spares repeated decoding of shared vertex buffers.
class PrimitiveReader {
 public:
  //   metresPerUnit is not applied here: vertices are object space
  //   stream  leave triangles where they are: Primitive::streamed
  PrimitiveReader(GltfFile& file, Notes& notes, bool stream);

  // Empty when the primitive has no triangle to draw (lines, all degenerate, no POSITION), which is noted.
  // Throws InputError (damaged accessors, index out of range, absurd growth).
  //   primitive  meshes[i].primitives[j]; its material is left to the caller
  //   decode     even when streaming
  std::optional<Primitive> read(const JsonView& primitive, const Pose& pose, bool decode);

  // Forgets what has been charged to the file: for another pose of it.
  void startOver() { charged_ = 0; }

  // One note for each kind of thing that was left out or repaired in all primitives read so far.
  void noteCounts();

 private:
  using Shared = std::shared_ptr<const Elements>;
  Shared attribute(const JsonView& attributes, const char* name, std::initializer_list<std::size_t> widths,
                   Integers integers, std::size_t vertexCount);
  Shared vertexColours(const JsonView& attributes, std::size_t vertexCount);  // null where there are none
  bool hasVertices(const JsonView& primitive);  // what lacks them, or indices that it names, is noted
  std::optional<Primitive> points(const JsonView& primitive, const Pose& pose);
  void readCorners(const JsonView& primitive, FileTriangles& triangles);
  Primitive decoded(const FileTriangles& triangles);
  void charge(std::size_t elements, const JsonView& user);

  struct Cached {
    std::size_t accessor = 0;
    bool inPlace = false;
    Shared elements;
  };
  GltfFile* file_;
  Notes* notes_;
  bool stream_;
  bool inPlace_ = false;                 // the primitive being read
  bool quantised_ = false;               // KHR_mesh_quantization
  std::unique_ptr<DracoMesh> draco_;     // of the primitive being read
  std::map<std::string, Cached> cache_;  // by attribute name: the accessor read last
  std::vector<std::uint32_t> compact_;   // vertex in the file to vertex kept; kUnused outside read()
  std::size_t charged_ = 0;              // elements decoded and made
  Faults faults_;
  PointFaults pointFaults_;
  std::size_t lines_ = 0, withoutRadius_ = 0, unfinished_ = 0, wholeColours_ = 0;
  PoseRepairs repairs_;
};

// The same triangles seen from the other side: for instances whose transform mirrors.
Primitive withFlippedWinding(Primitive primitive);

}  // namespace pellucid::gltf
