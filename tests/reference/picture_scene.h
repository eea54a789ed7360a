// The numbers of a small picture, as traced_picture.h renders it: closed forms that are opaque, meshes that are
// transparent. Includes nothing of Pellucid's. World space is right-handed, lengths are metres.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <variant>
#include <vector>

namespace pellucid::reference {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec4 = glm::dvec4;

struct Eye {
  Vec3 at{0.0};
  glm::dmat3 axes{1.0};  // columns: right, up, backwards; orthonormal
  Vec2 half{0.5, 0.5};   // half of the picture at distance 1, or in metres where rays are parallel
  bool parallel = false;
  int width = 32, height = 24;                // pixels that are rendered
  int displayWidth = 32, displayHeight = 24;  // of the whole picture, of which those are a part
  int firstX = 0, firstY = 0;                 // that begins there
};

struct Plane {
  Vec3 point, normal;
};
struct Ball {
  Vec3 centre;
  double radius;
};
struct Box {
  Vec3 centre;
  glm::dmat3 axes;  // columns, orthonormal
  Vec3 half;
};
// Opaque, of one colour, or with stripes: colour + stripes * sin(dot(across, point)).
struct Solid {
  std::variant<Plane, Ball, Box> shape;
  Vec3 colour{0.5};
  Vec3 stripes{0.0}, across{0.0};
};

// A face of a solid: a box has six of them.
struct Face {
  int solid = -1, side = 0;
  bool operator==(const Face&) const = default;
};

enum class Wrap { repeat, mirror, clamp };
struct Texels {
  int width = 1, height = 1;
  std::vector<Vec4> values;  // linear light and straight alpha, row 0 at v = 0
  Wrap wrapS = Wrap::repeat, wrapT = Wrap::repeat;
  bool nearest = false;
};

enum class Covering { blend, mask };
// What fills a sheet of glass: light bends where it enters a front.
struct Filling {
  double index = 1.0;        // of refraction, inside over outside; 1 bends nothing
  double dispersion = 0.0;   // 20 over the Abbe number
  double thickness = 0.0;    // metres along the normal; above 0 where anything fills it
  double clearness = 1e300;  // metres over which light takes on the colour below
  Vec3 colour{1.0};
  bool mirrors = false;  // as a smooth dielectric of this index does
};
// How light meets a surface.
struct Finish {
  bool lit = false;        // else what is no glass shows its colour
  double roughness = 0.0;  // glTF's, and its metallic and transmission factors
  double metal = 0.0;
  double passes = 1.0;
};
// A surface that no light meets shows its colour, and what it covers lets nothing through. Glass shows what it emits,
// what it reflects, and what lies behind times its colour.
struct Coat {
  Vec4 colour{1.0};
  bool glass = false;
  Vec3 emission{0.0};  // of glass
  Filling filling;     // of glass
  Finish finish;
  Covering covering = Covering::blend;
  double cutoff = 0.5;
  bool bothSides = true;
  int texture = -1;        // that multiplies the colour
  glm::dmat3 fromUv{1.0};  // of texture coordinates
};

struct Corner {
  Vec3 at{0.0};  // world
  Vec2 uv{0.0};
  Vec4 colour{1.0};
};
struct Mesh {
  std::vector<Corner> corners;
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from their front
  Coat coat;
  Face on;  // on which all of it lies, if any: there it is in front, whatever its corners round to
};

constexpr double kAirBeforeNothing = 1000.0;  // metres

// Even fog under even light, up to what is opaque.
struct EvenAir {
  double density = 0.0;  // extinction of a metre
  Vec3 light{0.0};       // that all of it would show
  // Metres from the eye, or from the eye's plane, beyond which there is none; without it kAirBeforeNothing before
  // nothing, and all of it before what is opaque.
  std::optional<double> farthest;
  std::optional<Box> inside;  // along the world's axes
};

// Where bent rays meet what they show.
struct Bending {
  enum class Until { never, distance, depth, slab };
  Until until = Until::depth;
  double distance = 2.0;  // metres behind the surface, along the eye's axis
};

// KHR_lights_punctual
struct PunctualLamp {
  enum class Kind { sun, point, spot };
  Kind kind = Kind::point;
  Vec3 at{0.0}, along{0, 0, -1};            // unit: where its light goes
  Vec3 intensity{1.0};                      // W/m^2 of a sun, else W/sr
  double range = 0.0;                       // metres, 0 without an end
  double innerCone = 0.0, outerCone = 0.7;  // radians
};

struct PictureScene {
  Eye eye;
  EvenAir air;
  Bending bending;
  Vec3 surroundings{0.0};  // radiance from everywhere, that glass mirrors
  std::vector<PunctualLamp> lamps;
  bool shadows = false;  // of everything, on what is lit
  std::vector<Solid> solids;
  std::vector<Texels> textures;
  std::vector<Mesh> meshes;
};

}  // namespace pellucid::reference
