// Depth as renderers store it, to planar metres.
#pragma once
#include <optional>
#include <string>

#include "gbuffer/depth_kind.h"
#include "gbuffer/exr_document.h"
#include "gbuffer/opaque_io.h"
#include "gbuffer/producers.h"

namespace pellucid {

// Fills gbuffer.viewZ and depthPrecision, and of the choice kind, far value and counts.
//   asked     what --depth-kind says, or what the producer writes, or planar
//   isAsked   the user said so: evidence against it is not looked for
//   producer  null: nobody that is known
//   camera    needed for ray and device; may be null otherwise
// Throws MeaningError when it is missing or has no clip range, and where the reading is left to the picture, which does
// not tell; UsageError for a far value that is none.
void convertDepth(const ExrPart& part, const ExrChannel& depth, const DepthKind& asked, bool isAsked,
                  const Producer* producer, std::optional<double> far, const Camera* camera, OpaqueFile& file);

}  // namespace pellucid
