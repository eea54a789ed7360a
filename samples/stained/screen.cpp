#include "samples/stained/screen.h"

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "samples/generate/glb.h"

namespace pellucid::stained {

std::vector<Pane> screen() {
  const glm::vec3 glass[] = {{.95f, .30f, .12f}, {.15f, .45f, .95f}, {.97f, .80f, .15f},
                             {.20f, .75f, .35f}, {.75f, .25f, .80f}, {.90f, .90f, .85f}};
  constexpr float wide = 0.42f, high = 0.5f, lead = 0.02f;
  std::vector<Pane> panes;
  glm::vec3 hinge(-1.2f, 0.1f, 0.2f);
  for (int wing = 0; wing < 3; ++wing) {
    const float turn = wing % 2 ? -0.5f : 0.5f;
    const glm::vec3 right(std::cos(turn), 0.0f, -std::sin(turn)), up(0.0f, 1.0f, 0.0f);
    for (int column = 0; column < 2; ++column)
      for (int row = 0; row < 3; ++row) {
        Pane pane;
        const glm::vec3 low = hinge + (static_cast<float>(column) * wide + lead) * right +
                              (static_cast<float>(row) * high + lead) * up,
                        across = (wide - 2.0f * lead) * right, along = (high - 2.0f * lead) * up;
        const glm::vec3 corners[] = {low, low + across, low + across + along, low + along};
        for (int i = 0; i < 4; ++i) pane.corners[i] = corners[i];
        pane.normal = glm::cross(right, up);
        pane.colour = glass[(5 * wing + 3 * column + 2 * row) % 6];
        panes.push_back(pane);
      }
    hinge += 2.0f * wide * right;
  }
  // One more hangs behind, nearer the sun: its shadow crosses those of the screen.
  Pane rose;
  const glm::vec3 corners[] = {
      {-1.0f, 0.9f, -0.45f}, {0.1f, 0.9f, -0.45f}, {0.1f, 1.75f, -0.45f}, {-1.0f, 1.75f, -0.45f}};
  for (int i = 0; i < 4; ++i) rose.corners[i] = corners[i];
  rose.normal = {0.0f, 0.0f, 1.0f};
  rose.colour = {.95f, .45f, .55f};
  panes.push_back(rose);
  return panes;
}

void writeGlb(const std::vector<Pane>& panes, const View& view, int width, int height, const std::string& path) {
  samples::Glb glb;
  for (std::size_t i = 0; i < panes.size(); ++i) {
    const std::string name = "pane " + std::to_string(i);
    samples::Mesh mesh;
    mesh.positions.assign(panes[i].corners, panes[i].corners + 4);
    mesh.normals.assign(4, panes[i].normal);
    mesh.indices = {0, 1, 2, 0, 2, 3};
    glb.addMesh(name, mesh,
                glb.addMaterial(samples::glass(name, glm::dvec3(panes[i].colour), static_cast<double>(kIor), 0.0)));
  }
  samples::View camera;
  camera.eye = glm::dvec3(view.eye);
  camera.target = glm::dvec3(view.target);
  camera.yfov = static_cast<double>(view.yfov);
  camera.width = width;
  camera.height = height;
  glb.addCamera("cam", camera);
  glb.addSun("sun", glm::dvec3(kToSun), glm::dvec3(kSun));
  const std::vector<unsigned char> bytes = glb.bytes();
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw std::runtime_error(path + ": could not be written");
}

}  // namespace pellucid::stained
