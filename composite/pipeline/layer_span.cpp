#include "composite/pipeline/layer_span.h"

#include "composite/pipeline/layer_source.h"
#include "engine_bridge/scene/corners.h"

namespace pellucid {

DepthSpan layerSpanOf(const Scene& scene, const Camera& camera) {
  DepthSpan span;
  forEachCorner(
      scene, camera.viewFromWorld, [](const Material& material) { return material.transparent(); },
      [&](const Instance&, const glm::dvec3& view) { span.add(-view.z); });
  return span;
}

DepthSpan layerSpanOf(const std::unique_ptr<DeepSource>& file, const GBuffer& gbuffer) {
  DepthSpan span;
  LayerSources source(nullptr);
  source.join(deepFiles({&file, 1}));
  const PassSettings settings;
  source.each({settings, {&gbuffer, &gbuffer, nullptr}, VolumeRule::midDepth}, [&](const FragmentLists& lists) {
    for (const Fragment& fragment : lists.fragments) span.add(static_cast<double>(fragment.z));
  });
  return span;
}

}  // namespace pellucid
