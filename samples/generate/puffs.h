// Soft balls of smoke for cards that face the camera.
#pragma once
#include <cstdint>

#include "samples/generate/glb.h"

namespace pellucid::samples {

// White, with the opacity of a ragged ball; clear at the rim. Square, straight alpha.
Image<glm::vec4> puff(std::uint32_t seed);

// What a cloud of unlit cards is made of.
struct Cloud {
  std::string name;
  std::uint32_t seed = 0;
  double opacity = 0.5;                              // of a card's middle
  nlohmann::json extras = nlohmann::json::object();  // the material's extras.pellucid
};

// A card: its middle, its edge in metres, its colour (linear).
struct PuffCard {
  glm::dvec3 middle{0.0};
  double edge = 1.0;
  glm::dvec3 colour{1.0};
};

// Adds the cards, turned about +z by a hash of their number, as meshes of two textures.
void addCloud(Glb& glb, const Cloud& cloud, const std::vector<PuffCard>& cards);

}  // namespace pellucid::samples
