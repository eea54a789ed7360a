// Fragment lists of a shot from wherever its layers come: glTF through GL, deep files, or both.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "composite/deep/deep_source.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid::cli {

// Hands on lists of windows that together cover the data window, from the top. Without a pass only the deep files'
// samples are there; deep samples are filtered already, so `settings.sample` does not move them. Fog joins as runs
// between the surfaces.
//   pass  may be null
void eachList(TransparentPass* pass, std::vector<std::unique_ptr<DeepSource>>& deep, const GBuffer& gbuffer,
              const PassSettings& settings, VolumeRule rule, const std::function<void(const FragmentLists&)>& tile);

}  // namespace pellucid::cli
