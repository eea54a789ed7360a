// Procedural plants made of cards: flat pieces whose binary masks cut out leaves and slats.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gbuffer/image.h"
#include "samples/generate/mesh.h"

namespace pellucid::samples {

// Straight colour and an alpha of 0 or 1, stored values in [0,1]. Row 0 is the top.
Image<glm::vec4> leafMask(int edge);
Image<glm::vec4> slatMask(int edge);  // upright slats with pointed tops

// A parallelogram that shows one whole mask. World, metres.
struct Card {
  glm::dvec3 corner, right, up;  // corner is the bottom left
};

// Leaves on the shell and inside of a crown. Deterministic in `seed`.
std::vector<Card> crown(glm::dvec3 centre, double radius, int leaves, double leafLength, std::uint32_t seed);

// Two rows of slatted panels, the farther row `gap` metres behind (-z) and half a panel aside.
std::vector<Card> fence(glm::dvec3 corner, double width, double height, int panels, double gap);

Mesh meshOf(const std::vector<Card>& cards);

}  // namespace pellucid::samples
