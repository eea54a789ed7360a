#include "composite/cli/verb_outputs.h"

#include <string>
#include <vector>

#include "composite/cli/frame_choice.h"
#include "composite/cli/verb_paths.h"

namespace pellucid::cli {

void checkVerbOutputs(const CLI::App& verb) {
  std::vector<Output> outputs;
  std::vector<std::string> inputs;
  for (const VerbPath& path : pathsOf(verb)) {
    const std::vector<std::string>& values = path.option->results();
    if (values.empty()) continue;
    // A flag that may be given once takes the last of its values.
    if (path.written)
      outputs.push_back({path.flag, values.back(), *path.written});
    else if (path.kept)
      for (const std::string& value : values) inputs.push_back(fileNamedIn(path.flag, value));
  }
  checkOutputs(outputs, inputs);
}

void checkOutputsFirst(CLI::App& app) {
  for (CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; }))
    verb->parse_complete_callback([verb] {
      if (!isSequence(*verb)) checkVerbOutputs(*verb);
    });
}

}  // namespace pellucid::cli
