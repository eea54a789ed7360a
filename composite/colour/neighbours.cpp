#include "composite/colour/neighbours.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

namespace fs = std::filesystem;

bool liesUnder(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

class Neighbours {
 public:
  Neighbours(const ocio::Config& config, const std::string& path, const std::string& assetRoot)
      : config_(config), path_(path) {
    const fs::path folder = fs::path(path).parent_path();
    std::error_code problem;
    roots_.push_back(fs::canonical(folder.empty() ? fs::path(".") : folder, problem));
    if (problem) roots_.clear();
    if (assetRoot.empty()) return;
    roots_.push_back(fs::canonical(assetRoot, problem));
    if (problem || !fs::is_directory(roots_.back()))
      throw InputError(fmt::format("--asset-root {}: found no such folder, expected one", assetRoot));
  }

  void expect(const ocio::ConstTransformRcPtr& transform) const {
    if (!transform) return;
    if (const auto group = OCIO_DYNAMIC_POINTER_CAST<const ocio::GroupTransform>(transform))
      for (int i = 0; i < group->getNumTransforms(); ++i) expect(group->getTransform(i));
    if (const auto file = OCIO_DYNAMIC_POINTER_CAST<const ocio::FileTransform>(transform)) expectFile(file->getSrc());
  }

 private:
  void expectFile(const char* name) const {
    std::string found;
    try {
      found = config_.getCurrentContext()->resolveFileLocation(name);
    } catch (const ocio::Exception&) {
      return;  // no such file: what uses it says so
    }
    std::error_code problem;
    const fs::path real = fs::canonical(found, problem);
    if (problem) return;
    if (std::any_of(roots_.begin(), roots_.end(), [&](const fs::path& root) { return liesUnder(real, root); })) return;
    throw InputError(
        fmt::format("{}: {} leads to {}, expected a file under {}, or --asset-root FOLDER that allows another folder",
                    path_, name, real.string(), roots_.empty() ? "the config's folder" : roots_.front().string()));
  }

  const ocio::Config& config_;
  const std::string& path_;
  std::vector<fs::path> roots_;
};

}  // namespace

void expectNeighbours(const ocio::Config& config, const std::string& path, const std::string& assetRoot) {
  const Neighbours neighbours(config, path, assetRoot);
  for (int i = 0; i < config.getNumColorSpaces(ocio::SEARCH_REFERENCE_SPACE_ALL, ocio::COLORSPACE_ALL); ++i) {
    const char* name = config.getColorSpaceNameByIndex(ocio::SEARCH_REFERENCE_SPACE_ALL, ocio::COLORSPACE_ALL, i);
    const ocio::ConstColorSpaceRcPtr space = config.getColorSpace(name);
    if (!space) continue;
    neighbours.expect(space->getTransform(ocio::COLORSPACE_DIR_TO_REFERENCE));
    neighbours.expect(space->getTransform(ocio::COLORSPACE_DIR_FROM_REFERENCE));
  }
  for (int i = 0; i < config.getNumViewTransforms(); ++i) {
    const ocio::ConstViewTransformRcPtr view = config.getViewTransform(config.getViewTransformNameByIndex(i));
    neighbours.expect(view->getTransform(ocio::VIEWTRANSFORM_DIR_TO_REFERENCE));
    neighbours.expect(view->getTransform(ocio::VIEWTRANSFORM_DIR_FROM_REFERENCE));
  }
  for (int i = 0; i < config.getNumLooks(); ++i) {
    const ocio::ConstLookRcPtr look = config.getLook(config.getLookNameByIndex(i));
    neighbours.expect(look->getTransform());
    neighbours.expect(look->getInverseTransform());
  }
  for (int i = 0; i < config.getNumNamedTransforms(ocio::NAMEDTRANSFORM_ALL); ++i) {
    const ocio::ConstNamedTransformRcPtr named =
        config.getNamedTransform(config.getNamedTransformNameByIndex(ocio::NAMEDTRANSFORM_ALL, i));
    neighbours.expect(named->getTransform(ocio::TRANSFORM_DIR_FORWARD));
    neighbours.expect(named->getTransform(ocio::TRANSFORM_DIR_INVERSE));
  }
}

}  // namespace pellucid
