// The rules of the house that a text search can hold. Each returns one sentence per violation.
#pragma once
#include <string>
#include <vector>

#include "tests/house/source_text.h"

namespace pellucid::test {

using Violations = std::vector<std::string>;

// The folders that hold code, and the one a file belongs to: "composite/cli" and "composite/pipeline" are rooms
// of their own.
const std::vector<std::string>& rooms();
std::string roomOf(const std::string& path);

// Includes against the arrows: shaders <- gbuffer <- engine_bridge, composite <-
// composite/pipeline <- composite/cli <- samples, tests.
Violations againstArrows(const SourceFile& file);
// Libraries that only one room may know: GL and EGL, Embree, OpenEXR.
Violations libraryOutsideItsRoom(const SourceFile& file);
// What shaders/shared/ must not hold, or one of its two compilers reads it differently.
Violations againstSharedText(const SourceFile& file);
// Types of headers that share a name and a namespace: a program that links both uses the wrong one, and no compiler
// says so.
Violations definedTwice(const std::vector<SourceFile>& files);
// Headers that share a name: a reader asks which one is meant.
Violations headersNamedTwice(const std::vector<SourceFile>& files);
// Circles among the parts of a folder. A part is a header and the source of its name. It needs what either includes
// and, where a class of its header has members that are defined in another part's source, that part too: what includes
// the header reaches them.
Violations circlesIn(const std::string& folder, const std::vector<SourceFile>& files);
// Rooms of the tree below `top` that have no README.md.
Violations roomsWithoutReadme(const std::string& top);

}  // namespace pellucid::test
