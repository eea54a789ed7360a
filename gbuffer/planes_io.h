// OIT planes as an EXR file: layer `oit`, float, with a `pellucid:` header that says how the sums were made.
#pragma once
#include <string>

#include "gbuffer/accum.h"

namespace pellucid {

// Every bit of the planes, of `info` and of the camera comes back from readPlanes. Throws ResourceError.
void writePlanes(const std::string& path, const OitPlanes& planes);
// Throws InputError for a damaged file or a sum that is not finite, MeaningError for one without the planes or the
// header.
OitPlanes readPlanes(const std::string& path);

}  // namespace pellucid
