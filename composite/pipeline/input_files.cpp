#include "composite/pipeline/input_files.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine_bridge/scene/uri.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kGlbHeader = 12, kChunkHeader = 8;

bool endsAs(const std::string& path, const std::string& end) {
  if (path.size() < end.size()) return false;
  return std::equal(end.begin(), end.end(), path.end() - static_cast<std::ptrdiff_t>(end.size()),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

// The JSON of a .gltf, or that of a .glb's first chunk.
std::string jsonTextOf(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path + ": cannot be opened");
  if (!endsAs(path, ".glb")) return {std::istreambuf_iterator<char>(in), {}};
  unsigned char head[kGlbHeader + kChunkHeader] = {};
  in.read(reinterpret_cast<char*>(head), sizeof(head));
  std::uintmax_t length = 0;
  for (int i = 3; i >= 0; --i) length = length << 8 | head[kGlbHeader + static_cast<std::size_t>(i)];
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (!in || error || length > size) return "";
  std::string text(length, '\0');
  in.read(text.data(), static_cast<std::streamsize>(length));
  return text;
}

// Where a scene's file of this name would be opened; "" where none is.
std::string foundAs(const std::string& uri, const std::vector<fs::path>& folders) {
  std::string slashed = uri;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  std::error_code unused;
  for (const fs::path& folder : folders)
    for (const std::string& name : {gltf::decodePercent(uri), uri, slashed})
      if (fs::is_regular_file(folder / name, unused)) return (folder / name).string();
  return "";
}

}  // namespace

std::vector<std::string> filesReadWith(const std::string& path, const std::string& assetRoot) {
  std::vector<std::string> files{path};
  if (!endsAs(path, ".gltf") && !endsAs(path, ".glb")) return files;
  const nlohmann::json scene = nlohmann::json::parse(jsonTextOf(path), nullptr, false);
  if (!scene.is_object()) return files;
  std::vector<fs::path> folders{fs::path(path).parent_path()};
  if (!assetRoot.empty()) folders.emplace_back(assetRoot);
  for (const char* array : {"buffers", "images"}) {
    const auto found = scene.find(array);
    if (found == scene.end() || !found->is_array()) continue;
    for (const nlohmann::json& entry : *found) {
      if (!entry.is_object() || !entry.contains("uri") || !entry["uri"].is_string()) continue;
      const auto uri = entry["uri"].get<std::string>();
      const std::string file = gltf::isDataUri(uri) ? "" : foundAs(uri, folders);
      if (!file.empty() && std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
    }
  }
  return files;
}

}  // namespace pellucid
