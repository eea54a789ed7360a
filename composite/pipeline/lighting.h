// Everything that lights a shot before its layers are painted, worked out once for all passes: shadows on the picture
// and on the layers, fog, the light in particles, the occlusion of leaves.
#pragma once
#include <memory>

#include "composite/pipeline/shadow_step.h"
#include "gbuffer/depth_plane.h"

namespace pellucid {

// The picture as it is lit: the shot's own unless shadows fell on it. All of it outlives the run.
struct LitPicture {
  const GBuffer* gbuffer = nullptr;        // its depth is that of where a pass samples the pixels; it may lack colours
  const GBuffer* centres = nullptr;        // the same picture at pixel centres, where its colours are looked up
  const DeepOpaque* deepOpaque = nullptr;  // null for a flat picture
  const DepthPlanes* planes = nullptr;     // of the depth at pixel centres, where a pass sees it from there
  const Image<float>* passWeight = nullptr;  // of the pass in each pixel's mean; null: as much as any other
  const EdgeTexels* edges = nullptr;         // that bent rays may meet in it; null: none are known
};

struct Lighting {
  CastShadows shadows;
  std::shared_ptr<const SurfaceVisibility> surfaces;  // of shadows by rays, and of maps where there is fog
  std::shared_ptr<const LightVolume> particles;
  std::shared_ptr<const Fog> fog;
  GBuffer relit;  // the picture, where shadows changed it
  LitPicture picture;

  Lighting() = default;
  Lighting(const Lighting&) = delete;
  Lighting& operator=(const Lighting&) = delete;

  // What the passes read of it.
  void applyTo(ShadingSettings& settings, const Shot& shot) const;
};

// Whether rays will meet the scene's triangles under this request: they are decoded then.
bool meetsRays(const Request& request);

// The shot must outlive the result.
std::unique_ptr<Lighting> lightShot(const Request& request, const Shot& shot, Device& device, Journal& journal);

}  // namespace pellucid
