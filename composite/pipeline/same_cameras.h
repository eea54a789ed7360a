// Cameras of several glTF files that are one camera.
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/scene/scene.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// Exporters write the shot's camera into every file: cameras that show the same within the same clip range are one,
// whatever their names.
bool allOneCamera(const std::vector<SceneCamera>& cameras, const GBuffer& gbuffer);

// The camera that --camera names. Its origin says so: what a flag says overrules what files state. Throws UsageError
// when there is none of the name, or several that differ.
Camera namedCamera(const std::string& name, const Scene& scene, const GBuffer& gbuffer);

}  // namespace pellucid
