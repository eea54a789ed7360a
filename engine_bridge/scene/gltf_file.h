// The container: a .gltf with its buffers, or a .glb. Knows JSON and bytes, not what they mean.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine_bridge/scene/asset_files.h"
#include "engine_bridge/scene/json_view.h"
#include "engine_bridge/scene/mapped_file.h"

namespace pellucid::gltf {

// A file of the glTF family, opened: the JSON is parsed and asset.version checked. Throws InputError.
class GltfFile {
 public:
  //   ledger     of the pages of its files, or null
  //   assetRoot  a folder whose files it may name besides those under its own; empty for none
  explicit GltfFile(const std::string& path, std::shared_ptr<PageLedger> ledger = nullptr,
                    const std::string& assetRoot = "");
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  const std::string& path() const { return path_; }
  JsonView root() const { return JsonView(json_, path_, ""); }

  // Whether some of its text was no UTF-8 and has been read as Latin-1.
  bool hasRepairedText() const { return repairedText_; }

  // Whether extensionsUsed names it.
  bool uses(const char* extension) const;

  // Top-level arrays ("nodes", "meshes"); 0 elements when absent.
  std::size_t count(const char* array) const;
  JsonView item(const char* array, std::size_t index) const;
  // The element of `array` that `reference` points at.
  JsonView item(const char* array, const JsonView& reference) const;

  // Whether the document has a place for a value at this JSON pointer: everything but its last name is there, or is an
  // object whose absence means defaults.
  bool holds(const std::string& pointer) const;
  // Puts a value there: a number, an array of several, or true and false where it is `visible`. What stands there must
  // be of the same shape, or absent. Throws InputError. Views of the document do not survive it.
  void put(const std::string& pointer, const std::vector<double>& values);

  // The bytes of a buffer view, checked against its buffer, unpacked when they are compressed. Buffers are mapped at
  // first use and kept.
  SharedBytes viewBytes(const JsonView& view);
  // The content of a data: URI, or of a file under this one's folder.
  std::vector<std::uint8_t> uriBytes(const std::string& uri, const std::string& whose) const;
  // Everything read or mapped so far. What a scene may grow to is measured against it.
  std::size_t bytesRead() const { return bytesRead_; }
  // Throws InputError when a file that was mapped has been cut short since.
  void requireWhole() const;

 private:
  SharedBytes bufferBytes(std::size_t index);
  SharedBytes rangeOf(const JsonView& holder);  // of the object with buffer, byteOffset and byteLength
  SharedBytes uriBuffer(const std::string& uri, const std::string& whose) const;
  OpenFile openNamed(const std::string& uri, const std::string& whose) const;
  void parseJson(Bytes text);

  std::string path_;
  AssetFiles named_;
  std::shared_ptr<PageLedger> ledger_;
  SharedBytes content_;  // of the .gltf or .glb
  SharedBytes binary_;   // the BIN chunk of a .glb
  bool hasBinary_ = false, repairedText_ = false;
  nlohmann::json json_;
  std::map<std::size_t, SharedBytes> buffers_;
  std::map<std::string, SharedBytes> unpacked_;  // by the view's place in the file
  std::size_t bytesRead_ = 0, bytesUnpacked_ = 0;
};

}  // namespace pellucid::gltf
