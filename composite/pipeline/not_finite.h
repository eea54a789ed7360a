// Finite in, finite out: where sums overflow all the same, the run says so.
#pragma once
#include "composite/pipeline/journal.h"
#include "composite/resolve.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// Notes how many pixels of the picture are not finite though the background is, and where the first one lies.
//   veil  that the picture is made of: elsewhere it is the background
void noteWhatIsNotFinite(const Picture& picture, const Veil& veil, const GBuffer& background, Journal& journal);

}  // namespace pellucid
