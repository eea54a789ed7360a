#include "composite/cli/help_groups.h"
#include "composite/cli/help_text.h"
#include "composite/cli/pages/pages.h"

namespace pellucid::cli {

std::vector<const CLI::App*> verbsOf(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

ValueWords valueWords(const CLI::Option& option, const std::string& verb) {
  ValueWords words;
  words.none = option.nonpositional() && option.get_items_expected_max() == 0;
  words.choices = choicesOf(option);
  if (words.none || !words.choices.empty()) return words;
  const HelpRow* row = option.get_lnames().empty() ? nullptr : helpRow("--" + option.get_lnames()[0]);
  const std::string value = row ? row->value : "FILE";  // what has no name is a file
  words.folder = value == "FOLDER" || (verb == "study" && option.check_name("--output"));
  words.file = !words.folder && value.find("FILE") != std::string::npos;
  for (const char* ending : {"exr", "png", "html", "vdb", "ocio"})
    if (value.find(std::string(".") + ending) != std::string::npos) {
      words.file = true;
      words.ending = ending;
    }
  return words;
}

}  // namespace pellucid::cli
