// Why a picture shows nothing of a scene's transparent things, for the note that says so.
#pragma once
#include <string>

#include "engine_bridge/scene/scene.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// To be asked where nothing was drawn: reads every transparent triangle. What holds of all of them is told, with the
// flag that may be wrong: there are none, they lie behind the eye, beside the picture, or behind what it shows. A
// clause without an end, such as "it holds no mesh that is drawn".
std::string whyNothingShows(const Scene& scene, const Camera& camera, const GBuffer& gbuffer);

}  // namespace pellucid
