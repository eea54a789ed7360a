// Source files of the tree as the house rules read them.
#pragma once
#include <string>
#include <vector>

namespace pellucid::test {

struct SourceFile {
  std::string path;  // from the top of the tree, "gbuffer/image.h"
  std::string text;
};

struct Include {
  int line;          // from 1
  std::string name;  // without its brackets or quotes
  bool quoted;
};

// Every C++ and GLSL file of the rooms, sorted by path.
std::vector<SourceFile> sourceFiles();
std::vector<Include> includesOf(const std::string& text);
// The same lines, with comments and the insides of string literals blanked.
std::string withoutComments(const std::string& text);
std::vector<std::string> linesOf(const std::string& text);

}  // namespace pellucid::test
