// A whole picture of a scene in double precision: rays through places of the pixels, opaque closed forms, transparent
// triangles by a test of its own, sorted along each ray. Includes nothing of Pellucid's but the scene's numbers.
#pragma once
#include <functional>

#include "tests/reference/bent_rays.h"
#include "tests/reference/closed_solids.h"
#include "tests/reference/lit_surfaces.h"
#include "tests/reference/sorted_over.h"

namespace pellucid::reference {

// A transparent surface on a ray.
struct Crossing {
  Layer layer;         // with its planar depth
  double steep = 1.0;  // how much farther the ray goes for a metre across the surface, at least 1
  Face on;             // Mesh::on
  int mesh = -1;
  Vec3 lightOff{0.0};                       // by what rounding may change what it reflects
  std::optional<Bend> bend = std::nullopt;  // where light enters it and turns
};
// Everything on one ray.
struct Column {
  Ray ray;
  Met opaque;
  std::vector<Crossing> crossings;  // nearest first, those behind what is opaque as well
};
// Masks are cut as if alpha were higher (side 1) or lower (-1) by half of what it changes by, along both axes of the
// picture, over a part of a pixel: where a rim is drawn as a ramp, it lies in between.
struct CutBand {
  double edge = 0.0;  // that part
  int side = 0;
  int mesh = -1;     // of which alone; -1: of all
  int against = -1;  // of all, the one that is cut the other way
};
// What layers do to the background.
struct Shown {
  Vec3 light{0.0}, transmission{1.0};
  Vec3 lightOff{0.0};        // by which rounding may change the light
  std::vector<Bend> bends;   // that displace the background, if any
  double solidZ = kNothing;  // then, of the nearest layer that hides everything: it belongs to the background
  Vec3 over(const Vec3& background) const { return light + transmission * background; }
};

// Whether nothing shows behind a layer.
bool hidesAll(const Layer& layer);

// Answers for rays through one scene, which must outlive it.
class Picture {
 public:
  explicit Picture(const PictureScene& scene);
  const PictureScene& scene() const { return scene_; }
  Column columnAt(double x, double y, const CutBand& band = {}) const;
  // The most texels that a texture changes by from pixel to pixel at a place, whether or not it covers anything there.
  double texelsAPixel(double x, double y) const;
  // What is shown of an opaque face that lies at depth z: what lies on it is in front.
  //   airEnd  depth at which the air ends
  Shown shownBefore(const Column& column, const Face& face, double z, double airEnd) const;
  Shown shownBefore(const Column& column, const Face& face, double z) const { return shownBefore(column, face, z, z); }
  Shown shownBefore(const Column& column) const { return shownBefore(column, column.opaque.face, column.opaque.z); }
  // Of what is opaque, 0 and clear where there is nothing.
  Vec4 background(const Column& column) const;
  bool anyBends() const { return anyBends_; }
  // The picture at a place: sorted light over what is opaque, and how much of it is there; rays go straight on.
  Vec4 at(const Column& column) const;

 private:
  struct Bounds {  // of a triangle in the picture, pixels
    double x0, y0, x1, y1;
  };
  Bounds boundsOf(const Mesh& mesh, const std::array<int, 3>& triangle) const;
  // Takes each triangle of a mesh that may lie at a place, and where its corners are.
  template <class Take>
  void eachNear(std::size_t mesh, double x, double y, const Take& take) const;

  // A place of a triangle.
  struct Place {
    const Mesh& mesh;
    const std::array<int, 3>& triangle;
    Vec3 at, normal;  // world; the normal of the front, unit
    Vec4 colour;
    double covered;
  };
  struct Reflected {
    Vec3 light{0.0}, off{0.0};
  };
  Crossing crossingOf(const Place& place, const Ray& ray, double z) const;
  Reflected lampLight(const Place& place, const Vec3& toEye) const;
  // What of a lamp arrives: as others leave it, and by how much less or more rounding may have it.
  Reflected arriving(const Place& place, const Sent& sent) const;
  // By what surely stands in its way, and by what stands so near to either end that floats do not tell as well.
  struct Left {
    Vec3 surely, perhaps;
  };
  Left leftBy(const Mesh& mesh, const Ray& towards, const Place& place, double metres, double unsure) const;

  const PictureScene& scene_;
  bool anyBends_ = false;
  std::vector<std::vector<Bounds>> bounds_;  // by mesh and triangle
  std::vector<Ball> around_;                 // by mesh
};

}  // namespace pellucid::reference
