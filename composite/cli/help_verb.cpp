// pellucid help TOPIC: what is too long for the help of one flag, from the tables that the flags themselves read.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <sstream>

#include "composite/cli/application.h"
#include "composite/cli/help_text.h"
#include "composite/cli/suggest.h"
#include "composite/methods/method.h"
#include "engine_bridge/scene/set_keys.h"
#include "gbuffer/colour_space.h"
#include "gbuffer/errors.h"
#include "gbuffer/producers.h"
#include "gbuffer/tiers.h"
#include "gbuffer/weight_text.h"

namespace pellucid::cli {
namespace {

std::string tiersHelp() {
  std::string text;
  for (const PrecisionTier& row : kTiers) text += fmt::format("{}: {}\n", row.name, row.promise);
  return text;
}

struct Topic {
  const char *name, *heading;
  std::string (*rows)();  // a line each
};
const Topic kTopics[] = {
    {"methods", "What --method and study --methods take", methodsHelp},
    {"weights", "What --weight takes", weightsHelp},
    {"precision", "What --precision takes", tiersHelp},
    {"set", "What --set MATERIAL.key=value and glTF's extras.pellucid may say of a material", gltf::setKeysHelp},
    {"spaces", "What --working-space takes without a config of OpenColorIO", spacesHelp},
    {"presets", "What --preset takes: the program that wrote the EXR; auto recognises it", producersHelp},
};

// Rows are "name: text", or "name   text" where names are padded.
std::string helpTextOf(const Topic& topic) {
  std::string text = std::string(topic.heading) + "\n\n";
  std::istringstream rows(topic.rows());
  for (std::string row; std::getline(rows, row);) {
    const std::size_t end = std::min({row.find("  "), row.find(": "), row.size()});
    const std::size_t rest = std::min(row.find_first_not_of(": ", end), row.size());
    text += helpRowText(row.substr(0, end), row.substr(rest));
  }
  return text;
}

void help(const CLI::App& app, const std::string& subject) {
  if (subject.empty()) {
    // CLI::App::help would be that of the verb which was chosen, this one.
    fmt::print("{}", app.get_formatter()->make_help(&app, "", CLI::AppFormatMode::Normal));
    return;
  }
  std::vector<std::string> names;
  for (const Topic& topic : kTopics) {
    if (subject == topic.name) {
      fmt::print("{}", helpTextOf(topic));
      return;
    }
    names.emplace_back(topic.name);
  }
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (subject == verb->get_name()) {
      fmt::print("{}", verb->help());
      return;
    }
    names.push_back(verb->get_name());
  }
  const std::string near = nearestName(subject, names);
  throw UsageError(fmt::format("help: found '{}', {}", subject,
                               near.empty() ? fmt::format("expected a verb or one of {}", helpTopics())
                                            : fmt::format("which does not exist: did you mean {}?", near)));
}

}  // namespace

std::string helpTopics() {
  std::string names;
  for (const Topic& topic : kTopics) names += (names.empty() ? "" : ", ") + std::string(topic.name);
  return names;
}

void addHelp(CLI::App& app) {
  auto subject = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("help", "The flags of a verb, or a list: " + helpTopics());
  verb->add_option("subject", *subject, "A verb, or one of " + helpTopics());
  verb->callback([&app, subject] { help(app, *subject); });
}

}  // namespace pellucid::cli
