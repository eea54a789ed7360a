// What random scenes are put together from. Coordinates are the eye's: x right, y up, things before it at negative z.
#pragma once
#include <cmath>

#include "tests/pictures/drawn_scene.h"

namespace pellucid::test {

using reference::Vec2;
using reference::Vec3;
using reference::Vec4;

glm::dmat3 turned(Random& random);                   // any rotation
glm::dmat3 facing(const Vec3& normal, double spin);  // columns: two across, and the normal
double logBetween(Random& random, double low, double high);
bool chance(Random& random, double part);
Vec3 drawnColour(Random& random);  // in steps that halves hold

// A flat or bent sheet in coordinates of its own.
struct Sheet {
  std::vector<Vec3> points;
  std::vector<Vec2> uv;
  std::vector<std::array<int, 3>> triangles;
};
Sheet quadSheet(double halfWidth, double halfHeight);
Sheet polygonSheet(Random& random, double radius);                       // a fan about its middle
Sheet gridSheet(Random& random, int across, double half, double bumps);  // bumps out of its plane
Sheet ballSheet(int across, double radius);                              // closed

Sheet drawnSheet(Random& random, double half);

// Of a surface that faces the eye, but for a tilt of so many degrees at most.
Vec3 tilted(Random& random, double most);
double drawnSpin(Random& random);

class SceneMaker {
 public:
  //   size  of the scene, metres
  SceneMaker(const std::string& kind, Random& random, double size, double farOff = 0.0);

  glm::dmat4 worldFromEye() const { return worldFromEye_; }
  int plane(const Vec3& point, const Vec3& normal);
  int ball(const Vec3& centre, double radius);
  int box(const Vec3& centre, const glm::dmat3& axes, const Vec3& half);
  // At `origin`, turned by `axes`. Files have it under random nodes, mirrored and scaled ones among them, or baked.
  PlacedMesh& place(const Sheet& sheet, const Vec3& origin, const glm::dmat3& axes, bool baked = false);
  // On a face, which it must lie within: moved along the normal of `axes` it lies off it.
  PlacedMesh& placeOn(const reference::Face& face, const Sheet& sheet, const Vec3& origin, const glm::dmat3& axes);
  Vec3 oneColour() const { return glm::min(one_, Vec3(1.0)); }
  double half(int axis) const { return scene_.numbers.eye.half[axis]; }
  // Nodes of what is placed from now on scale all axes alike.
  void keepProportions() { proportioned_ = true; }
  bool parallel() const { return scene_.numbers.eye.parallel; }
  // A place at a depth, at parts (-1 to 1) of the picture.
  Vec3 at(double x, double y, double z) const;
  DrawnScene& scene() { return scene_; }
  // Of one's own making, instead of what was drawn: a whole picture through a pinhole, `half` of it high at distance 1,
  // or along parallel rays, `half` of it high in metres.
  void look(int width, int height, double half, bool parallel = false);
  DrawnScene finish();

 private:
  void drawEye(double farOff);
  reference::Coat drawnCoat();
  Vec3 colourOf();

  Random& random_;
  DrawnScene scene_;
  glm::dmat4 worldFromEye_{1.0};
  Vec3 one_{0.5};
  bool proportioned_ = false;
};

// Half of the picture's width at a depth, metres.
double widthAt(const SceneMaker& maker, double z);

}  // namespace pellucid::test
