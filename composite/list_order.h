// An order of fragment lists that no submission order decides.
#pragma once
#include "gbuffer/fragments.h"

namespace pellucid {

// Sorts each pixel's fragments from near to far, equal depths by all their bits: whoever goes over the result in order
// gives the same bits for every order of the lists.
void orderByDepthAndBits(FragmentLists& lists);

}  // namespace pellucid
