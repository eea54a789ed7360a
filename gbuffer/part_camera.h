// The camera that the attributes of an EXR part state.
#pragma once
#include "gbuffer/opaque_io.h"

namespace pellucid {

// Sets file.gbuffer.camera from worldToCamera and worldToNDC. Attributes that contradict themselves, or one without the
// other, are a note and no camera.
//   unit  metres in one scene unit
void readCamera(const ExrPart& part, double unit, OpaqueFile& file);

}  // namespace pellucid
