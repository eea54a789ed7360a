#include "engine_bridge/scene/asset_files.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>

#include "engine_bridge/scene/json_view.h"
#include "engine_bridge/scene/uri.h"
#include "gbuffer/errors.h"

namespace pellucid::gltf {

namespace {

namespace fs = std::filesystem;

bool lies(const fs::path& path, const fs::path& under) {
  return std::mismatch(under.begin(), under.end(), path.begin(), path.end()).first == under.end();
}

// Backslashes and their escapes as slashes.
std::string withSlashes(const std::string& name) {
  std::string result;
  for (std::size_t at = 0; at < name.size(); ++at) {
    const bool escaped = name.compare(at, 3, "%5C") == 0 || name.compare(at, 3, "%5c") == 0;
    result.push_back(escaped || name[at] == '\\' ? '/' : name[at]);
    if (escaped) at += 2;
  }
  return result;
}

// In the order in which they are tried, each once.
std::vector<std::string> spellings(const std::string& uri) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const std::string& name : {decodePercent(uri), uri}) {
    add(name);
    add(withSlashes(name));
  }
  return names;
}

// Follows no link on the way: `below` had none when it was made, and one that has come since is an attack.
//   below  relative to root
// -1 with errno set when something on the way is missing.
int openBelow(const fs::path& root, const fs::path& below) {
  int at = ::open(root.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  for (auto part = below.begin(); at >= 0 && part != below.end(); ++part) {
    const bool last = std::next(part) == below.end();
    // Not blocking: opening a pipe would wait for its other end.
    const int flags = last ? O_RDONLY | O_NONBLOCK : O_PATH | O_DIRECTORY;
    const int next = ::openat(at, part->c_str(), flags | O_NOFOLLOW | O_CLOEXEC);
    const int problem = errno;
    ::close(at);
    errno = problem;
    at = next;
  }
  return at;
}

}  // namespace

AssetFiles::AssetFiles(const std::string& scenePath, const std::string& assetRoot)
    : folder_(fs::path(scenePath).parent_path()) {
  std::error_code problem;
  roots_.push_back(fs::canonical(folder_.empty() ? fs::path(".") : folder_, problem));
  if (problem) roots_.clear();
  if (assetRoot.empty()) return;
  roots_.push_back(fs::canonical(assetRoot, problem));
  if (problem || !fs::is_directory(roots_.back()))
    throw InputError(printable(fmt::format("--asset-root {}: found no such folder, expected one", assetRoot)));
}

const fs::path* AssetFiles::allowing(const fs::path& real) const {
  const auto root = std::find_if(roots_.begin(), roots_.end(), [&](const fs::path& one) { return lies(real, one); });
  return root == roots_.end() ? nullptr : &*root;
}

void AssetFiles::refuseOutside(const std::string& name, const fs::path& real, const std::string& whose) const {
  throw InputError(printable(
      fmt::format("{}: {} leads to {}, expected a file under {}, or --asset-root FOLDER that allows another folder",
                  whose, name, real.string(), roots_.empty() ? "the scene's folder" : roots_.front().string())));
}

OpenFile AssetFiles::open(const std::string& uri, const std::string& whose) const {
  const std::vector<std::string> names = spellings(uri);
  for (const std::string& name : names) {
    std::error_code problem;
    const fs::path real = fs::weakly_canonical(folder_ / name, problem);
    if (problem) continue;
    const fs::path absolute = fs::absolute(real);  // a folder that is not there leaves a relative path relative
    const fs::path* root = allowing(absolute);
    if (!root) refuseOutside(name, absolute, whose);
    const int descriptor = openBelow(*root, absolute.lexically_relative(*root));
    if (descriptor >= 0) return OpenFile(descriptor, (folder_ / name).string());
    if (errno != ENOENT && errno != ENOTDIR && errno != ENAMETOOLONG)
      throw InputError(printable(fmt::format("{}: {} cannot be opened for reading", whose, (folder_ / name).string())));
  }
  throw InputError(printable(fmt::format("{}: {} does not exist", whose, (folder_ / names.front()).string())));
}

}  // namespace pellucid::gltf
