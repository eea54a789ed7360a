// Shadow maps on the device, for stages that include shaders/gl/shadow_maps.glsl.
#pragma once
#include <vector>

#include "engine_bridge/gl/gl_objects.h"
#include "engine_bridge/scene/scene.h"
#include "gbuffer/shadow_maps.h"

namespace pellucid::gl {

class ShadowTextures {
 public:
  // Of the lights that shine, in their order: the index that stages know a light by. Throws ResourceError when the
  // device cannot hold them.
  ShadowTextures(const ShadowMaps& maps, const std::vector<Light>& lights);
  // To storage block 0 and texture unit 12.
  void bind() const;

 private:
  Buffer table_, storage_;
  BufferTexture texels_;
};

}  // namespace pellucid::gl
