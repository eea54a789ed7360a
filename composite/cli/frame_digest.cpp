#include "composite/cli/frame_digest.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "composite/pipeline/input_files.h"
#include "gbuffer/errors.h"
#include "gbuffer/exr_document.h"

namespace pellucid::cli {
namespace {

// Flags that change no bit of what is written.
constexpr const char* kIdle[] = {"--frames", "--jobs", "--skip-existing", "--progress", "--log-json", "--threads",
                                 "--stats",  "--json", "--budget",        "--explain",  "--help"};

bool isIdle(const std::string& flag) {
  return std::any_of(std::begin(kIdle), std::end(kIdle), [&](const char* idle) { return flag == idle; });
}

bool isFile(const std::string& path) {
  std::error_code unused;
  return std::filesystem::is_regular_file(path, unused);
}

std::string textOf(const CLI::App& verb, const std::string& flag) {
  const CLI::Option* option = verb.get_option_no_throw(flag);
  return option && option->count() > 0 ? option->results().back() : "";
}

// The value without the file in it, then the bytes of the file and of those that it names.
void addValue(Digest& digest, FileDigests& files, const std::string& value, const std::string& file,
              const std::string& assetRoot) {
  if (!isFile(file)) {
    digest.add(value);
    return;
  }
  std::string rest = value;
  digest.add(rest.replace(rest.find(file), file.size(), ""));
  for (const std::string& path : filesReadWith(file, assetRoot)) digest.add(files.of(path));
}

}  // namespace

std::string frameDigest(const CLI::App& verb, const std::vector<VerbPath>& paths, const std::string& weight,
                        FileDigests& files) {
  Digest digest;
  digest.add(PELLUCID_VERSION);
  digest.add(verb.get_name());
  digest.add(weight);
  const std::string assetRoot = textOf(verb, "--asset-root");
  for (const CLI::Option* option : verb.get_options()) {
    const auto path =
        std::find_if(paths.begin(), paths.end(), [&](const VerbPath& each) { return each.option == option; });
    const bool written = path != paths.end() && path->written;
    if (option->count() == 0 || written || isIdle(option->get_name())) continue;
    digest.add(option->get_name());
    for (const std::string& value : option->results())
      if (path == paths.end())
        digest.add(value);
      else
        addValue(digest, files, value, fileNamedIn(path->flag, value), assetRoot);
  }
  const char* config = std::getenv("OCIO");
  if (config && verb.get_option_no_throw("--ocio") && textOf(verb, "--ocio").empty() && isFile(config))
    digest.add(files.of(config));
  return digest.text();
}

bool isFinished(const std::vector<VerbPath>& paths, const std::string& digest) {
  bool known = false;
  for (const VerbPath& path : paths) {
    if (!path.written || path.option->count() == 0) continue;
    const std::string& file = path.option->results().back();
    if (!isFile(file)) return false;
    if (path.flag != "--output") continue;
    try {
      known = exrText(file, kDigestAttribute) == digest;
    } catch (const InputError&) {
      return false;  // what is there is no whole picture
    }
  }
  return known;
}

}  // namespace pellucid::cli
