// Plain data of a glTF scene, as the transparent pass and the ray tracer draw it. Nothing here knows GL, Embree or
// glTF.
#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/camera.h"
#include "gbuffer/image.h"

namespace pellucid {

// Object space, glTF axes. 64 bytes.
struct Vertex {
  glm::vec3 position;
  glm::vec3 normal;         // unit; computed flat when the file has none
  glm::vec2 uv[2];          // TEXCOORD_0 and 1
  glm::vec4 colour{1.0f};   // COLOR_0, linear
  glm::vec2 tangent{0.0f};  // packed as shaders/shared/surface.glsl says; 0 for none
};
static_assert(sizeof(Vertex) == 64);

enum class Wrap { repeat, mirror, clamp };
// glTF's minFilter: within a level, and between levels where there are any.
enum class Minify { nearest, linear, nearestMipNearest, linearMipNearest, nearestMipLinear, linearMipLinear };

// How a file's sampler reads a texture.
struct Sampling {
  Wrap wrapS = Wrap::repeat, wrapT = Wrap::repeat;
  bool nearest = false;  // magFilter
  Minify minify = Minify::linearMipLinear;
  auto operator<=>(const Sampling&) const = default;
};

struct Texture : Sampling {
  std::string name;     // for messages: image name or file
  bool colour = false;  // rather than data
  // To the linear space of a colour's texels: that of floating-point images which state one, until bringInto().
  glm::dmat3 fromRec709{1.0};
  Image<glm::vec4> texels;  // straight alpha; linear light when `colour`, else as stored, 0..1. Row 0 is v = 0.
};

struct TextureRef {
  int texture = -1;             // index into Scene::textures, -1 for none
  int texCoord = 0;             // 0 or 1
  glm::mat3 uvTransform{1.0f};  // KHR_texture_transform: uv' = transform * (uv, 1)
};

enum class AlphaMode { opaque, mask, blend };

struct Material {
  std::string name;
  AlphaMode alphaMode = AlphaMode::opaque;
  float alphaCutoff = 0.5f;
  bool doubleSided = false, unlit = false;
  glm::vec4 baseColor{1.0f};
  float metallic = 1.0f, roughness = 1.0f;
  glm::vec3 emission{0.0f};  // emissiveFactor * emissiveStrength, scene-linear
  float transmission = 0.0f;
  float ior = 1.5f;
  bool volume = false;               // KHR_materials_volume present with thickness > 0
  float thickness = 0.0f;            // object space
  float attenuationDistance = 0.0f;  // metres, 0 = infinite
  glm::vec3 attenuationColor{1.0f};
  float dispersion = 0.0f;  // KHR_materials_dispersion: 20 over the Abbe number, 0 for none
  float diffuseTransmission = 0.0f;
  float specular = 1.0f;          // KHR_materials_specular: strength of a dielectric's reflection, [0,1]
  glm::vec3 specularColor{1.0f};  // its tint head-on, >= 0
  float normalScale = 1.0f;
  TextureRef baseColorTexture, metallicRoughnessTexture, emissiveTexture, transmissionTexture, thicknessTexture,
      normalTexture, specularTexture, specularColorTexture;
  // extras.pellucid and --set MATERIAL.key=value
  std::optional<float> collimation;  // [0,1]
  std::optional<float> coverage;     // [0,1], multiplies alpha
  bool additive = false, lowResolution = false, castsShadow = true;
  std::optional<bool> thin;  // overrides `volume`
  bool billboard = false;    // each instance is turned to the camera, and lit as a particle is
  float softness = 0.0f;     // metres over which a billboard fades before what is opaque; 0: it is cut
  float phase = 0.0f;        // g of particles, -0.98 to 0.98
  float pointScale = 1.0f;   // multiplies the radius of points

  // All of them, in the order of their places in MaterialBlock.
  std::array<const TextureRef*, 8> textures() const {
    return {&baseColorTexture, &metallicRoughnessTexture, &emissiveTexture,     &transmissionTexture, &thicknessTexture,
            &normalTexture,    &specularTexture,          &specularColorTexture};
  }

  // Has an inside: KHR_materials_volume, unless `thin` says otherwise.
  bool hasInterior() const { return thin ? !*thin : volume; }
  // Both of its sides are drawn. A volume's boundary is met twice, as light enters and leaves, whatever doubleSided
  // says (KHR_materials_volume).
  bool bothSides() const { return doubleSided || (!unlit && transmission > 0.0f && hasInterior()); }

  // Goes through the transparent pass; opaque primitives belong to the G-buffer.
  bool transparent() const {
    return alphaMode != AlphaMode::opaque || transmission > 0.0f || additive || coverage.value_or(1.0f) < 1.0f;
  }
};

// Bounds of vertex colours, with 1.
struct ColourRange {
  glm::vec4 least{1.0f}, most{1.0f};
  void add(const glm::vec4& colour) {
    least = glm::min(least, colour);
    most = glm::max(most, colour);
  }
};

class TriangleSource;  // triangle_source.h

// A shape that a mesh fills in its own space, so that a ray inside is known to leave it.
// shaders/shared/closed_body.glsl
struct SolidBody {
  int kind = 0;                // shading::PLD_BODY_*
  glm::dmat4 fromObject{1.0};  // to the unit ball, or to [-1,1]^3
};

struct Primitive {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // triangles, counter-clockwise from the front *as placed* by their instances
  int material = 0;                    // index into Scene::materials
  // When set, the triangles lie in their file, and vertices and indices are empty. SceneOptions::streamBytes
  std::shared_ptr<const TriangleSource> streamed = nullptr;
  bool points = false;                           // each triangle is a particle: see scene/points.h. Always streamed
  std::optional<SolidBody> body = std::nullopt;  // of glass that SceneOptions::closedGlass has found

  std::size_t triangles() const;
};

struct Instance {
  glm::dmat4 worldFromObject{1.0};
  int primitive = 0;           // index into Scene::primitives
  std::string node;            // for messages
  std::uint32_t identity = 0;  // hash of file, node and mesh
  int file = 0;                // which of the files that were loaded, in their order
  glm::vec4 colour{1.0f};      // linear, [0,1]: multiplies vertex colours. _COLOR_0 of EXT_mesh_gpu_instancing
};

enum class LightKind { directional, point, spot };

struct Light {
  std::string name;
  LightKind kind = LightKind::point;
  glm::vec3 colour{1.0f};
  float intensity = 0.0f;                            // lux or candela over lumensPerWatt: W/m^2 or W/sr
  float range = 0.0f;                                // metres, 0 = infinite
  float innerCone = 0.0f, outerCone = 0.785398163f;  // radians from the axis
  glm::dvec3 position{0.0};                          // world
  glm::dvec3 direction{0, 0, -1};                    // world, unit, from the light
};

struct SceneCamera {
  std::string name;  // node name, else camera name
  glm::dmat4 viewFromWorld{1.0};
  bool orthographic = false;
  double yfov = 0, aspect = 0;  // perspective; aspect 0 when unstated
  double xmag = 0, ymag = 0;    // orthographic
  double znear = 0, zfar = 0;   // zfar 0 = infinite
};

struct Scene {
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Primitive> primitives;
  std::vector<Instance> instances;  // in file order
  std::vector<Light> lights;
  std::vector<SceneCamera> cameras;
  std::vector<std::string> notes;  // one sentence each, for stderr
};

// The camera for a picture of this size, which shows all of the camera's field and stretches nothing: fitted by its
// height (yfov, ymag), or by its width where the field is wider than the picture. A perspective camera without an
// aspect has the picture's. Camera::origin says where shapes differ, and which way it was fitted.
Camera cameraOf(const SceneCamera& camera, const Window& display, double pixelAspect);

}  // namespace pellucid
