// Random small scenes: the numbers that the reference renders, and how a glTF says the same.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tests/reference/picture_scene.h"
#include "tests/support/random.h"

namespace pellucid::test {

// A transparent mesh as a file has it: numbers of floats under nodes, parents first.
struct PlacedMesh {
  std::vector<glm::vec3> points;
  std::vector<glm::vec2> uv;       // or none
  std::vector<glm::vec4> colours;  // or none
  std::vector<std::array<int, 3>> triangles;
  std::vector<glm::dmat4> nodes;
  reference::Coat coat;
  reference::Face on;
};

// 8 bits a channel, colours in sRGB.
struct StoredTexture {
  int width = 1, height = 1;
  std::vector<std::uint8_t> rgba;
  reference::Wrap wrapS = reference::Wrap::repeat, wrapT = reference::Wrap::repeat;
  bool nearest = false;
};

struct DrawnScene {
  std::string kind;
  double size = 1.0;       // metres: how far away things are
  bool oneLayer = false;   // one flat sheet: then every method's sums are the picture
  bool oneColour = false;  // all coats show the same: then every mean of layers is their colour
  std::vector<PlacedMesh> placed;
  std::vector<StoredTexture> stored;
  reference::PictureScene numbers;  // meshes and textures as placed and stored ones make them
};

const std::vector<std::string>& sceneKinds();
// Throws std::invalid_argument for a kind that there is not.
DrawnScene drawScene(const std::string& kind, Random& random);

}  // namespace pellucid::test
