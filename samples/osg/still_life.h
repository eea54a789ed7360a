// A still life of glass on a table: plain meshes, which the sample hands to OpenSceneGraph, and their GLB.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "samples/generate/mesh.h"
#include "samples/generate/view.h"

namespace pellucid::osgsample {

// World space. `transmission` 1: glass that tints what passes by `colour`; 0: it hides what lies behind by `coverage`.
struct Part {
  std::string name;
  samples::Mesh mesh;
  glm::vec3 colour{1.0f};
  float coverage = 1.0f, transmission = 0.0f, roughness = 0.0f, ior = 1.5f;
  float thickness = 0.0f;  // metres; more than 0: a volume, which bends rays
};

struct Scene {
  samples::View view;
  std::vector<Part> opaque, transparent;
};

// Radiance from everywhere: the only light that glass reflects.
constexpr glm::vec3 kSurroundings{0.62f, 0.66f, 0.72f};

Scene stillLife(int width, int height);
// The transparent parts and the camera.
void writeGlb(const std::string& path, const Scene& scene);

}  // namespace pellucid::osgsample
