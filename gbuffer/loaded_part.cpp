#include "gbuffer/loaded_part.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "gbuffer/errors.h"

namespace pellucid {

void* loadedPart(const char* file, const char* symbol) {
  // A second dlopen of one file gives the same library, so nothing is kept here.
  void* const library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  void* const address = library ? dlsym(library, symbol) : nullptr;
  if (address) return address;
  const char* const why = dlerror();
  throw ResourceError(
      fmt::format("{}: found no such part of the program, expected it in the folder pellucid beside the "
                  "libraries: {}",
                  file, why ? why : "no reason given"));
}

}  // namespace pellucid
