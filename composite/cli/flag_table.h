// A verb's flags as data, for skins that make something else of them than --help: keywords of Python, widgets of an
// add-on.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace pellucid::cli {

struct FlagRow {
  std::string flag;                  // the first long name, "--self-modulation"
  std::vector<std::string> names;    // all long names, without dashes
  std::string group;                 // heading of --help
  std::string help;                  // whole sentences, as --help prints them
  std::string value;                 // the word for the value, "FILE.png"; "" where it takes none, or one of a few
  std::string type;                  // as CLI11 names it, "INT:INT in [1 - 4096]"
  std::string standard;              // the default, "" for none
  std::vector<std::string> choices;  // the only values it takes; empty: others
  bool isSwitch = false, many = false;
};

// In the order in which the verb registers them, without its positions.
std::vector<FlagRow> flagRows(const CLI::App& verb);

}  // namespace pellucid::cli
