// The files that an OpenColorIO config names: tables of its transforms. Included by this folder alone.
#pragma once
#include <string>

#include "composite/colour/library.h"

namespace pellucid {

// Every one of them lies under the config's own folder, or under `assetRoot`, after links are followed: a config from
// elsewhere reads nothing else. Those that are not there are met where they are used. Throws InputError.
//   path       of the config
//   assetRoot  a folder besides; "" for none
void expectNeighbours(const ocio::Config& config, const std::string& path, const std::string& assetRoot);

}  // namespace pellucid
