// The library's own programs, each over the whole viewport.
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/c/gl_functions.h"

namespace pellucid::c {

class Program {
 public:
  // Empty on success, else the driver's words. Leaves the program current.
  std::string build(const GlFunctions& gl, const std::string& file, const std::vector<std::string>& defines);
  void destroy(const GlFunctions& gl);

  GLuint name = 0;
  // Asked of GL once for each name; names are literals.
  GLint place(const GlFunctions& gl, const char* uniform) const;

 private:
  static constexpr int kKept = 12;
  struct Kept {
    const char* uniform;
    GLint place;
  };
  mutable Kept kept_[kKept] = {};
};

}  // namespace pellucid::c
