// Order-independent sums of the transparent layers: what the transparent pass hands to resolve.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <string>

#include "gbuffer/camera.h"
#include "gbuffer/colour_space.h"
#include "gbuffer/image.h"
#include "gbuffer/weight_text.h"
#include "shaders/plane_layout.h"
#include "shaders/shading.h"

namespace pellucid {

// How the sums were made. Planes that do not match are refused: their sums mean different things.
struct OitInfo {
  std::string method = "phenomenological";
  shading::WeightSettings weight{shading::PLD_WEIGHT_EQ5, 0.1f, 1000.0f, 3.0f, 1.0f};
  int normalisation = shading::PLD_NORMALISE_SPECTRAL;
  std::string tier = "float";  // "float", "exact" or "published"
  std::string solidHash;       // of the solid plane: sums behind different solids do not add
  std::string places;          // of a deep picture's samples, and of which; "" for a flat picture's pixels
  ColourSpace space;           // that all colours are in, the picture's
};

// RGBA32F planes of the data window, packed as shaders/shared/accumulate.glsl and refraction.glsl pack them; every
// plane is a sum, but for frontZ and diffuseZ (minima) and solid (the nearest).
struct OitPlanes {
  Window display, data;
  OitInfo info;
  Camera camera;
  Image<glm::vec4> radiance;  // A.rgb, sum of w_z o
  Image<glm::vec4> weight;    // W.rgb, layer count
  Image<glm::vec4> opacity;   // O.rgb, sum of o z
  Image<glm::vec4> depth;     // tau.rgb, sum of w_z E; in tier "published" beta.rgb, 1 where nothing is
  Image<glm::vec4> light;     // E.rgb, sum of W z over the refracting layers
  Image<float> frontZ;        // nearest transparent layer, planar metres, +inf for none
  Image<glm::vec4> solid;     // nearest fragment that hides everything: rgb, planar z (+inf for none)
  // Empty when no layer of the scene refracts or diffuses.
  Image<glm::vec4> refraction;  // sums of W delta.x, W delta.y, W (float pixels, y down) and of s^2 (pixels^2): D^2
  Image<float> diffuseZ;        // nearest diffusing layer, planar metres, +inf for none
  // The alpha of `light`, in emptyScatterPlanes(), which have no `light`.
  Image<float> refractionZ;
  // Empty when no refracting layer disperses. Sums of W times delta of red, then of blue, minus delta; float pixels.
  Image<glm::vec4> dispersion;

  bool scatters() const { return !refraction.empty(); }
  bool published() const { return info.tier == "published"; }
  bool disperses() const { return !dispersion.empty(); }
  // What adds, by PlaneSum.
  std::array<Image<glm::vec4>*, kAddedSums> sums() {
    return {&radiance, &weight, &opacity, &depth, &light, &refraction, &dispersion};
  }
  std::array<const Image<glm::vec4>*, kAddedSums> sums() const {
    return {&radiance, &weight, &opacity, &depth, &light, &refraction, &dispersion};
  }
  float refractionZAt(int x, int y) const { return light.empty() ? refractionZ.at(x, y) : light.at(x, y).a; }

  shading::OitTargets at(int x, int y) const {
    shading::OitTargets targets;
    targets.radiance = radiance.at(x, y);
    targets.weight = weight.at(x, y);
    targets.opacity = opacity.at(x, y);
    targets.depth = depth.at(x, y);
    targets.light = light.at(x, y);
    return targets;
  }
};

// Planes of the window, all sums 0, frontZ and solid.z +inf.
OitPlanes emptyPlanes(const Window& display, const Window& data);
// The same of tier "published": beta is 1.
OitPlanes emptyPublishedPlanes(const Window& display, const Window& data);
// Those alone that say where a pixel's layers show the background from: refractionZ, refraction and diffuseZ. `solid`
// is empty as long as there is none.
OitPlanes emptyScatterPlanes(const Window& display, const Window& data);
// Gives planes that lack them those of refraction and diffusion, in which nothing scatters.
void addScatterPlanes(OitPlanes& planes);
// The same with the plane of a sum, when it is one of scattering; all planes have the others.
void addPlane(OitPlanes& planes, PlaneSum sum);
// Those that such layers need, as far as the planes' tier keeps them.
void addPlanes(OitPlanes& planes, LayerModel layers);

// The layers that such planes have room for: as sums in floats, in which the published tier lies too.
inline LayerModel modelOf(const OitPlanes& planes) {
  LayerModel model;
  model.weight = planes.info.weight.kind;
  model.normalisation = planes.info.normalisation;
  model.refracts = model.diffuses = planes.scatters();
  model.disperses = planes.disperses();
  model.solids = true;
  return model;
}

// Adds b to a (nearest solid wins only when both are the same: solidHash). Throws MeaningError when they do not match.
void mergePlanes(OitPlanes& a, const OitPlanes& b);

}  // namespace pellucid
