// Depth as renderers store it, to planar metres.
#pragma once
#include <optional>
#include <string>

#include "gbuffer/exr_document.h"
#include "gbuffer/opaque_io.h"

namespace pellucid {

// Fills gbuffer.viewZ and depthPrecision, and of the choice kind, far value and counts.
//   camera  needed for ray and device; may be null otherwise
// Throws MeaningError when it is missing or has no clip range, UsageError for an unknown kind.
void convertDepth(const ExrPart& part, const ExrChannel& depth, const ReadOptions& options, const Camera* camera,
                  OpaqueFile& file);

}  // namespace pellucid
