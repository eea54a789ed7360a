// OIT planes as an EXR file: layer `oit`, float, with a `pellucid:` header that says how the sums were made.
#pragma once
#include <string>

#include "gbuffer/accum.h"

namespace pellucid {

void writePlanes(const std::string& path, const OitPlanes& planes);
// Throws InputError for a damaged file, MeaningError for one without the planes or the header.
OitPlanes readPlanes(const std::string& path);

}  // namespace pellucid
