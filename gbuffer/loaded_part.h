// Parts of the program that few runs need and that bring many libraries with them. They are loaded when first used, so
// that a run without them starts at once.
#pragma once

namespace pellucid {

// The address of `symbol` in the part `file`, found along the run path of the program. The part stays loaded.
// Throws ResourceError with the loader's own words.
void* loadedPart(const char* file, const char* symbol);

template <class Function>
Function* partFunction(const char* file, const char* symbol) {
  return reinterpret_cast<Function*>(loadedPart(file, symbol));
}

}  // namespace pellucid
