// What can be told of an output from its name and its folder alone, so that it is told before any work is done.
#pragma once
#include <string>
#include <vector>

namespace pellucid {

enum class OutputKind { exr, page, image, folder };

struct Output {
  std::string flag;  // that names it, for messages: "-o"
  std::string path;
  OutputKind kind = OutputKind::exr;
};

// Nothing is opened and nothing is written. Throws
//   UsageError     the name ends otherwise than the format that is written (.exr, .html, .png), names a file where a
//   folder
//                  is written, or is that of an input or of another output, which would be replaced
//   ResourceError  the folder is missing or cannot be written, or something other than a file stands there already. A
//                  folder that is an output need not exist: it is made, with those above it.
void checkOutputs(const std::vector<Output>& outputs, const std::vector<std::string>& inputs);

}  // namespace pellucid
