#include "python/native/words.h"

#include <pybind11/stl.h>

#include <algorithm>

#include "composite/cli/help_groups.h"
#include "composite/cli/help_text.h"
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
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_positional() || option->get_lnames().empty()) continue;
    const std::string first = option->get_lnames()[0];
    if (std::find(std::begin(kOfTerminals), std::end(kOfTerminals), first) != std::end(kOfTerminals)) continue;
    const cli::HelpRow* row = cli::helpRow("--" + first);
    py::dict entry;
    entry["name"] = keywordOf(first);
    entry["flag"] = "--" + first;
    entry["names"] = option->get_lnames();
    entry["group"] = row ? row->group : "";
    entry["help"] = cli::helpSentences(*option);
    entry["value"] = row ? row->value : "";
    entry["type"] = option->get_type_name();
    entry["default"] = option->get_default_str();
    entry["switch"] = option->get_items_expected_max() == 0;
    entry["many"] = option->get_items_expected_max() >= CLI::detail::expected_max_vector_size;
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
