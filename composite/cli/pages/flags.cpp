#include <nlohmann/json.hpp>

#include "composite/cli/flag_table.h"
#include "composite/cli/help_text.h"
#include "composite/cli/pages/pages.h"
#include "composite/methods/method.h"

namespace pellucid::cli {
namespace {

nlohmann::json jsonOf(const FlagRow& row) {
  return {{"flag", row.flag},       {"names", row.names}, {"group", row.group},      {"help", row.help},
          {"value", row.value},     {"type", row.type},   {"default", row.standard}, {"choices", row.choices},
          {"switch", row.isSwitch}, {"many", row.many}};
}

}  // namespace

const std::vector<ExitRow>& exitRows() {
  static const std::vector<ExitRow> rows{
      {"0", "Done."},
      {"1", "The files differ, or the error is over the tolerance."},
      {"2", "A verb or a flag is unknown, malformed or cannot be honoured."},
      {"3", "An input is missing, unreadable or damaged."},
      {"4", "An input contradicts itself or lacks what is needed, such as a depth or a camera."},
      {"5", "Some frames of a sequence failed."},
      {"6", "Disk, memory or the GL device ran out."},
      {"130, 143", "Interrupted; the old output stays whole."},
  };
  return rows;
}

std::string flagTable(const CLI::App& app, const std::string& version) {
  nlohmann::json table{{"version", version}, {"exits", nlohmann::json::object()}};
  for (const ExitRow& row : exitRows()) table["exits"][row.codes] = row.meaning;
  for (const Method& method : allMethods())
    table["methods"].push_back({{"name", method.name}, {"help", helpSentence(method.help)}});
  for (const CLI::App* verb : verbsOf(app)) {
    nlohmann::json& flags = table["verbs"][verb->get_name()] = nlohmann::json::array();
    for (const FlagRow& row : flagRows(*verb)) flags.push_back(jsonOf(row));
  }
  return table.dump(1) + "\n";
}

}  // namespace pellucid::cli
