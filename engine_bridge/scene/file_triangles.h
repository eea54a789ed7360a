// The triangles of a mesh primitive as its accessors hold them, one at a time.
#pragma once
#include <array>
#include <memory>
#include <string>

#include "engine_bridge/scene/accessor.h"
#include "engine_bridge/scene/triangle_source.h"

namespace pellucid::gltf {

enum PrimitiveMode : std::size_t { kPoints, kLines, kLineLoop, kLineStrip, kTriangles, kTriangleStrip, kTriangleFan };

// What was left out or repaired.
struct Faults {
  std::size_t degenerate = 0, nonFinite = 0, repairedNormals = 0, repairedValues = 0;
};

// A triangle of the file, with or without something to draw.
struct RawTriangle {
  std::array<std::uint32_t, 3> corners;
  glm::vec3 flat{0.0f};  // unit normal
  bool drawn = false;
};

struct FileTriangles {
  std::string place;  // for messages: file and primitive
  std::size_t mode = kTriangles;
  using Shared = std::shared_ptr<const Elements>;  // null for none, but for positions
  Shared positions, normals, tangents, colours;
  std::array<Shared, 2> uvs;
  std::shared_ptr<const Indices> indices;  // null: vertices in order
  std::vector<bool> mirrored;              // by vertex, whether its pose mirrors; empty for none

  std::size_t corners() const { return indices ? indices->count : positions->count; }
  std::size_t triangles() const;  // those without area included
  // Throws InputError for an index without a vertex: the loader has checked them, but a file may change.
  RawTriangle triangle(std::size_t number, Faults& faults) const;
  //   flat  the normal where the file has none
  Vertex vertex(std::size_t number, glm::vec3 flat, Faults& faults) const;

  // Whether triangles share this vertex: it has a normal of its own.
  bool shared(std::size_t number) const;

  // Triangles [first, first + count) are about to be read, and no others any more: tells their files. False when their
  // vertices lie so far apart that announceOne() must tell of each triangle.
  bool announce(std::size_t first, std::size_t count) const;
  void announceOne(std::size_t number) const;
  // Throws InputError when one of the files could not be read.
  void requireWhole() const;

 private:
  std::array<std::uint32_t, 3> cornersOf(std::size_t number) const;
  std::uint32_t corner(std::size_t i) const { return indices ? indices->at(i) : static_cast<std::uint32_t>(i); }
  void announceCorners(std::size_t first, std::size_t count) const;
  void announceVertices(std::size_t first, std::size_t last) const;
  template <class Visit>
  void eachAttribute(const Visit& visit) const;
};

// Goes over all triangles once, then decodes any of them again and again.
//   faults  counted as if every vertex were decoded once
std::shared_ptr<const TriangleSource> streamTriangles(FileTriangles triangles, Faults& faults);
// The same triangles seen from the other side.
std::shared_ptr<const TriangleSource> mirroredTriangles(const std::shared_ptr<const TriangleSource>& source);

}  // namespace pellucid::gltf
