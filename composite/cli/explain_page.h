// What --explain prints, as a diagram.
#pragma once
#include <string>
#include <vector>

namespace pellucid::cli {

//   described  lines of describe(): a word, blanks, and what it is
// Throws ResourceError.
void writeExplainPage(const std::string& page, const std::vector<std::string>& described, const std::string& opaque,
                      const std::vector<std::string>& inputs, const std::string& output);

}  // namespace pellucid::cli
