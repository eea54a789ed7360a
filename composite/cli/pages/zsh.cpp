#include "composite/cli/help_text.h"
#include "composite/cli/pages/pages.h"

namespace pellucid::cli {
namespace {

// Inside of single quotes, where _arguments reads brackets and colons.
std::string zshText(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else if (c == '[' || c == ']' || c == ':' || c == '\\')
      out += std::string("\\") + c;
    else
      out += c;
  }
  return out;
}

std::string actionOf(const ValueWords& words) {
  if (!words.choices.empty()) {
    std::string choices;
    for (const std::string& choice : words.choices) choices += (choices.empty() ? "" : " ") + zshText(choice);
    return "(" + choices + ")";
  }
  if (words.folder) return "_files -/";
  if (!words.file) return " ";
  return words.ending.empty() ? "_files" : "_files -g \"*." + words.ending + "\"";
}

std::string specsOf(const CLI::App& verb) {
  std::string specs;
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_positional()) continue;
    const ValueWords words = valueWords(*option, verb.get_name());
    const std::string text = helpSentences(*option);
    const std::string tail =
        "[" + zshText(text.substr(0, text.find(". "))) + "]" + (words.none ? "" : ":value:" + actionOf(words)) + "'";
    for (const std::string& name : option->get_snames()) specs += " \\\n        '*-" + name + tail;
    for (const std::string& name : option->get_lnames()) specs += " \\\n        '*--" + name + tail;
  }
  return specs;
}

}  // namespace

std::string zshCompletion(const CLI::App& app) {
  std::string verbs, cases;
  for (const CLI::App* verb : verbsOf(app)) {
    const std::string& text = verb->get_description();
    verbs += "    '" + verb->get_name() + ":" + zshText(text) + "'\n";
    cases +=
        "    " + verb->get_name() + ")\n      _arguments" + specsOf(*verb) + " \\\n        '*:file:_files'\n      ;;\n";
  }
  return "#compdef pellucid\n# Completion of pellucid for zsh, made of the program's flags.\n"
         "_pellucid() {\n  local -a verbs\n  verbs=(\n" +
         verbs +
         "  )\n"
         "  if ((CURRENT == 2)); then\n    _describe verb verbs\n    return\n  fi\n"
         "  local verb=$words[2]\n  shift words\n  ((CURRENT--))\n  case $verb in\n" +
         cases + "  esac\n}\n_pellucid \"$@\"\n";
}

}  // namespace pellucid::cli
