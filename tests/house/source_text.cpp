#include "tests/house/source_text.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "tests/house/rules.h"

namespace pellucid::test {
namespace {

std::string textOf(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

std::vector<SourceFile> sourceFiles() {
  static const std::set<std::string> kinds = {".h", ".hpp", ".c", ".cpp", ".glsl", ".vert", ".frag", ".comp", ".geom"};
  const std::filesystem::path top = PELLUCID_SOURCE_DIR;
  std::vector<SourceFile> files;
  for (const std::string& room : rooms()) {
    if (!std::filesystem::is_directory(top / room)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(top / room))
      if (entry.is_regular_file() && kinds.count(entry.path().extension().string()))
        files.push_back({entry.path().lexically_relative(top).string(), textOf(entry.path())});
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<Include> includesOf(const std::string& text) {
  static const std::regex pattern(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
  std::vector<Include> includes;
  int number = 0;
  for (const std::string& line : linesOf(text)) {
    ++number;
    std::smatch found;
    if (std::regex_search(line, found, pattern)) includes.push_back({number, found[2], found[1] == "\""});
  }
  return includes;
}

std::string withoutComments(const std::string& text) {
  enum { code, lineComment, blockComment, literal } state = code;
  std::string out = text;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i], next = i + 1 < text.size() ? text[i + 1] : '\0';
    const bool blank = state != code;
    if (state == code) {
      if (c == '/' && next == '/') state = lineComment;
      if (c == '/' && next == '*') state = blockComment;
      if (c == '"') state = literal;
      if (state == lineComment || state == blockComment) out[i] = ' ';
    } else if (state == lineComment) {
      if (c == '\n') state = code;
    } else if (state == blockComment) {
      if (c == '/' && i > 0 && text[i - 1] == '*') state = code;
    } else if (c == '"' && text[i - 1] != '\\') {
      state = code;
    }
    if (blank && c != '\n') out[i] = ' ';
  }
  return out;
}

}  // namespace pellucid::test
