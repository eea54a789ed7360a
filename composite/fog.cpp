#include "composite/fog.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "composite/denormals.h"
#include "composite/fog_march.h"
#include "composite/fold_published.h"

namespace pellucid {
namespace {

void addSpread(const shading::FogSpread& spread, OitPlanes& planes, int x, int y) {
  planes.refraction.at(x, y).w += spread.variance;
  planes.diffuseZ.at(x, y) = std::min(planes.diffuseZ.at(x, y), spread.z);
}

// A ray's fog to the sums of its pixel.
//   spread  null for fog that does not diffuse
void addMarched(const shading::FogSums& sums, int order, const shading::FogSpread* spread, OitPlanes& planes, int x,
                int y, PublishedClamps& clamps) {
  if (!shading::fogShows(sums)) return;
  shading::OitSums own = shading::fogOitSums(sums, order);
  if (planes.published()) {
    // These targets keep no light that adds: what the fog emits is part of its colour.
    const float hides = shading::pldOneMinusExp(std::min(sums.depth, shading::PLD_OPAQUE_DEPTH));
    if (shading::meanOf(sums.emitted) > 0.0f && hides > 0.0f) own.numerator += own.denominator / hides * sums.emitted;
    blendPublished(publishedLayer(own, spread ? spread->variance : 0.0f), planes, x, y, clamps);
    return;
  }
  const shading::OitTargets added = shading::packSums(own);
  planes.radiance.at(x, y) += added.radiance;
  planes.weight.at(x, y) += added.weight;
  planes.opacity.at(x, y) += added.opacity;
  planes.depth.at(x, y) += added.depth;
  planes.light.at(x, y) += added.light;
  planes.frontZ.at(x, y) = std::min(planes.frontZ.at(x, y), shading::fogZ(sums));
  if (spread && spread->variance > 0.0f) addSpread(*spread, planes, x, y);
}

//   behind  planar depth of what ends the ray
void addRay(const FogMarcher& marcher, const shading::FogSpan& span, float behind, OitPlanes& planes, int x, int y,
            PublishedClamps& clamps) {
  const Fog& fog = marcher.fog;
  const shading::FogSums sums = marcher.text->marchFog(fog.medium, span, planes.info.weight, fog.order);
  const shading::FogSpread spread = shading::fogSpread(fog.medium, sums, fog.diffusion, behind);
  addMarched(sums, fog.order, planes.scatters() ? &spread : nullptr, planes, x, y, clamps);
}

}  // namespace

void addFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, OitPlanes& planes, PublishedClamps* clamps) {
  const FogMarcher marcher(fog, gbuffer, planes.data, sample);
  if (fog.diffuses()) addScatterPlanes(planes);
  tbb::enumerable_thread_specific<PublishedClamps> own;
  tbb::parallel_for(tbb::blocked_range<int>(0, planes.data.height()), [&](const tbb::blocked_range<int>& rows) {
    const FlushDenormals flush;
    PublishedClamps& counted = own.local();
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < planes.data.width(); ++x) {
        const float z = std::min(gbuffer.viewZ.at(x, y), planes.solid.at(x, y).a);
        addRay(marcher, marcher.span(x, y, z), z, planes, x, y, counted);
      }
  });
  if (clamps)
    for (const PublishedClamps& each : own) *clamps += each;
}

void addFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const HeldOutRow& row, OitPlanes& planes,
            PublishedClamps* clamps) {
  const FogMarcher marcher(fog, gbuffer, gbuffer.data, sample);
  const FlushDenormals flush;
  PublishedClamps counted;
  for (int i = 0; i < planes.data.width(); ++i) {
    const auto entry = static_cast<std::size_t>(i);
    const glm::ivec2 at = row.pixel[entry] - glm::ivec2(gbuffer.data.x0, gbuffer.data.y0);
    const float z = std::min({gbuffer.viewZ.at(at.x, at.y), row.z[entry], planes.solid[entry].a});
    addRay(marcher, marcher.span(at.x, at.y, z), z, planes, i, 0, counted);
  }
  if (clamps) *clamps += counted;
}

void addFogScattering(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, OitPlanes& planes) {
  if (!fog.diffuses()) return;
  addScatterPlanes(planes);
  const FogMarcher marcher(fog, gbuffer, planes.data, sample);
  tbb::parallel_for(0, planes.data.height(), [&](int y) {
    const FlushDenormals flush;
    for (int x = 0; x < planes.data.width(); ++x) {
      const float z = std::min(gbuffer.viewZ.at(x, y), planes.solid.at(x, y).a);
      const shading::FogSpread spread = marcher.spread(marcher.span(x, y, z), z);
      if (spread.variance > 0.0f) addSpread(spread, planes, x, y);
    }
  });
}

MarchedFog::MarchedFog(const Fog& fog, const GBuffer& gbuffer, glm::dvec2 sample, const PixelPlaces& places,
                       const Image<glm::vec4>& solid)
    : order_(fog.order), steps_(places.size()), netOpacity_(places.size(), 0.0f) {
  const FogMarcher marcher(fog, gbuffer, gbuffer.data, sample);
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    const FlushDenormals flush;
    const glm::ivec2 at = places[i];
    const shading::FogSpan span = marcher.span(at.x, at.y, std::min(gbuffer.viewZ.at(at.x, at.y), solid[i].a));
    const float whole = marcher.text->fogDepth(fog.medium, span);
    if (!(whole > 0.0f) && !fog.gridEmits()) return;
    netOpacity_[i] = shading::pldOneMinusExp(whole);
    for (int k = 0; k < static_cast<int>(fog.medium.march.y); ++k) {
      const shading::FogStep step = marcher.text->fogStep(fog.medium, span, k);
      Step kept{glm::vec3(0.0f), glm::vec3(0.0f), step.depth, step.z};
      if (fog.emits()) kept.emitted = marcher.text->emittedInStep(fog.medium, step);
      if (step.depth > 0.0f) kept.source = marcher.text->scatteredAt(fog.medium, step.middle, span.direction);
      if (step.depth > 0.0f || kept.emitted != glm::vec3(0.0f)) steps_[i].push_back(kept);
    }
  });
}

void MarchedFog::addTo(OitPlanes& planes, PublishedClamps& clamps) const {
  const auto width = static_cast<std::size_t>(planes.data.width());
  tbb::enumerable_thread_specific<PublishedClamps> own;
  tbb::parallel_for(std::size_t{0}, steps_.size(), [&](std::size_t i) {
    const FlushDenormals flush;
    shading::FogSums sums = shading::noFog();
    for (const Step& step : steps_[i]) {
      sums = shading::addEmitted(sums, step.z, step.emitted, planes.info.weight);
      if (step.depth > 0.0f)
        sums = shading::addStep(sums, step.depth, step.z, step.source, planes.info.weight, netOpacity_[i], order_);
    }
    addMarched(sums, order_, nullptr, planes, static_cast<int>(i % width), static_cast<int>(i / width), own.local());
  });
  for (const PublishedClamps& each : own) clamps += each;
}

FogRay fogThrough(const Fog& fog, glm::vec3 origin, glm::vec3 direction, float zPerMetre, float z) {
  shading::MarchText text(fog);
  const shading::FogSpan span = shading::fogSpan(fog.medium, origin, direction, zPerMetre, z);
  shading::WeightSettings uniform{shading::PLD_WEIGHT_UNIFORM, 0.1f, 1000.0f, 1.0f, 1.0f};
  const shading::FogSums sums = text.marchFog(fog.medium, span, uniform, shading::PLD_FOG_ORDERED);
  return {sums.radiance + sums.emitted, sums.passed, sums.depth};
}

}  // namespace pellucid
