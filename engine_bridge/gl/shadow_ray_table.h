// What rays have found of the lights at every lit fragment of a super-tile, for stages that include
// shaders/gl/shadow_rays.glsl.
#pragma once
#include <functional>
#include <vector>

#include "engine_bridge/gl/gl_objects.h"
#include "engine_bridge/scene/light_volume.h"
#include "gbuffer/fragments.h"

namespace pellucid::gl {

class ShadowRayTable {
 public:
  struct Counts {
    std::size_t rays = 0;
    double seconds = 0;
    Counts& operator+=(const Counts& other) {
      rays += other.rays;
      seconds += other.seconds;
      return *this;
    }
  };

  //   width, height  of the super-tile
  void begin(int width, int height, int lights);
  // Asks for the light at every fragment of a band that no solid one hides. The same bits for every number of threads.
  //   lists  solids among them, none taken out
  //   place  view space, of a pixel of the super-tile and a depth
  void add(const FragmentLists& lists, const Window& band, const SurfaceVisibility& visible,
           const std::function<glm::dvec3(int x, int y, float z)>& place);
  // Uploads, and binds to texture unit 12. Throws ResourceError when the device cannot hold it.
  Counts finish();

 private:
  int width_ = 0, lights_ = 0;
  Counts counts_;
  std::vector<glm::uvec4> texels_;
  Buffer storage_ = {};
  BufferTexture texture_ = {};
};

}  // namespace pellucid::gl
