#include "composite/cli/verb_outputs.h"

#include <string>
#include <vector>

#include "gbuffer/output_checks.h"
#include "gbuffer/side_files.h"

namespace pellucid::cli {
namespace {

// The flags that name an output. A verb without a row of its own writes what the row without a verb says.
struct OutputFlag {
  const char* flag;
  const char* verb;  // "" for every other
  OutputKind kind;
};
constexpr OutputFlag kOutputs[] = {
    {"--output", "study", OutputKind::folder}, {"--output", "", OutputKind::exr},
    {"--shadow-views", "", OutputKind::exr},   {"--html", "", OutputKind::page},
    {"--preview", "", OutputKind::image},
};

OutputKind kindOf(const OutputFlag& flag, const std::string& verb) {
  for (const OutputFlag& each : kOutputs)
    if (std::string(each.flag) == flag.flag && each.verb == verb) return each.kind;
  return flag.kind;
}

// The file that a flag's value names; a channel or a number names none that exists.
std::string fileOf(const std::string& flag, const std::string& text) {
  const auto equals = text.find('=');
  if (flag == "--aov") return equals == std::string::npos ? text : text.substr(equals + 1);
  const auto side = flag == "--depth" ? sideFileOf(text) : std::nullopt;
  return side ? side->path : text;
}

}  // namespace

void checkVerbOutputs(const CLI::App& verb) {
  std::vector<Output> outputs;
  for (const OutputFlag& row : kOutputs) {
    const CLI::Option* option = *row.verb ? nullptr : verb.get_option_no_throw(row.flag);
    if (!option) continue;
    // A flag that may be given once takes the last of its values.
    if (option->count() > 0) outputs.push_back({row.flag, option->results().back(), kindOf(row, verb.get_name())});
  }
  std::vector<std::string> inputs;
  for (const CLI::Option* option : verb.get_options())
    if (option->get_positional()) inputs.insert(inputs.end(), option->results().begin(), option->results().end());
  for (const char* flag : {"--depth", "--aov", "--ocio", "--environment"}) {
    const CLI::Option* option = verb.get_option_no_throw(flag);
    for (const std::string& text : option ? option->results() : std::vector<std::string>())
      inputs.push_back(fileOf(flag, text));
  }
  checkOutputs(outputs, inputs);
}

void checkOutputsFirst(CLI::App& app) {
  for (CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; }))
    verb->parse_complete_callback([verb] { checkVerbOutputs(*verb); });
}

}  // namespace pellucid::cli
