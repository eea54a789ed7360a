#include "composite/pipeline/low_layers.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "composite/fold.h"
#include "composite/list_order.h"
#include "composite/low_runs.h"
#include "composite/pipeline/sums.h"

namespace pellucid {
namespace {

// Opacity's mean depth of each texel's layers; of what only adds light its nearest.
void meanDepths(const FragmentLists& lists, Image<float>& meanZ) {
  std::size_t pixel = 0;
  for (int y = lists.window.y0; y < lists.window.y1; ++y)
    for (int x = lists.window.x0; x < lists.window.x1; ++x, ++pixel) {
      double hidden = 0.0, depth = 0.0;
      float nearest = std::numeric_limits<float>::max();
      const auto add = [&](double opacity, float z) {
        hidden += opacity;
        depth += opacity * static_cast<double>(z);
        nearest = std::min(nearest, z);
      };
      for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i) {
        const Fragment& fragment = lists.fragments[i];
        if (takesPart(fragment, lists.solid[pixel]))
          add(static_cast<double>(shading::meanOf(fragment.coverage * (glm::vec3(1.0f) - fragment.transmission))),
              fragment.z);
      }
      if (lists.solid[pixel].a < std::numeric_limits<float>::infinity()) add(1.0, lists.solid[pixel].a);
      meanZ.at(x, y) = hidden > 0.0 ? static_cast<float>(depth / hidden) : nearest;
    }
}

}  // namespace

Image<float> opaqueDepth(TransparentPass& pass, const PassSettings& full, const GBuffer& gbuffer) {
  Image<float> z = pass.solidDepth(full);
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = std::min(gbuffer.viewZ[i], z[i]);
  return z;
}

LowResolutionFragments lowLayersOf(const PaintContext& context, const PassSettings& painted, int pass, Mixer& mixer,
                                   PassStatistics& statistics) {
  PassSettings sample = painted;
  sample.area = {};  // it is told in pixels, not in texels
  const GBuffer& gbuffer = *context.picture.gbuffer;
  TransparentPass& triangles = *context.sources.triangles();
  triangles.over(*context.picture.centres, context.shot.camera);  // solids are drawn at pixel centres
  Image<float> opaqueZ = opaqueDepth(triangles, fullResolutionPart(context.plan, sample), gbuffer);
  triangles.over(gbuffer, context.shot.camera);
  const auto seen = std::make_shared<const LowView>(
      lowViewOf(gbuffer, std::move(opaqueZ), context.shot.camera, context.plan.lowResolution, context.picture.planes));
  const LowView& view = *seen;
  const PassSettings part = lowResolutionPart(sample);
  const Window& texels = view.gbuffer.data;
  Veil veil(texels.width(), texels.height());
  Image<float> meanZ(texels.width(), texels.height(), 0.0f);
  OitPlanes scatter = emptyPlanes(texels, texels);
  const LowBetween others{sample.fog != nullptr, context.picture.deepOpaque};
  const std::shared_ptr<LowRuns> runs =
      mixer.cutsTexels() ? std::make_shared<LowRuns>(seen, sample.sample, others) : nullptr;
  {
    const DrawnOver over(triangles, view, gbuffer, context.shot.camera);
    triangles.fragments(part, [&](const FragmentLists& given) {
      FragmentLists lists = given;
      orderByDepthAndBits(lists);
      foldScattering(lists, scatter);
      meanDepths(lists, meanZ);
      mixer.mixTexels({part, pass, texels}, lists, veil);
      if (runs) runs->add(lists);
    });
    statistics = triangles.statistics();
  }
  LowResolutionFragments result(planesOfVeil(veil, meanZ, view, scatter.scatters() ? &scatter : nullptr), seen,
                                sample.sample, gbuffer.data);
  if (!runs || result.scatters()) return result;
  runs->finish();
  result.cutByLayers(runs);
  return result;
}

}  // namespace pellucid
