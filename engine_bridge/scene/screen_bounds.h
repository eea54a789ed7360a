// Where in a picture the transparent triangles of a scene may show: the pixels that passes are about.
#pragma once
#include "engine_bridge/scene/scene.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// The part of the data window, display coordinates, that any sample of which may meet a transparent triangle lies in.
// All of the window where a triangle reaches from before the eye behind it, and for scenes of more than a million
// triangles, which are not read for this. At least one pixel.
Window screenBounds(const Scene& scene, const Camera& camera, const GBuffer& gbuffer);

}  // namespace pellucid
