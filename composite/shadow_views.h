// What shadow maps hold, as pictures: PT17 fig. 11.
#pragma once
#include <string>
#include <vector>

#include "gbuffer/opaque_io.h"
#include "gbuffer/shadow_maps.h"

namespace pellucid {

struct ShadowViews {
  Window window;                   // of the largest face; smaller ones lie in its upper left
  std::vector<ExtraLayer> layers;  // none when no light has a map
};

// Of each face of each light, per channel: NAME.depth, the mean depth of the casters that the coins left, 0 at the
// nearest of the face and 1 at the farthest, 1.1 where there is none; and NAME.hidden, what all of them hide, [0,1]. Of
// opaque casters NAME.opaque.Z, in the map's units. Faces of one light are numbered, NAME.0 and on, where it has
// several.
//   names  of the lights, in the maps' order
ShadowViews shadowViews(const ShadowMaps& maps, const std::vector<std::string>& names);

}  // namespace pellucid
