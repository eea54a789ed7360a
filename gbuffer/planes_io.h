// OIT planes as an EXR file: layer `oit`, float, with a `pellucid:` header that says how the sums were made.
#pragma once
#include <string>

#include "gbuffer/accum.h"
#include "gbuffer/rim_planes.h"

namespace pellucid {

// Every bit of the planes, of `info` and of the camera comes back from readPlanes. Throws ResourceError.
//   rims  channels oit.rim.*, unless empty
void writePlanes(const std::string& path, const OitPlanes& planes, const RimPlanes& rims = {});
// Throws InputError for a damaged file or a sum that is not finite, MeaningError for one without the planes or the
// header.
//   rims  is given those of the file; a file that has some must not be read without
OitPlanes readPlanes(const std::string& path, RimPlanes* rims = nullptr);

}  // namespace pellucid
