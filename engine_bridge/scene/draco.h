// KHR_draco_mesh_compression: one primitive's triangles and attributes, unpacked.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine_bridge/scene/accessor.h"
#include "engine_bridge/scene/gltf_file.h"

namespace pellucid::gltf {

class DracoMesh {
 public:
  // Throws InputError for damaged data, and before anything is unpacked when the data claims more triangles than its
  // bytes could hold or than the primitive's indices have.
  //   extension  the primitive's KHR_draco_mesh_compression
  DracoMesh(GltfFile& file, const JsonView& primitive, const JsonView& extension);
  ~DracoMesh();
  DracoMesh(const DracoMesh&) = delete;
  DracoMesh& operator=(const DracoMesh&) = delete;

  std::size_t vertices() const;
  // Corners of triangles, as the primitive's indices would name them.
  std::vector<std::uint32_t> corners() const;

  // Whether an attribute of the primitive is in the compressed data.
  bool has(const char* attribute) const;
  // Its values, one element a vertex, read as its accessor says. Throws InputError.
  Elements elements(const char* attribute, const ElementType& type) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid::gltf
