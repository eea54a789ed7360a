// Exact transparent fragment lists by ray tracing: the second, independent source of what TransparentPass::fragments
// lists.
#pragma once
#include <functional>
#include <memory>

#include "engine_bridge/embree/shadow_rays.h"
#include "engine_bridge/scene/pass_settings.h"
#include "gbuffer/fragments.h"

namespace pellucid {

class RayFragments {
 public:
  // The arguments must outlive this. Throws ResourceError when memory runs out.
  RayFragments(const Scene& scene, const GBuffer& gbuffer, const Camera& camera);
  ~RayFragments();

  // From now on these rays say what transparent things are in the way of the scene's lights, instead of
  // settings.shadowRays or settings.shadows.
  void shadowBy(std::shared_ptr<const ShadowRays> rays);

  // Every transparent fragment in front of the G-buffer and of the nearest solid, in bands of rows from the top that
  // together cover the data window. Fragments of a pixel lie from the nearest to the farthest, equal depths by
  // identity. A ray that meets an edge which triangles share meets the mesh once, on the side that a rasteriser's
  // top-left rule takes. Of the settings those of weights, order and tiles have no meaning here; `filter` mipmap is
  // refused with a UsageError: rays read level 0. The same bits for every number of threads.
  void fragments(const PassSettings& settings, const std::function<void(const FragmentLists&)>& band);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid
