// Fog as a record: what fills the air of a shot, and what of the lights comes through it.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "gbuffer/camera.h"
#include "gbuffer/gbuffer.h"
#include "shaders/medium_text.h"

namespace pellucid {

// A box of texels, x fastest.
template <class T>
struct Volume {
  glm::ivec3 size{0};
  std::vector<T> texels;

  Volume() = default;
  Volume(glm::ivec3 extent, T fill)
      : size(extent),
        texels(static_cast<std::size_t>(extent.x) * static_cast<std::size_t>(extent.y) *
                   static_cast<std::size_t>(extent.z),
               fill) {}
  std::size_t index(glm::ivec3 at) const {
    return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(at.y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(at.x);
  }
  T& at(glm::ivec3 place) { return texels[index(place)]; }
  const T& at(glm::ivec3 place) const { return texels[index(place)]; }
  const T& clamped(glm::ivec3 place) const { return at(glm::clamp(place, glm::ivec3(0), size - 1)); }

  // Between the eight texels around a place, in double or vectors of it. Centres lie at +0.5; beside the box its
  // nearest texels count.
  template <class Wide>
  Wide between(const glm::dvec3& place) const {
    const glm::dvec3 from = place - 0.5, low = glm::floor(from), part = from - low;
    const glm::ivec3 first(low);
    Wide sum(0.0);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 offset(corner & 1, (corner >> 1) & 1, corner >> 2);
      double share = 1.0;
      for (int c = 0; c < 3; ++c) share *= offset[c] ? part[c] : 1.0 - part[c];
      sum += share * Wide(clamped(first + offset));
    }
    return sum;
  }
};

// Factors on a medium's density, and what glows by itself in its box; nothing lies outside.
struct DensityGrid {
  Volume<float> density;         // >= 0, finite
  Volume<glm::vec4> emission;    // rgb: radiance that a metre adds, >= 0, finite; without texels where nothing glows
  glm::dmat4 boxFromWorld{1.0};  // its box becomes [0,1]^3
  float most = 0.0f;
};

struct Box {
  glm::dvec3 low{0.0}, high{0.0};
  bool operator==(const Box&) const = default;
};

constexpr double kFogBeforeNothing = 1000.0;  // metres of a ray that ends on nothing, where nobody says otherwise

// In the world's metres, y up.
struct MediumSettings {
  double density = 0.0;      // 1/m, extinction at the base; a grid multiplies it
  double height = 0.0;       // metres over which it falls to 1/e; 0: even
  double base = 0.0;         // height of the base
  glm::dvec3 albedo{1.0};    // of one scattering event, [0,1]
  double g = 0.0;            // -0.98 to 0.98, > 0 scatters forward
  glm::dvec3 emission{0.0};  // radiance that a metre adds where it is as dense as `density`; grows with the density
  std::optional<double> farthest;  // metres from the eye beyond which there is none; unset: before surfaces, all of it
  int steps = 64;                  // of the march
  double collimation = 1.0;        // [0,1]; below 1 it diffuses what lies behind it
  int order = shading::PLD_FOG_ORDERED;
  std::optional<Box> box;
  std::shared_ptr<const DensityGrid> grid;  // wins over the box
  bool operator==(const MediumSettings&) const = default;
};

// What of each light reaches the fog: visibility at texels, [0,1].
struct LightVolume {
  glm::ivec3 size{0};             // of one light
  Volume<glm::vec4> visibility;   // lights above one another in z; a unused
  glm::mat4 texelFromView{1.0f};  // centres at +0.5
};

// Part of one light that the air before it leaves at a point of view space, metres. [0,1]
using AirPassed = std::function<float(const glm::dvec3& point)>;

// Radiance of the surroundings up to the first order.
struct AmbientLight {
  glm::vec3 mean{0.0f};
  glm::dvec3 slope[3] = {};  // of red, green, blue, along world directions
};

// A medium as one camera sees it.
struct Fog {
  Camera camera;
  shading::Medium medium = {};
  int order = shading::PLD_FOG_ORDERED;
  shading::DiffusionSettings diffusion = {};   // of one camera and its picture; k0 = 0 leaves diffusion out
  std::vector<shading::PunctualLight> lights;  // view space
  std::shared_ptr<const DensityGrid> grid;
  std::shared_ptr<const LightVolume> visibility;  // null: nothing stands before the lights

  bool gridEmits() const { return grid && !grid->emission.texels.empty(); }
  bool emits() const { return shading::mediumEmits(medium); }
  bool diffuses() const { return medium.march.z > 0.0f && diffusion.k0 > 0.0f; }
};

// Throws std::logic_error for settings out of their range: the flags have checked them.
Fog placeFog(const MediumSettings& settings, const Camera& camera, const AmbientLight& ambient,
             std::vector<shading::PunctualLight> lights);

// What of the world the fog of a picture may fill: boxes of box and grid, else what the rays pass that end on
// something.
Box fogBounds(const MediumSettings& settings, const Camera& camera, const GBuffer& gbuffer);

// Rays through the pixels of one camera: the origin is offset + scale * pixel where it is orthographic; else that is
// the direction at z = 1. View space, pixels of the display window, y down.
struct PixelRays {
  glm::vec2 offset{0.0f}, scale{0.0f};
  bool orthographic = false;
};
//   first   pixel of the display window that is counted from
//   sample  where in the pixel, (0.5, 0.5) its centre
PixelRays pixelRays(const Camera& camera, const Window& display, glm::ivec2 first, glm::dvec2 sample);

}  // namespace pellucid
