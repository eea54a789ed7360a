// Lines of help: a name, and its text beside it.
#include <sstream>

#include "composite/cli/help_text.h"

namespace pellucid::cli {
namespace {

constexpr std::size_t kWidth = 100, kColumn = 30;

}  // namespace

std::string helpRowText(const std::string& name, const std::string& text) {
  std::string line = "  " + name;
  if (line.size() + 2 > kColumn)
    line += "\n" + std::string(kColumn, ' ');
  else
    line.resize(kColumn, ' ');
  return line + wrapped(text, kColumn, kColumn) + "\n";
}

std::string wrapped(const std::string& text, std::size_t indent, std::size_t at) {
  std::string out, word;
  std::size_t column = at;
  bool begins = true;
  std::istringstream words(text);
  while (words >> word) {
    if (!begins && column + 1 + word.size() > kWidth) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
      begins = true;
    }
    if (!begins) out += ' ', ++column;
    out += word;
    column += word.size();
    begins = false;
  }
  return out;
}

}  // namespace pellucid::cli
