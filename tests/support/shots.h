// Small shots that tests write for themselves: a G-buffer of one colour and depth, and a GLB of axis-aligned quads.
#pragma once
#include <array>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace pellucid::test {

struct Quad {
  std::array<float, 3> corner{-1, -1, -3}, across{2, 0, 0}, up{0, 2, 0};  // metres, world
  nlohmann::json material = nlohmann::json::object();                     // glTF material
};

// A node that moves along a line, from where the file has it at 0 s.
struct Motion {
  std::size_t node = 0;              // quads come first, in their order, then the camera
  std::array<float, 3> perSecond{};  // metres
};

struct GlbOptions {
  bool camera = true;                               // node "cam" at the origin, looking down -z
  double yfov = 0.9272952180016122;                 // 2 atan(1/2): the picture is z metres high at distance z
  nlohmann::json nodes = nlohmann::json::array();   // more nodes of the scene
  nlohmann::json extra = nlohmann::json::object();  // merged into the top level
  std::vector<Motion> motions;                      // one animation of 10 s
};

void writeGlb(const std::string& path, const std::vector<Quad>& quads, const GlbOptions& options = {});

// An unlit material: straight colour and coverage.
nlohmann::json unlit(float r, float g, float b, float alpha);

}  // namespace pellucid::test
