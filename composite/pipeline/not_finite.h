// Finite in, finite out: where sums overflow all the same, the run says so.
#pragma once
#include "composite/pipeline/journal.h"
#include "composite/resolve.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// Notes how many pixels of the picture are not finite though the background is, and where the first one lies.
void noteWhatIsNotFinite(const Picture& picture, const GBuffer& background, Journal& journal);

}  // namespace pellucid
