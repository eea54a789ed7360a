// llvmpipe flushes denormals; a CPU task that must give its bits does too.
#pragma once
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace pellucid {

// While in scope, this thread reads denormals as 0 and writes 0 for them.
class FlushDenormals {
 public:
#if defined(__SSE2__)
  FlushDenormals() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | 0x8040u);
  }  // FTZ | DAZ
  ~FlushDenormals() {
    _mm_setcsr(before_);
  }

 private:
  unsigned before_;
#endif
 public:
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
};

}  // namespace pellucid
