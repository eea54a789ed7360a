#include "composite/cli/help_text.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "composite/cli/application.h"
#include "composite/cli/help_groups.h"

namespace pellucid::cli {
namespace {

constexpr std::size_t kFewChoices = 28;  // characters of choices that stand beside the flag

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

}  // namespace

std::vector<std::string> choicesOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto open = type.find('{'), close = type.rfind('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  std::vector<std::string> choices;
  std::istringstream words(type.substr(open + 1, close - open - 1));
  for (std::string word; std::getline(words, word, ',');) choices.push_back(word);
  return choices;
}

std::string choicesText(const CLI::Option& option, const char* separator) {
  std::string text;
  for (const std::string& choice : choicesOf(option)) text += (text.empty() ? "" : separator) + choice;
  return text;
}

// "-o, --output FILE", or with the first of its names alone
std::string flagText(const CLI::Option& option, bool first) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += (names.empty() ? "-" : ", -") + name;
  for (const std::string& name : option.get_lnames()) names += (names.empty() ? "--" : ", --") + name;
  if (first) names = names.substr(0, names.find(','));
  if (option.get_items_expected_max() == 0) return names;
  const HelpRow* row = option.get_lnames().empty() ? nullptr : helpRow("--" + option.get_lnames()[0]);
  const std::string choices = choicesText(option, "|");
  if (!choices.empty() && choices.size() <= kFewChoices) return names + " " + choices;
  return names + " " + (row && *row->value ? row->value : "VALUE");
}

// A capital and a full stop. A name such as "exact:" keeps its letter.
std::string helpSentence(std::string text) {
  if (text.empty()) return text;
  const auto word = text.substr(0, text.find_first_of(" :,;"));
  const bool isName = word.find_first_not_of("abcdefghijklmnopqrstuvwxyz") != std::string::npos ||
                      text.size() == word.size() || text[word.size()] != ' ';
  if (!isName) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (text.back() != '.' && text.back() != '?') text += '.';
  return text;
}

// "SCENES..." of a positional
std::string placeText(const CLI::Option& option) {
  const std::string name = upper(option.get_name(true, false));
  const std::string several = option.get_items_expected_max() >= CLI::detail::expected_max_vector_size ? "..." : "";
  return option.get_required() ? name + several : "[" + name + several + "]";
}

std::string usageText(const CLI::App& verb) {
  std::string usage = "pellucid " + verb.get_name();
  for (const CLI::Option* option : verb.get_options())
    if (option->get_positional())
      usage += " " + placeText(*option);
    else if (option->get_required())
      usage += " " + flagText(*option, true);
  return usage;
}

namespace {

std::string helpOfVerb(const CLI::App& verb) {
  std::string files, flags;
  for (const CLI::Option* option : verb.get_options())
    if (option->get_positional()) files += helpRowText(placeText(*option), helpSentences(*option));
  const auto lists = [&](const std::string& heading, auto&& belongs) {
    std::string rows;
    for (const CLI::Option* option : verb.get_options())
      if (option->nonpositional() && belongs(*option)) rows += helpRowText(flagText(*option), helpSentences(*option));
    if (!rows.empty()) flags += "\n" + heading + "\n" + rows;
  };
  for (const std::string& group : helpGroups())
    lists(group, [&](const CLI::Option& option) { return option.get_group() == group; });
  std::string help = wrapped(helpSentence(verb.get_description()), 0, 0) + "\n\n  " + usageText(verb) + " [FLAGS]\n";
  if (const std::string example = exampleOf(verb.get_name()); !example.empty())
    help += "\nFor example\n  " + example + "\n";
  if (!files.empty()) help += "\nFiles\n" + files;
  return help + flags;
}

std::string helpOfProgram(const CLI::App& app) {
  std::string help = app.get_description() + "\n\n  pellucid VERB FILES... [FLAGS]\n\nVerbs\n";
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    help += helpRowText(verb->get_name(), helpSentence(verb->get_description()));
  help += "\nFor example\n  " + exampleOf("composite") + "\n\nFlags\n";
  for (const CLI::Option* option : app.get_options()) help += helpRowText(flagText(*option), helpSentences(*option));
  return help + "\n" +
         wrapped("pellucid VERB --help lists the flags of a verb, pellucid help TOPIC what some of them take: " +
                     helpTopics() + ".",
                 0, 0) +
         "\n";
}

}  // namespace

std::string HelpText::make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const {
  return app->get_parent() ? helpOfVerb(*app) : helpOfProgram(*app);
}

std::string helpSentences(const CLI::Option& option) {
  std::string text = helpSentence(option.get_description());
  const std::string choices = choicesText(option, ", ");
  if (choices.size() > kFewChoices) text += " One of " + choices + ".";
  if (const std::string type = option.get_type_name(); type.find(" in [") != std::string::npos) {
    std::string range = type.substr(type.find(" in [") + 5);
    range = range.substr(0, range.find(']'));
    if (const auto dash = range.find(" - "); dash != std::string::npos) range.replace(dash, 3, " to ");
    text += " From " + range + ".";
  }
  std::string standard = option.get_default_str();
  if (standard.size() > 1 && standard.front() == '[' && standard.back() == ']')
    standard = standard.substr(1, standard.size() - 2);
  if (standard.size() > kFewChoices)  // a list, which wraps between its words
    for (std::size_t comma = 0; (comma = standard.find(',', comma)) != std::string::npos; comma += 2)
      standard.replace(comma, 1, ", ");
  if (!standard.empty() && !option.get_required()) text += " Default: " + standard + ".";
  return text;
}

}  // namespace pellucid::cli
