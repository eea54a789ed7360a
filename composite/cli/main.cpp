#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "composite/cli/verbs.h"

namespace {

// Whole planes go back to the system when they are freed. The C library raises its limit to the largest block freed so
// far, up to 32 MiB: planes of later passes would then lie between small blocks, and what is free among them is no use.
void givePlanesBack() {
#ifdef __GLIBC__
  constexpr int kPlane = 4 << 20;  // bytes; smaller ones are used again sooner than the system would clear new ones
  mallopt(M_MMAP_THRESHOLD, kPlane);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  givePlanesBack();
  return pellucid::cli::run(argc, argv);
}
