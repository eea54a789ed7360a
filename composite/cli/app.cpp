#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <system_error>

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

// A value without a letter is a variable that a script has not set. A layer may have no name; of outputs more is said.
void expectValues(CLI::App& app) {
  const auto notEmpty = [](std::string& value) {
    return std::string(value.empty() ? "found '', expected a value" : "");
  };
  for (CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; }))
    for (CLI::Option* option : verb->get_options())
      if (option->get_items_expected_min() > 0 && option->get_name() != "--layer" && option->get_name() != "--output")
        option->check(CLI::Validator(notEmpty, ""));
}

// Whoever closes a stream wants nothing from it; without this the next file that is opened would be that stream.
void openStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) == -1 && ::open("/dev/null", O_RDWR) != stream) return;
}

// What was printed has arrived, or the exit code says that it has not.
int printed(int code) {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  const int why = errno;
  if (flushed && std::ferror(stdout) == 0) return code;
  sayError(std::string("standard output: cannot be written") +
           (why == 0 ? "" : std::string(": ") + std::strerror(why)));
  return code == 0 ? 6 : code;
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
  openStreams();
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
    return printed(0);
  } catch (const CLI::Success& request) {  // --help, --version
    return printed(app.exit(request));
  } catch (const CLI::ParseError& error) {
    sayError(std::string(error.what()) + " (see pellucid --help)");
    return 2;
  } catch (const Error& error) {
    sayError(error.what());
    return printed(error.exitCode());
  } catch (const std::system_error& error) {
    sayError((std::ferror(stdout) != 0 ? "standard output: " : "") + std::string(error.what()));
    return 6;
  } catch (const std::bad_alloc&) {
    sayError("memory ran out");
    return 6;
  }
}

}  // namespace pellucid::cli
