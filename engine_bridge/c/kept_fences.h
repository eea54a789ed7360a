// Keeps the driver's fences of what was drawn, for the sake of one driver that frees them too early.
#pragma once
#include "engine_bridge/c/gl_functions.h"

namespace pellucid::c {

// llvmpipe of Mesa 22.3.6 frees the fence of what it has drawn while one of its threads may still be about to let go of
// the fence's mutex: engine_bridge/README.md. A timestamp that nobody reads keeps the fence of the draws before it, and
// no GL object is made for it in a frame. Other drivers are left alone. What a host draws outside of the library's
// calls is its own to look after.
class KeptFences {
 public:
  void create(const GlFunctions& gl);
  void destroy(const GlFunctions& gl);
  void mark(const GlFunctions& gl);  // after draws, before the framebuffer changes

 private:
  // Four times what llvmpipe has in flight at most: when a query is used again, what it kept has long been let go of.
  static constexpr int kMarks = 256;
  GLuint queries_[kMarks] = {};
  int next_ = 0;
};

}  // namespace pellucid::c
