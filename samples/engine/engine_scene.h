// What a small engine draws and what it asks of Pellucid: the transparent primitives of a glTF, in a room of its own.
// Knows no graphics interface.
#pragma once
#include <pellucid/pellucid.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace engine {

struct Vertex {
  glm::vec3 position, normal;
};

struct Material {
  glm::vec4 base{1.0f};
  float roughness = 1.0f, transmission = 0.0f, ior = 1.5f, thickness = 0.0f;
  bool unlit = false, blend = false, bothSides = false;
  bool transparent() const { return blend || transmission > 0.0f; }
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  glm::mat4 worldFromObject{1.0f};
  Material material;
};

struct Scene {
  std::vector<Mesh> meshes;
  glm::mat4 viewFromWorld{1.0f};
  float yfov = 0.8f;
  glm::vec3 toSun{0.0f, 1.0f, 0.0f}, sun{0.0f};  // world; W/m^2
  glm::vec3 least{1e30f}, most{-1e30f};          // of what is transparent, world
};

constexpr float kNear = 0.01f;
constexpr glm::vec3 kAmbient{0.35f, 0.38f, 0.42f};

// Ends the program with a sentence.
[[noreturn]] void stop(const std::string& why);

// A glTF file of the binary kind. Textures, skins and opaque lights are left out.
Scene readScene(const std::string& path);

// Reversed depth without a far plane: clip z is kNear.
glm::mat4 clipFromView(const Scene& scene, int width, int height);

// METHOD or METHOD:TIER; features are those that glTF materials need.
struct Asked {
  pld_method method;
  pld_tier tier;
  uint32_t features;
};
Asked askedFor(const std::string& text);
constexpr float kFragmentsAPixel = 4.0f;  // of the exact tier

// All but the textures.
pld_frame frameOf(const Scene& scene, int width, int height);

// Colour (RGBA) and reversed depth to an EXR. Rows come from the picture's bottom, or from its top.
void writePicture(const std::string& path, int width, int height, const std::vector<float>& colour,
                  const std::vector<float>& depth, bool fromTop = false);

}  // namespace engine
