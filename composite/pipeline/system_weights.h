// Weights of single systems, by the names of these: --system-weight.
#pragma once
#include <string>
#include <vector>

#include "composite/edges.h"
#include "composite/pipeline/painter.h"
#include "composite/pipeline/systems.h"
#include "gbuffer/depth_plane.h"

namespace pellucid {

// NAME=WEIGHT, a weight as --weight has it, auto among them. Throws UsageError.
SystemWeight readSystemWeight(const std::string& text);

// What a header holds of them, a line for each: its name and its weight with every bit. The reverse throws nothing:
// nothing for text that is none.
std::string systemWeightsText(const std::vector<SystemWeight>& weights);
std::optional<std::vector<SystemWeight>> readSystemWeightsText(const std::string& text);

// That of one system; null where it has none of its own.
const SystemWeight* weightOf(const PaintSystems& systems, const LayerSystem& system);

// Throws UsageError for a name that no system has.
void checkSystemNames(const PaintSystems& asked, const std::vector<LayerSystem>& systems);

// The same with a weight in the place of each that is to be fitted: to the truth of that system's layers alone, without
// the fog between systems.
//   context  of the whole picture
//   planes, edges  as for PassPicture
PaintSystems fittedSystems(const PaintContext& context, const PassSettings& sample, const DepthPlanes* planes,
                           const EdgePasses* edges);

}  // namespace pellucid
