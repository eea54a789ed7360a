// Whether a file could be written, without writing it.
#pragma once
#include <string>

namespace pellucid {

// Throws the ResourceError that an AtomicFile of this target would end in, as far as that can be known without writing:
// its folder is missing or takes no files, or something other than a file that may be replaced stands there.
void expectWritable(const std::string& target);

}  // namespace pellucid
