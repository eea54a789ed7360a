// Small glTF files made in the test: JSON and bytes, written as .glb or .gltf into a folder of the test's own.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine_bridge/scene/gltf.h"
#include "gbuffer/errors.h"

namespace pellucid::test {

using Json = nlohmann::json;

// One for each process, so that builds may test at the same time; gone when it ends.
struct ProcessFolder {
  std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / ("pellucid_scene." + std::to_string(::getpid()));
  ~ProcessFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

inline std::filesystem::path testFolder() {
  static const ProcessFolder process;
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder = process.path / (std::string(info->test_suite_name()) + "." + info->name());
  std::filesystem::create_directories(folder);
  return folder;
}

inline void writeBytes(const std::filesystem::path& path, const void* bytes, std::size_t size) {
  std::ofstream(path, std::ios::binary).write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
}

class Builder {
 public:
  Json json = {{"asset", {{"version", "2.0"}}}, {"accessors", Json::array()}, {"bufferViews", Json::array()}};
  std::vector<std::uint8_t> binary;

  // Appends bytes at a multiple of four and returns the view's index.
  int view(const void* bytes, std::size_t size) {
    binary.resize((binary.size() + 3) / 4 * 4);
    const auto* first = static_cast<const std::uint8_t*>(bytes);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", size}});
    binary.insert(binary.end(), first, first + size);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  template <class T>
  int accessor(const std::vector<T>& values, int componentType, const std::string& type, int width,
               bool normalised = false) {
    Json accessor = {{"bufferView", view(values.data(), values.size() * sizeof(T))},
                     {"componentType", componentType},
                     {"type", type},
                     {"count", values.size() / static_cast<std::size_t>(width)}};
    if (normalised) accessor["normalized"] = true;
    json["accessors"].push_back(accessor);
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int floats(const std::vector<float>& values, const std::string& type, int width) {
    return accessor(values, 5126, type, width);
  }
  int indices(const std::vector<std::uint16_t>& values) { return accessor(values, 5123, "SCALAR", 1); }

  // A mesh of one primitive, drawn by a node of its own. Returns the primitive to add to.
  Json& mesh(Json attributes) {
    json["meshes"].push_back({{"primitives", Json::array({{{"attributes", std::move(attributes)}}})}});
    json["nodes"].push_back({{"mesh", json["meshes"].size() - 1}});
    return json["meshes"].back()["primitives"][0];
  }

  // The triangle (0,0,0) (1,0,0) (0,1,0), without normals. Returns its primitive.
  Json& triangle() { return mesh({{"POSITION", floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3)}}); }

  // A triangle with this material, and the material itself.
  Json& material(Json material) {
    json["materials"].push_back(std::move(material));
    triangle()["material"] = json["materials"].size() - 1;
    return json["materials"].back();
  }

  std::string writeGlb(const std::string& name = "scene.glb") {
    if (!binary.empty() && !json.contains("buffers")) json["buffers"] = Json::array({{{"byteLength", binary.size()}}});
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<std::uint8_t> padded = binary;
    padded.resize((padded.size() + 3) / 4 * 4);
    std::string file;
    const auto word = [&](std::size_t value) {
      for (int i = 0; i < 4; ++i) file.push_back(static_cast<char>((value >> (8 * i)) & 0xff));
    };
    file += "glTF";
    word(2);
    word(12 + 8 + text.size() + (padded.empty() ? 0 : 8 + padded.size()));
    word(text.size());
    file += "JSON" + text;
    if (!padded.empty()) {
      word(padded.size());
      file += std::string("BIN\0", 4);
      file.append(padded.begin(), padded.end());
    }
    return write(name, file);
  }

  // The same as JSON text; give buffers a uri first.
  std::string writeGltf(const std::string& name = "scene.gltf") { return write(name, json.dump()); }

  Scene load(const SceneOptions& options = {}) { return loadScene({writeGlb()}, options); }

 private:
  static std::string write(const std::string& name, const std::string& content) {
    const std::filesystem::path path = testFolder() / name;
    writeBytes(path, content.data(), content.size());
    return path.string();
  }
};

// What a loader says when it refuses: its exit code and sentence; code 0 when it does not.
struct Refusal {
  int code = 0;
  std::string sentence;
};
inline Refusal refusalOf(const std::function<void()>& load) {
  try {
    load();
  } catch (const Error& error) {
    return {error.exitCode(), error.what()};
  }
  return {};
}
inline Refusal refusalOf(Builder& builder, const SceneOptions& options = {}) {
  return refusalOf([&] { builder.load(options); });
}

// One sentence, the right exit code, and every word that helps to find the place.
inline void expectRefusal(const Refusal& refusal, int code, const std::vector<std::string>& words) {
  EXPECT_EQ(refusal.code, code) << refusal.sentence;
  for (const std::string& word : words) EXPECT_NE(refusal.sentence.find(word), std::string::npos) << refusal.sentence;
  EXPECT_EQ(refusal.sentence.find('\n'), std::string::npos) << refusal.sentence;
}

inline bool noted(const Scene& scene, const std::string& words) {
  for (const std::string& note : scene.notes) {
    if (note.find(words) != std::string::npos) return true;
  }
  return false;
}

}  // namespace pellucid::test
