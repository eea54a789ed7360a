// A folding screen of coloured panes in the sun and a pane behind it, for the host to draw and as a glTF for `pellucid
// composite`.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace pellucid::stained {

struct Pane {
  glm::vec3 corners[4];  // world, metres, y up; counter-clockwise from bottom left
  glm::vec3 normal;      // unit
  glm::vec3 colour;      // of light that crosses one surface, before what that reflects
};

struct View {
  glm::vec3 eye{1.1f, 2.0f, 4.6f}, target{0.25f, 0.55f, 0.45f};
  float yfov = 0.62f;  // radians
};

constexpr float kIor = 1.5f;
const glm::vec3 kToSun = glm::normalize(glm::vec3(-0.45f, 0.95f, -0.8f));
constexpr glm::vec3 kSun{3.4f, 3.2f, 2.8f};        // W/m^2 on a plane that faces it
constexpr glm::vec3 kAround{0.35f, 0.38f, 0.42f};  // radiance of the surroundings

std::vector<Pane> screen();
// The panes, the camera and the sun. Throws std::runtime_error when it cannot be written.
void writeGlb(const std::vector<Pane>& panes, const View& view, int width, int height, const std::string& path);

}  // namespace pellucid::stained
