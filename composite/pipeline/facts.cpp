#include "composite/pipeline/facts.h"

#include <algorithm>

#include "composite/pipeline/layer_span.h"
#include "engine_bridge/scene/blocks.h"

namespace pellucid {

ShotFacts factsOf(const Shot& shot) {
  ShotFacts facts;
  facts.width = shot.opaque.gbuffer.data.width();
  facts.height = shot.opaque.gbuffer.data.height();
  facts.pixelFilter = shot.opaque.choice.pixelFilter;
  facts.pixelFilterBy = shot.opaque.choice.pixelFilterBy;
  facts.hasScene = shot.hasScene;
  facts.hasCamera = shot.hasCamera;
  facts.moves = shot.moment && shot.files && shot.files->moves();
  facts.cameraMoves = facts.moves && shot.sceneCamera;
  facts.shutter = shot.headerTime.shutter;
  if (shot.headerTime.exposure && shot.moment)
    facts.exposure = *shot.headerTime.exposure * shot.moment->framesPerSecond;
  facts.deepPicture = shot.deepOpaque != nullptr;
  facts.deepFiles = shot.deep.size();
  facts.deepScatters =
      std::any_of(shot.deep.begin(), shot.deep.end(), [](const auto& source) { return source->mayScatter(); });
  facts.marksLowResolution =
      std::any_of(shot.scene.materials.begin(), shot.scene.materials.end(),
                  [](const Material& material) { return material.lowResolution && material.transparent(); });
  facts.lights = static_cast<std::size_t>(std::count_if(shot.scene.lights.begin(), shot.scene.lights.end(),
                                                        [](const Light& light) { return shines(light); }));
  facts.rangeNear = shot.camera.rangeNear;
  facts.rangeFar = shot.camera.rangeFar;
  for (const Primitive& primitive : shot.scene.primitives) facts.triangles += primitive.triangles();
  return facts;
}

void addLayerDepths(const Shot& shot, ShotFacts& facts) {
  DepthSpan span = layerSpanOf(shot.scene, shot.camera);
  for (const std::unique_ptr<DeepSource>& file : shot.deep) span.add(layerSpanOf(file, shot.opaque.gbuffer));
  if (span.empty()) return;
  facts.layersNear = span.low;
  facts.layersFar = span.high;
}

}  // namespace pellucid
