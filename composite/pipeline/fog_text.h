// What a user writes of fog and of its grids.
#pragma once
#include <string>
#include <vector>

#include "composite/pipeline/request.h"

namespace pellucid {

// What a list key=value,... says. Throws UsageError.
FogText readFogText(const std::string& text);
// The same keys of a JSON file with one object. Throws InputError.
FogText readFogFile(const std::string& path);
extern const char* const kFogKeys;  // for help

// FILE.vdb[:GRID][=ROLE]. Without a role, grids named `temperature` hold temperature, `emission` and `flames` emission,
// all others density. Throws UsageError.
FogGrid readFogGrid(const std::string& text);
const char* nameOf(GridRole role);

// What can be said of it without a file. Throws UsageError.
void checkFog(const FogText& text, const std::vector<FogGrid>& grids);

}  // namespace pellucid
