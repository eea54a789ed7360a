#include "composite/cli/flag_table.h"

#include "composite/cli/help_groups.h"
#include "composite/cli/help_text.h"

namespace pellucid::cli {

std::vector<FlagRow> flagRows(const CLI::App& verb) {
  std::vector<FlagRow> rows;
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_positional() || option->get_lnames().empty()) continue;
    FlagRow row;
    row.names = option->get_lnames();
    row.flag = "--" + row.names.front();
    if (const HelpRow* place = helpRow(row.flag)) {
      row.group = place->group;
      row.value = place->value;
    }
    row.help = helpSentences(*option);
    row.type = option->get_type_name();
    row.standard = option->get_default_str();
    row.choices = choicesOf(*option);
    row.isSwitch = option->get_items_expected_max() == 0;
    row.many = option->get_items_expected_max() >= CLI::detail::expected_max_vector_size;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace pellucid::cli
