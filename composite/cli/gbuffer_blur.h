// Motion blur and depth of field of `gbuffer`: several renders, averaged.
#pragma once
#include <functional>

#include "composite/cli/gbuffer_render.h"

namespace pellucid::cli {

// Renders the scene as it stands, through a camera.
//   samples  colour samples a pixel; 1 is the pixel's centre
using RenderOnce = std::function<OpaquePlanes(const Camera& camera, std::optional<int> samples)>;

// That the flags of the shutter and of the lens go together, which needs no scene. Throws UsageError.
//   moment  when the scene's animations are played; nothing where no flag says it
void checkBlur(const GbufferFlags& flags, const std::optional<ShotMoment>& moment);

// The colours are the mean of --aa renders, each at its own time, from its own point of the lens and at its own place
// in the pixel, as `composite` has its passes; depth, normals, albedo and AO are those of the frame, sharp. Afterwards
// the scene stands at another time. The flags are those that checkBlur() has taken. Throws MeaningError.
//   camera  of the frame
OpaquePlanes renderBlurred(const GbufferFlags& flags, Scene& scene, SceneFiles& files,
                           const std::optional<ShotMoment>& moment, const ColourSpace& space, const Camera& camera,
                           const RenderOnce& render);

}  // namespace pellucid::cli
