#include "composite/cli/freed_memory.h"

#ifdef __GLIBC__
#include <malloc.h>

#include <limits>
#endif

namespace pellucid::cli {

// The C library raises its limit to the largest block freed so far, up to 32 MiB: planes of later passes would then lie
// between small blocks, and what is free among them is no use.
void givePlanesBack() {
#ifdef __GLIBC__
  constexpr int kPlane = 4 << 20;  // bytes; smaller ones are used again sooner than the system would clear new ones
  mallopt(M_MMAP_THRESHOLD, kPlane);
#endif
}

void keepPlanes() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

}  // namespace pellucid::cli
