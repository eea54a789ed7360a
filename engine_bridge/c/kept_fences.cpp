#include "engine_bridge/c/kept_fences.h"

namespace pellucid::c {

void KeptFences::create(const GlFunctions& gl) {
  if (gl.onProcessor) gl.GenQueries(kMarks, queries_);
}

void KeptFences::destroy(const GlFunctions& gl) {
  if (queries_[0]) gl.DeleteQueries(kMarks, queries_);
  queries_[0] = 0;
}

void KeptFences::mark(const GlFunctions& gl) {
  if (!queries_[0]) return;
  gl.QueryCounter(queries_[next_], GL_TIMESTAMP);
  next_ = (next_ + 1) % kMarks;
}

}  // namespace pellucid::c
