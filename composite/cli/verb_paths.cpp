#include "composite/cli/verb_paths.h"

#include "composite/pipeline/fog_text.h"
#include "gbuffer/side_files.h"

namespace pellucid::cli {
namespace {

// A verb without a row of its own writes what the row without a verb says.
struct OutputFlag {
  const char* flag;
  const char* verb;  // "" for every other
  OutputKind kind;
};
constexpr OutputFlag kOutputs[] = {
    {"--output", "study", OutputKind::folder}, {"--output", "", OutputKind::exr},
    {"--shadow-views", "", OutputKind::exr},   {"--html", "", OutputKind::page},
    {"--preview", "", OutputKind::image},      {"--explain-page", "", OutputKind::page},
};

struct InputFlag {
  const char* flag;
  bool kept;  // false: its header is read before anything is written, so that the output may have its name
};
constexpr InputFlag kInputs[] = {
    {"--depth", true},        {"--aov", true},          {"--ocio", true},        {"--environment", true},
    {"--fog", true},          {"--fog-grid", true},     {"--layer-depth", true}, {"--weight-from", false},
    {"--method-from", false}, {"--held-out-by", false}, {"--scene", true},
};

std::optional<OutputKind> writtenBy(const std::string& verb, const std::string& flag) {
  std::optional<OutputKind> kind;
  for (const OutputFlag& row : kOutputs)
    if (flag == row.flag && (verb == row.verb || (!*row.verb && !kind))) kind = row.kind;
  return kind;
}

}  // namespace

std::vector<VerbPath> pathsOf(const CLI::App& verb) {
  std::vector<VerbPath> paths;
  for (const CLI::Option* found : verb.get_options()) {
    auto* option = const_cast<CLI::Option*>(found);  // of the program's own verb, which hands them out as they are
    const std::string flag = option->get_name();
    if (option->get_positional()) {
      paths.push_back({option, flag, std::nullopt, true});
      continue;
    }
    if (const auto kind = writtenBy(verb.get_name(), flag)) paths.push_back({option, flag, kind, true});
    for (const InputFlag& row : kInputs)
      if (flag == row.flag) paths.push_back({option, flag, std::nullopt, row.kept});
  }
  return paths;
}

std::string fileNamedIn(const std::string& flag, const std::string& value) {
  const auto after = [&](char sign) {
    const auto at = value.find(sign);
    return at == std::string::npos ? value : value.substr(at + 1);
  };
  if (flag == "--aov") return after('=');
  if (flag == "--fog-grid") return readFogGrid(value).path;
  const bool side = flag == "--depth" || flag == "--layer-depth";
  const std::optional<SideFile> file = side ? sideFileOf(value) : std::nullopt;
  return file ? file->path : value;
}

}  // namespace pellucid::cli
