// What a small engine draws and what it asks of Pellucid: the transparent primitives of a glTF, in a room of its own.
// Knows no graphics interface.
#pragma once
#include <pellucid/pellucid.h>

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace engine {

struct Vertex {
  glm::vec3 position, normal;
  glm::vec4 colour;
  glm::vec2 uv;
};

struct Material {
  glm::vec4 base{1.0f};
  float roughness = 1.0f, transmission = 0.0f, ior = 1.5f, thickness = 0.0f;
  float cutoff = 0.0f;  // above 0: leaves that a mask cuts out
  int texture = -1;     // layer of Scene::textureLevels, or none
  bool unlit = false, blend = false, bothSides = false, lowResolution = false;
  bool opaque() const { return !blend && transmission <= 0.0f; }
};

struct Mesh {
  std::uint32_t firstIndex = 0, indexCount = 0;
  glm::mat4 worldFromObject{1.0f};
  Material material;
};

constexpr std::size_t kTextureEdge = 128, kTextureLevels = 8;

struct Scene {
  std::vector<Vertex> vertices;  // of all meshes
  std::vector<std::uint32_t> indices;
  std::vector<Mesh> meshes;
  // Level by level of an array of base colour textures, with straight alpha: linear halves, layer after layer.
  std::array<std::vector<std::uint64_t>, kTextureLevels> textureLevels;
  glm::mat4 viewFromWorld{1.0f};
  float yfov = 0.8f;
  glm::vec3 toSun{0.0f, 1.0f, 0.0f}, sun{0.0f};  // world; W/m^2
  glm::vec3 least{1e30f}, most{-1e30f};          // of what is transparent, world
};

constexpr float kNear = 0.01f;
constexpr glm::vec3 kAmbient{0.35f, 0.38f, 0.42f};

// Ends the program with a sentence.
[[noreturn]] void stop(const std::string& why);

// A glTF file of the binary kind, in a room. Of textures only those of base colour are read; skins and opaque lights
// are left out.
Scene readScene(const std::string& path);
// A floor, a wall and blocks around what is transparent: something to be seen through it.
void addRoom(Scene& scene);
//   indices  counted from the mesh's own first vertex
void addMesh(Scene& scene, const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices,
             const glm::mat4& worldFromObject, const Material& material);

// Reversed depth without a far plane: clip z is kNear.
glm::mat4 clipFromView(const Scene& scene, int width, int height);

// What engine_shading.h reads of a scene and of a mesh, in std140.
struct SceneNumbers {
  glm::mat4 clipFromView;
  glm::vec4 toSun, sun, ambientAndRows;
};
// Where rows run down clip y does too.
SceneNumbers sceneNumbers(const Scene& scene, int width, int height, bool rowsUp);
struct MeshNumbers {
  glm::mat4 viewFromObject;
  glm::vec4 base, surfaceValues;
  float cutoff;
  std::int32_t unlit, texture, firstIndex;
};
MeshNumbers meshNumbers(const glm::mat4& viewFromWorld, const Mesh& mesh);

// METHOD, METHOD:TIER, and behind either ",rims", ",low" and ",shadows"; other features are those that glTF materials
// need.
struct Asked {
  pld_method method;
  pld_tier tier;
  uint32_t features;
  bool shadows;
};
Asked askedFor(const std::string& text);

// PROGRAM GLASS.glb OUTDIR [WIDTHxHEIGHT] [what askedFor() takes] [LAST]
struct Arguments {
  std::string glass, folder, last;  // last is empty where there is none
  int width = 640, height = 360;
  Asked asked{};
};
//   usage  said where they are others
Arguments argumentsOf(int count, char** arguments, const std::string& usage);

constexpr float kFragmentsAPixel = 4.0f;  // of the exact tier

// Whether a stage of Pellucid's pass draws a material. Smoke is at low resolution where that is asked for.
bool isDrawnIn(pld_stage stage, const Material& material, uint32_t features);

// One map, and the view of the sun, which has all that is transparent in it.
pld_shadow_info shadowMaps();
struct SunView {
  glm::mat4 lightFromWorld;
  pld_shadow_view view;  // asked in the camera's view space
};
SunView sunViewOf(const Scene& scene);
SceneNumbers sceneNumbers(const SunView& sun);  // rows run up

// All but the textures.
pld_frame frameOf(const Scene& scene, int width, int height);

// Colour (RGBA) and reversed depth to an EXR. Rows come from the picture's bottom, or from its top.
void writePicture(const std::string& path, int width, int height, const std::vector<float>& colour,
                  const std::vector<float>& depth, bool fromTop = false);

}  // namespace engine
