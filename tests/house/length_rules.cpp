#include "tests/house/length_rules.h"

#include <algorithm>
#include <cctype>
#include <regex>

namespace pellucid::test {
namespace {

// Blanks text[from, to) but for its ends of lines.
void blank(std::string& text, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < std::min(to, text.size()); ++i)
    if (text[i] != '\n') text[i] = ' ';
}

// The end of the literal or comment that begins at `i`, or `i` where none does.
std::size_t endOfSilence(const std::string& text, std::size_t i) {
  const auto after = [&](const std::string& end, std::size_t from) {
    const std::size_t found = text.find(end, from);
    return found == std::string::npos ? text.size() : found + end.size();
  };
  if (text.compare(i, 2, "//") == 0) return std::min(text.find('\n', i), text.size());
  if (text.compare(i, 2, "/*") == 0) return after("*/", i + 2);
  if (text.compare(i, 2, "R\"") == 0) {
    const std::size_t open = text.find('(', i);
    return open == std::string::npos ? text.size() : after(")" + text.substr(i + 2, open - i - 2) + "\"", open);
  }
  const char quote = text[i];
  // A quote inside of a number only parts its digits.
  const bool parts = quote == '\'' && i > 0 && std::isalnum(static_cast<unsigned char>(text[i - 1]));
  if ((quote != '"' && quote != '\'') || parts) return i;
  std::size_t end = i + 1;
  while (end < text.size() && text[end] != quote && text[end] != '\n') end += text[end] == '\\' ? 2 : 1;
  return end + 1;
}

// The same lines without comments, literals and directives.
std::string codeOf(const std::string& text) {
  std::string code = text;
  bool begins = true;  // of a line
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = endOfSilence(text, i);
    if (begins && text[i] == '#') {
      end = i;  // with the lines that a backslash adds
      do end = std::min(text.find('\n', end + 1), text.size());
      while (end < text.size() && text[end - 1] == '\\');
    }
    begins = text[i] == '\n' || (begins && text[i] == ' ');
    if (end == i) {
      ++i;
      continue;
    }
    blank(code, i, end);
    i = end;
  }
  return code;
}

enum class Block { space, type, function, other };

// What a brace opens, by what stands before it.
Block blockOf(const std::string& head) {
  static const std::regex space(R"(^\s*(inline )?(namespace\b|extern\s*$))"),
      type(R"(\b(struct|class|enum|union)\b[^()]*$)"), function(R"(\)[^=]*$)");
  if (std::regex_search(head, space)) return Block::space;
  if (std::regex_search(head, type)) return Block::type;
  return std::regex_search(head, function) ? Block::function : Block::other;
}

std::string nameOf(const std::string& head) {
  static const std::regex name(R"(([\w:~]+|operator\S+)\s*\()");
  std::smatch found;
  return std::regex_search(head, found, name) ? found[1].str() : "?";
}

}  // namespace

std::vector<FunctionText> functionsOf(const std::string& text) {
  struct Open {
    Block block;
    int line;
    std::string head;
  };
  std::vector<FunctionText> functions;
  std::vector<Open> open;
  std::string head;
  int line = 1, began = 0;
  for (const char c : codeOf(text)) {
    if (c == '{') {
      open.push_back({blockOf(head), began ? began : line, head});
    } else if (c == '}' && !open.empty()) {
      const Open closed = open.back();
      open.pop_back();
      const bool outermost = std::all_of(open.begin(), open.end(), [](const Open& each) {
        return each.block == Block::space || each.block == Block::type;
      });
      if (closed.block == Block::function && outermost)
        functions.push_back({nameOf(closed.head), closed.line, line - closed.line + 1});
    }
    if (c == '{' || c == '}' || c == ';') {
      head.clear();
      began = 0;
    } else {
      if (!began && !std::isspace(static_cast<unsigned char>(c))) began = line;
      head += c;
    }
    if (c == '\n') ++line;
  }
  return functions;
}

Violations longFunctions(const SourceFile& file, int most, const Allowances& allowed) {
  Violations found;
  for (const FunctionText& function : functionsOf(file.text)) {
    const auto allowance = allowed.find(file.path + " " + function.name);
    const int limit = allowance == allowed.end() ? most : allowance->second;
    if (function.lines > limit)
      found.push_back(file.path + ":" + std::to_string(function.line) + ": " + function.name + " has " +
                      std::to_string(function.lines) + " lines, expected " + std::to_string(limit) + " at most");
  }
  return found;
}

Violations longFiles(const SourceFile& file, int most, const Allowances& allowed) {
  const auto allowance = allowed.find(file.path);
  const int limit = allowance == allowed.end() ? most : allowance->second;
  const int lines = static_cast<int>(std::count(file.text.begin(), file.text.end(), '\n'));
  if (lines <= limit) return {};
  return {file.path + ": has " + std::to_string(lines) + " lines, expected " + std::to_string(limit) + " at most"};
}

}  // namespace pellucid::test
