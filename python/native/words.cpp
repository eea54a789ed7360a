#include "python/native/words.h"

#include <pybind11/stl.h>

#include <algorithm>

#include "composite/cli/flag_table.h"
#include "composite/cli/suggest.h"
#include "composite/cli/verb_outputs.h"
#include "gbuffer/errors.h"

namespace py = pybind11;

namespace pellucid::python {
namespace {

// Flags of a terminal: results are objects here, plans have a function of their
// own, outputs are an argument.
constexpr const char* kOfTerminals[] = {"help", "json", "stats", "explain", "output"};

std::string keywordOf(std::string flag) {
  std::replace(flag.begin(), flag.end(), '-', '_');
  return flag;
}

template <class Flags>
py::list rowsOf(const std::string& name) {
  CLI::App verb("", name);
  Flags flags;
  flags.addTo(verb);
  py::list rows;
  for (const cli::FlagRow& row : cli::flagRows(verb)) {
    const std::string& first = row.names.front();
    if (std::find(std::begin(kOfTerminals), std::end(kOfTerminals), first) != std::end(kOfTerminals)) continue;
    py::dict entry;
    entry["name"] = keywordOf(first);
    entry["flag"] = row.flag;
    entry["names"] = row.names;
    entry["group"] = row.group;
    entry["help"] = row.help;
    entry["value"] = row.value;
    entry["type"] = row.type;
    entry["default"] = row.standard;
    entry["switch"] = row.isSwitch;
    entry["many"] = row.many;
    rows.append(entry);
  }
  return rows;
}

}  // namespace

void loosen(CLI::App& verb) {
  verb.set_help_flag();
  if (CLI::Option* output = verb.get_option_no_throw("--output")) output->required(false);
}

void parseWords(CLI::App& verb, const Words& words) {
  try {
    verb.parse(Words(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    throw UsageError(verb.get_name() + ": " + error.what());
  }
  cli::checkVerbOutputs(verb);
}

py::list optionsOf(const std::string& verb) {
  if (verb == "composite") return rowsOf<OneViewFlags>(verb);
  if (verb == "accumulate") return rowsOf<cli::AccumulateFlags>(verb);
  if (verb == "resolve") return rowsOf<cli::ResolveFlags>(verb);
  if (verb == "flatten") return rowsOf<cli::FlattenFlags>(verb);
  if (verb == "compare") return rowsOf<cli::CompareFlags>(verb);
  if (verb == "study") return rowsOf<cli::StudyFlags>(verb);
  throw UsageError("options: found '" + verb + "', expected composite, accumulate, resolve, flatten, compare or study");
}

std::string nearest(const std::string& text, const std::vector<std::string>& names) {
  return cli::nearestName(text, names);
}

}  // namespace pellucid::python
