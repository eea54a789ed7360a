// shaders/shared/resolve.glsl over a row of pixels, eight side by side: the same bits, in less time.
#pragma once
#include "composite/veil.h"
#include "gbuffer/accum.h"

namespace pellucid {

// The model's mean, of sums that are not published, without self-modulation: resolve() of pixels [0, returned) of row
// y. The last ones, too few for all lanes, are left.
int resolveWide(const OitPlanes& planes, int y, Veil& veil);

}  // namespace pellucid
