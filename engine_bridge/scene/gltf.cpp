#include "engine_bridge/scene/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>

#include "engine_bridge/scene/animations.h"
#include "engine_bridge/scene/file_loader.h"
#include "engine_bridge/scene/materials.h"
#include "gbuffer/errors.h"

namespace pellucid {

namespace {

using namespace gltf;  // NOLINT: this file is its front door

void checkExtensions(const GltfFile& file, Notes& notes) {
  std::set<std::string> required;
  if (const std::optional<JsonView> list = file.root().find("extensionsRequired")) {
    for (std::size_t i = 0; i < list->size(); ++i) required.insert(list->at(i).string());
  }
  for (const std::string& name : required) {
    if (supportFor(name) == Support::none) {
      throw MeaningError(
          printable(fmt::format("{}: requires the extension {}, which is not supported", file.path(), name)));
    }
  }
  const std::optional<JsonView> used = file.root().find("extensionsUsed");
  for (std::size_t i = 0; used && i < used->size(); ++i) {
    const std::string& name = used->at(i).string();
    if (supportFor(name) == Support::none) notes.add(fmt::format("the extension {} is not drawn", name));
  }
}

void checkOption(double value, const char* flag) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw UsageError(fmt::format("{} {:g}: expected a finite number above 0", flag, value));
  }
}

// What has to grow beyond memory says so by the file's name.
template <class Work>
void withinMemory(const std::string& path, const Work& work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    throw ResourceError(fmt::format("{}: does not fit in memory", path));
  } catch (const std::length_error&) {
    throw ResourceError(fmt::format("{}: does not fit in memory", path));
  }
}

}  // namespace

struct SceneFiles::File {
  File(const std::string& path, const SceneOptions& options, std::shared_ptr<PageLedger> ledger, Scene& scene,
       std::size_t index)
      : file(path, std::move(ledger), options.assetRoot), notes(path, scene.notes) {
    checkExtensions(file, notes);
    if (options.seconds) animations.emplace(file, options.animations, notes);
    noteAnimations(options);
    loader.emplace(file, index, options, scene, notes, options.seconds.has_value());
  }
  void noteAnimations(const SceneOptions& options) {
    if (file.count("animations") == 0) return;
    if (!animations)
      notes.add(fmt::format("animations are not played, and nodes stand where the file puts them{}",
                            options.secondsBy.empty() ? "" : ": " + options.secondsBy));
    else if (animations->any())
      notes.add(playing(options.secondsBy));
  }
  std::string playing(const std::string& secondsBy) const {
    return fmt::format("plays {} at {}", animations->description(), secondsBy);
  }
  void read(const std::optional<double>& seconds) {
    try {
      if (animations && seconds) animations->pose(*seconds);
      loader->load();
    } catch (const InputError&) {
      file.requireWhole();  // what is missing explains what was found
      throw;
    }
    file.requireWhole();
  }

  GltfFile file;
  Notes notes;
  std::optional<Animations> animations;
  std::optional<FileLoader> loader;
};

SceneFiles::SceneFiles(const std::vector<std::string>& paths, const SceneOptions& options, Scene& scene)
    : options_(options), scene_(scene) {
  checkOption(options.metresPerUnit, "--unit");
  checkOption(options.lumensPerWatt, "--lumens-per-watt");
  const auto ledger = options.streamBytes ? std::make_shared<PageLedger>(options.streamBytes) : nullptr;
  for (std::size_t i = 0; i < paths.size(); ++i)
    withinMemory(paths[i], [&] {
      auto file = std::make_unique<File>(paths[i], options_, ledger, scene_, i);
      file->read(options_.seconds);
      file->loader->noteCounts();
      file->notes.finish();
      if (options_.seconds) files_.push_back(std::move(file));
    });
  if (options_.seconds) expectNames();
  applyOverrides(options_.overrides, scene_.materials);
  if (!moves()) files_.clear();
}

SceneFiles::~SceneFiles() = default;

bool SceneFiles::moves() const {
  return std::any_of(files_.begin(), files_.end(),
                     [](const std::unique_ptr<File>& file) { return file->animations && file->animations->any(); });
}

void SceneFiles::expectNames() const {
  std::string known;
  for (const auto& file : files_)
    for (const std::string& name : file->animations->names()) known += (known.empty() ? "" : ", ") + name;
  for (const std::string& name : options_.animations) {
    const bool there = std::any_of(files_.begin(), files_.end(), [&](const std::unique_ptr<File>& file) {
      const std::vector<std::string>& names = file->animations->names();
      return name == "all" || std::find(names.begin(), names.end(), name) != names.end();
    });
    if (!there)
      throw UsageError(printable(fmt::format("--animation: found {}, expected all or one of: {}", name,
                                             known.empty() ? "none, nothing in the glTF is animated" : known)));
  }
}

std::vector<int> SceneFiles::pose(double seconds) {
  scene_.materials.clear();
  scene_.instances.clear();
  scene_.lights.clear();
  scene_.cameras.clear();
  std::vector<int> read;
  for (const auto& file : files_) {
    withinMemory(file->file.path(), [&] { file->read(seconds); });
    read.insert(read.end(), file->loader->readNow().begin(), file->loader->readNow().end());
  }
  applyOverrides(options_.overrides, scene_.materials);
  return read;
}

std::vector<int> SceneFiles::pose(double seconds, const std::string& secondsBy) {
  for (const auto& file : files_) {
    if (!file->animations->any()) continue;
    const std::string before = printable(file->file.path() + ": " + file->playing(options_.secondsBy));
    const auto note = std::find(scene_.notes.begin(), scene_.notes.end(), before);
    if (note != scene_.notes.end()) *note = printable(file->file.path() + ": " + file->playing(secondsBy));
  }
  options_.secondsBy = secondsBy;
  return pose(seconds);
}

Scene loadScene(const std::vector<std::string>& paths, const SceneOptions& options) {
  Scene scene;
  const SceneFiles files(paths, options, scene);
  return scene;
}

}  // namespace pellucid
