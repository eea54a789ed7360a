#include <new>

#include "composite/cli/application.h"
#include "composite/cli/help_groups.h"
#include "composite/cli/messages.h"
#include "composite/cli/suggest.h"
#include "composite/cli/verb_outputs.h"
#include "composite/cli/verbs.h"
#include "gbuffer/atomic_file.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

// A value without a letter is a variable that a script has not set. Only a layer may have no name.
void expectValues(CLI::App& app) {
  const auto notEmpty = [](std::string& value) {
    return std::string(value.empty() ? "found '', expected a value" : "");
  };
  for (CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; }))
    for (CLI::Option* option : verb->get_options())
      if (option->get_items_expected_min() > 0 && option->get_name() != "--layer")
        option->check(CLI::Validator(notEmpty, ""));
}

}  // namespace

void addVerbs(CLI::App& app) {
  app.set_version_flag("--version", PELLUCID_VERSION);
  app.require_subcommand(1);
  addComposite(app);
  addAccumulate(app);
  addResolve(app);
  addOcclusion(app);
  addInspect(app);
  addGbuffer(app);
  addRender(app);
  addCompare(app);
  addFlatten(app);
  addFragments(app);
  addStudy(app);
  addView(app);
  addHelp(app);
  expectValues(app);
  checkOutputsFirst(app);
  setUpHelp(app);
}

int run(int argc, const char* const* argv) {
  setUpMessages();
  // Before anything is parsed, so that what cannot be is told in this form too.
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]) == "--log-json") sayAsJson();
  cleanUpOnSignals();
  CLI::App app{kWhatItDoes, "pellucid"};
  addVerbs(app);
  try {
    checkWords(app, argc, argv);
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    sayError(std::string(error.what()) + " (see pellucid --help)");
    return 2;
  } catch (const Error& error) {
    sayError(error.what());
    return error.exitCode();
  } catch (const std::bad_alloc&) {
    sayError("memory ran out");
    return 6;
  }
}

}  // namespace pellucid::cli
