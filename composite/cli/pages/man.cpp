#include <sstream>

#include "composite/cli/application.h"
#include "composite/cli/help_groups.h"
#include "composite/cli/help_text.h"
#include "composite/cli/pages/pages.h"

namespace pellucid::cli {
namespace {

// A line that troff takes as text, whatever it begins with.
std::string troffText(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (c == '\\')
      line += "\\e";
    else if (c == '-')
      line += "\\-";
    else if (c == '\'')
      line += "\\(aq";
    else
      line += c;
  }
  return !line.empty() && line[0] == '.' ? "\\&" + line : line;
}

std::string header(const std::string& name, const std::string& version) {
  std::string title = name;
  for (char& c : title) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return ".TH \"" + troffText(title) + "\" 1 \"\" \"pellucid " + version + "\" \"User Commands\"\n.nh\n.ad l\n";
}

std::string row(const std::string& name, const std::string& text) {
  return ".TP\n.B " + troffText(name) + "\n" + troffText(text) + "\n";
}

std::string lowered(std::string text) {
  if (text.size() > 1 && std::islower(static_cast<unsigned char>(text[1])))
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text.substr(0, text.find_last_not_of('.') + 1);
}

std::string exits() {
  std::string text = ".SH EXIT STATUS\n";
  for (const ExitRow& exit : exitRows()) text += row(exit.codes, exit.meaning);
  return text;
}

std::string seeAlso(const CLI::App& app, const std::string& but) {
  std::string text = ".SH SEE ALSO\n";
  std::vector<std::string> names{"pellucid"};
  for (const CLI::App* verb : verbsOf(app)) names.push_back("pellucid-" + verb->get_name());
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] != but) text += ".BR " + troffText(names[i]) + " (1)" + (i + 1 < names.size() ? ",\n" : "\n");
  // The last one that is left has no comma.
  if (text.ends_with(",\n")) text.replace(text.size() - 2, 2, "\n");
  return text;
}

}  // namespace

std::string manOfProgram(const CLI::App& app, const std::string& version) {
  std::string page = header("pellucid", version) + ".SH NAME\npellucid \\- " +
                     troffText(lowered(app.get_description())) +
                     "\n.SH SYNOPSIS\n.B pellucid\n.I VERB FILES...\n[\n.I FLAGS\n]\n.SH DESCRIPTION\n" +
                     "Reads an opaque picture and its depth from EXR and transparent geometry from glTF or deep EXR, "
                     "and writes the picture with the transparency composited onto it.\n" +
                     "What transparency does not touch stays as it came, bit for bit.\n"
                     "Results go to standard output, messages to standard error.\n.SH VERBS\n";
  for (const CLI::App* verb : verbsOf(app)) page += row(verb->get_name(), helpSentence(verb->get_description()));
  page += ".SH OPTIONS\n";
  for (const CLI::Option* option : app.get_options()) page += row(flagText(*option), helpSentences(*option));
  return page + ".SH EXAMPLES\n.EX\n" + troffText(exampleOf("render")) + "\n" + troffText(exampleOf("composite")) +
         "\n.EE\n" + exits() + seeAlso(app, "pellucid");
}

std::string manOfVerb(const CLI::App& verb, const CLI::App& app, const std::string& version) {
  const std::string name = "pellucid-" + verb.get_name();
  std::string page = header(name, version) + ".SH NAME\n" + troffText(name) + " \\- " +
                     troffText(lowered(verb.get_description())) + "\n.SH SYNOPSIS\n.B " + troffText(usageText(verb)) +
                     "\n[\n.I FLAGS\n]\n.SH DESCRIPTION\n" + troffText(helpSentence(verb.get_description())) + "\n";
  for (const CLI::Option* option : verb.get_options())
    if (option->get_positional()) page += row(placeText(*option), helpSentences(*option));
  page += ".SH OPTIONS\n";
  for (const std::string& group : helpGroups()) {
    std::string rows;
    for (const CLI::Option* option : verb.get_options())
      if (option->nonpositional() && option->get_group() == group)
        rows += row(flagText(*option), helpSentences(*option));
    if (!rows.empty()) page += ".SS \"" + group + "\"\n" + rows;
  }
  return page + ".SH EXAMPLES\n.EX\n" + troffText(exampleOf(verb.get_name())) + "\n.EE\n" + exits() +
         seeAlso(app, name);
}

}  // namespace pellucid::cli
