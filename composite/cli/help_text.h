// --help for people: a verb's flags under headings, whole sentences, lines of at most 100 columns.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace pellucid::cli {

class HelpText : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

// The text of one flag: what it does, the values it takes, its default. Whole sentences.
std::string helpSentences(const CLI::Option& option);

// Parts of it, for pages that are made of the same flags.
std::string helpSentence(std::string text);                                 // a capital and a full stop
std::string flagText(const CLI::Option& option, bool first = false);        // "-o, --output FILE", or its first name
std::string placeText(const CLI::Option& option);                           // "SCENES..." of a positional
std::string usageText(const CLI::App& verb);                                // "pellucid flatten FILES... -o FILE"
std::vector<std::string> choicesOf(const CLI::Option& option);              // of "TEXT:{a,b}" both; else empty
std::string choicesText(const CLI::Option& option, const char* separator);  // "a|b"; "" for what has no choices

// A name, and beside it in a column of its own what is said of it.
std::string helpRowText(const std::string& name, const std::string& text);

// `text` in lines of at most 100 columns. The first begins at column `at` of a line that is there already, the others
// are indented by `indent`.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t at);

}  // namespace pellucid::cli
