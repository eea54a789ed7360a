#include "composite/cli/help_groups.h"

#include <memory>

#include "composite/cli/help_text.h"

namespace pellucid::cli {

const std::vector<std::string>& helpGroups() {
  using namespace headings;
  static const std::vector<std::string> groups{kCommon, kInput, kPicture, kMethod, kScattering, kLight,
                                               kAir,    kTime,  kQuality, kOutput, kThresholds, kRunning};
  return groups;
}

const HelpRow* helpRow(const std::string& flag) {
  for (const HelpRow& row : helpRows())
    if (flag == row.flag) return &row;
  return nullptr;
}

void setUpHelp(CLI::App& app) {
  const auto text = std::make_shared<HelpText>();
  app.formatter(text);
  for (CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; })) {
    verb->formatter(text);
    for (CLI::Option* option : verb->get_options())
      for (const std::string& name : option->get_lnames())
        if (const HelpRow* row = helpRow("--" + name)) option->group(row->group);
  }
}

}  // namespace pellucid::cli
