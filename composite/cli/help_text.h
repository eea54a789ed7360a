// --help for people: a verb's flags under headings, whole sentences, lines of at most 100 columns.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace pellucid::cli {

class HelpText : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

// The text of one flag: what it does, the values it takes, its default. Whole sentences.
std::string helpSentences(const CLI::Option& option);

// A name, and beside it in a column of its own what is said of it.
std::string helpRowText(const std::string& name, const std::string& text);

// `text` in lines of at most 100 columns. The first begins at column `at` of a line that is there already, the others
// are indented by `indent`.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t at);

}  // namespace pellucid::cli
