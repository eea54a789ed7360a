// Fog as one full-screen surface, marched by its fragment stage into the sums of the transparent pass. PT17 section 7.2
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/gl/gl_objects.h"
#include "engine_bridge/gl/gl_program.h"
#include "engine_bridge/gl/volume_texture.h"
#include "gbuffer/medium.h"

namespace pellucid::gl {

// What the targets that are bound, and the frame's block, want of it.
struct FogFrame {
  std::vector<std::string> defines;  // of the sums
  PixelRays rays;                    // of the super-tile
};

class FogPass {
 public:
  // Into the sums that are bound and blend. Throws ResourceError when the device has no room for the volumes.
  void draw(const Fog& fog, const FogFrame& frame);

 private:
  void upload(const Fog& fog);
  Buffer values_, lights_;
  VertexArray noVertices_;
  Texture3d density_, emission_, open_;
  VolumeTexture visibility_;
  std::shared_ptr<const DensityGrid> densityOf_;  // what density_ and emission_ hold
};

}  // namespace pellucid::gl
