// Functions and files that are too long to read at once.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "tests/house/rules.h"

namespace pellucid::test {

struct FunctionText {
  std::string name;  // what stands before its parameters: "run", "Renderer::prepare"
  int line;          // where it begins, from 1
  int lines;         // from its first line to its closing brace
};

// The functions of a C++ or GLSL text, those of classes included; lambdas belong to what they stand in.
std::vector<FunctionText> functionsOf(const std::string& text);

// "path name" or "path" to how many lines it still has.
using Allowances = std::map<std::string, int>;

// Functions of more than `most` lines that no allowance covers.
Violations longFunctions(const SourceFile& file, int most, const Allowances& allowed);
// Files of more than `most` lines that no allowance covers.
Violations longFiles(const SourceFile& file, int most, const Allowances& allowed);

}  // namespace pellucid::test
