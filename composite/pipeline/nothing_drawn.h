// A run that changes nothing says so, and why.
#pragma once
#include <cstddef>

#include "composite/pipeline/shot.h"
#include "gbuffer/accum.h"

namespace pellucid {

// Notes that no pixel shows a layer of the shot, with the reason.
void noteThatNothingShows(const Shot& shot, Journal& journal);

bool anyTouched(const Image<std::uint8_t>& touched);
bool anyLayers(const OitPlanes& planes);

}  // namespace pellucid
