// A renderer as small as a sample needs: analytic shapes under one sun and a constant sky, ray cast on the CPU.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "gbuffer/image.h"
#include "samples/generate/view.h"

namespace pellucid::samples {

enum class ShapeKind { box, sphere, cylinder };

// Diffuse colour as a function of the world position. [0,1], linear
using Albedo = std::function<glm::dvec3(glm::dvec3 pWorld)>;

struct Shape {
  ShapeKind kind = ShapeKind::box;
  glm::dvec3 centre{0.0};  // world, metres
  glm::dvec3 half{1.0};    // box: half edges; sphere: radius in x; cylinder (upright): radius in x, half height in y
  double yaw = 0.0;        // radians about +y (box only)
  Albedo albedo;
};

struct Studio {
  std::vector<Shape> shapes;
  glm::dvec3 toSun{0.0, 1.0, 0.0};                    // unit, world
  glm::dvec3 sunIrradiance{0.0};                      // W/m^2 on a plane that faces the sun
  double sunRadius = 0.02;                            // radians, for soft shadows
  glm::dvec3 ambient{0.0};                            // radiance that arrives from everywhere, W/(m^2 sr)
  double ambientReach = 1.5;                          // metres within which a shape hides it
  std::function<glm::dvec3(glm::dvec3 fromEye)> sky;  // radiance where nothing is hit, by unit direction
  bool sunLayer = false;                              // the sun's part of the beauty is a layer of its own
};

// What the render leaves. Beauty and occlusion are filtered over the pixel (box, 16 samples); depth and normal are
// those of the pixel's centre, as renderers write them.
struct OpaquePicture {
  Image<glm::vec3> beauty;  // scene-linear
  Image<float> viewZ;       // planar metres, +inf where nothing was hit
  Image<glm::vec3> normal;  // world, unit; 0 where nothing was hit
  Image<float> occlusion;   // [0,1], 1 = open
  Image<glm::vec3> sun;     // the sun's part of the beauty; empty unless asked for
};

OpaquePicture render(const Studio& studio, const View& view);

// Albedo helpers.
Albedo plain(glm::dvec3 colour);
Albedo checker(glm::dvec3 even, glm::dvec3 odd, double edge);  // cubes of `edge` metres

}  // namespace pellucid::samples
