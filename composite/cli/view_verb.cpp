// `view`: what a verb wrote, in the desktop's viewer.
#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "composite/cli/file_page.h"
#include "composite/cli/messages.h"
#include "composite/cli/read_flags.h"
#include "composite/cli/verbs.h"
#include "composite/cli/viewer.h"
#include "composite/pipeline/shot.h"
#include "gbuffer/errors.h"
#include "gbuffer/inspect.h"

namespace pellucid::cli {
namespace {

namespace fs = std::filesystem;

struct ViewFlags {
  std::string file;
  bool print = false;
  ReadFlags read;
};

// A folder of this call alone, so that nobody else's file is written over or followed.
fs::path temporaryFolder() {
  std::string folder = (fs::temp_directory_path() / "pellucid-view-XXXXXX").string();
  if (!mkdtemp(folder.data())) throw ResourceError(fmt::format("{}: cannot be made: {}", folder, std::strerror(errno)));
  return folder;
}

// By its name, or by how OpenEXR begins its files.
bool isExr(const std::string& path) {
  char start[4] = {};
  std::ifstream(path, std::ios::binary).read(start, sizeof start);
  return isExrName(path) || std::string_view(start, sizeof start) == "\x76\x2f\x31\x01";
}

// What a viewer can show of it: a page in place of an EXR, the page of a study in place of its folder.
fs::path shownFile(const ViewFlags& flags) {
  std::error_code failure;
  const fs::file_status status = fs::status(flags.file, failure);
  if (!fs::exists(status)) throw InputError(flags.file + ": not found, expected a file that a verb wrote");
  if (fs::is_directory(status)) {
    const fs::path page = fs::path(flags.file) / "study.html";
    if (!fs::exists(page))
      throw InputError(flags.file + ": found a folder without study.html, expected a file or the folder of a study");
    return fs::absolute(page);
  }
  if (!isExr(flags.file)) return fs::absolute(flags.file);
  const nlohmann::json report = inspectExr(flags.file, flags.read.options());
  const fs::path page = temporaryFolder() / fs::path(flags.file).filename().replace_extension(".html");
  try {
    writeFilePage(page.string(), flags.file, report, flags.read.options());
  } catch (const Error&) {
    fs::remove_all(page.parent_path(), failure);
    throw;
  }
  return page;
}

void view(const ViewFlags& flags) {
  const std::string shown = shownFile(flags).string();
  fmt::print("{}\n", shown);
  if (flags.print) return;
  if (!hasDisplay()) {
    note("{}: not opened: DISPLAY and WAYLAND_DISPLAY name no display; open it where there is one", shown);
    return;
  }
  openInViewer(shown);
}

}  // namespace

void addView(CLI::App& app) {
  auto flags = std::make_shared<ViewFlags>();
  CLI::App* verb =
      app.add_subcommand("view", "Open what a verb wrote: an EXR as a page of its layers, anything else as it is");
  verb->add_option("file", flags->file, "EXR, PNG, page, or the folder of a study")->required();
  verb->add_flag("--print", flags->print, "Print the path of what would be opened, and open nothing");
  flags->read.addTo(*verb);
  verb->callback([flags] { view(*flags); });
}

}  // namespace pellucid::cli
