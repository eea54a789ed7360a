#include "composite/pipeline/layer_span.h"

#include "composite/pipeline/layer_source.h"
#include "engine_bridge/scene/triangle_source.h"

namespace pellucid {

DepthSpan layerSpanOf(const Scene& scene, const Camera& camera) {
  constexpr std::size_t kBatch = 1024;
  DepthSpan span;
  VertexPlaces places;
  TriangleBatch batch;
  for (const Instance& instance : scene.instances) {
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    if (!scene.materials[static_cast<std::size_t>(primitive.material)].transparent()) continue;
    const glm::dmat4 viewFromObject = camera.viewFromWorld * instance.worldFromObject;
    for (std::size_t first = 0; first < primitive.triangles(); first += kBatch) {
      readTriangles(primitive, first, std::min(kBatch, primitive.triangles() - first), places, batch);
      for (const Vertex& vertex : batch.vertices)
        span.add(-(viewFromObject * glm::dvec4(glm::dvec3(vertex.position), 1.0)).z);
    }
  }
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
