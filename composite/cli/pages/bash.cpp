#include "composite/cli/pages/pages.h"
#include "composite/cli/suggest.h"

namespace pellucid::cli {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

// What completes the value of a flag; "" for what a user has to know.
std::string valueCommand(const ValueWords& words) {
  if (!words.choices.empty()) return "COMPREPLY=($(compgen -W '" + joined(words.choices) + "' -- \"$cur\"))";
  if (words.folder) return "COMPREPLY=($(compgen -d -- \"$cur\"))";
  if (words.file && !words.ending.empty()) return "_pellucid_files " + words.ending;
  return words.file ? "_pellucid_files '*'" : "COMPREPLY=()";
}

std::string valuesOf(const CLI::App& verb) {
  std::string cases;
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_positional()) continue;
    const ValueWords words = valueWords(*option, verb.get_name());
    if (words.none) continue;
    std::string names;
    for (const std::string& name : option->get_snames()) names += (names.empty() ? "-" : " | -") + name;
    for (const std::string& name : option->get_lnames()) names += (names.empty() ? "--" : " | --") + name;
    cases += "        " + names + ") " + valueCommand(words) + "; return ;;\n";
  }
  return cases;
}

}  // namespace

std::string bashCompletion(const CLI::App& app) {
  std::vector<std::string> names;
  std::string verbs;
  for (const CLI::App* verb : verbsOf(app)) {
    names.push_back(verb->get_name());
    verbs += "    " + verb->get_name() + ")\n      flags='" + joined(flagsOf(*verb)) + "'\n";
    if (const std::string values = valuesOf(*verb); !values.empty())
      verbs += "      case $prev in\n" + values + "      esac\n";
    verbs += "      ;;\n";
  }
  return "# Completion of pellucid for bash, made of the program's flags.\n"
         "_pellucid_files() {\n"
         "  compopt -o filenames 2>/dev/null\n"
         "  COMPREPLY=($(compgen -d -- \"$cur\") $(compgen -f -X \"!*.$1\" -- \"$cur\"))\n"
         "  [[ $1 != '*' ]] || COMPREPLY=($(compgen -f -- \"$cur\"))\n"
         "}\n\n"
         "_pellucid() {\n"
         "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} flags=''\n"
         "  COMPREPLY=()\n"
         "  if ((COMP_CWORD == 1)); then\n"
         "    COMPREPLY=($(compgen -W '" +
         joined(names) + " " + joined(flagsOf(app)) +
         "' -- \"$cur\"))\n    return\n  fi\n  case ${COMP_WORDS[1]} in\n" + verbs +
         "  esac\n"
         "  if [[ $cur == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$flags\" -- \"$cur\"))\n"
         "  else\n"
         "    _pellucid_files '*'\n"
         "  fi\n"
         "}\n"
         "complete -F _pellucid pellucid\n";
}

}  // namespace pellucid::cli
