// pellucid_pages FOLDER: writes man pages, completion and the table of flags below it, where they are installed from.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "composite/cli/application.h"
#include "composite/cli/help_groups.h"
#include "composite/cli/pages/pages.h"

namespace pellucid::cli {
namespace {

bool write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) std::fprintf(stderr, "pellucid_pages: %s: cannot be written\n", path.c_str());
  return static_cast<bool>(out);
}

bool writeAll(const std::filesystem::path& folder) {
  CLI::App app{kWhatItDoes, "pellucid"};
  addVerbs(app);
  const std::filesystem::path man = folder / "man" / "man1";
  bool done = write(man / "pellucid.1", manOfProgram(app, PELLUCID_VERSION));
  for (const CLI::App* verb : verbsOf(app))
    done = write(man / ("pellucid-" + verb->get_name() + ".1"), manOfVerb(*verb, app, PELLUCID_VERSION)) && done;
  done = write(folder / "pellucid" / "flags.json", flagTable(app, PELLUCID_VERSION)) && done;
  done = write(folder / "bash-completion" / "completions" / "pellucid", bashCompletion(app)) && done;
  return write(folder / "zsh" / "vendor-completions" / "_pellucid", zshCompletion(app)) && done;
}

}  // namespace
}  // namespace pellucid::cli

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "pellucid_pages: found %d arguments, expected a folder\n", argc - 1);
    return 2;
  }
  return pellucid::cli::writeAll(argv[1]) ? 0 : 6;
}
