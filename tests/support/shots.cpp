#include "tests/support/shots.h"

#include <cstdint>
#include <cstring>
#include <fstream>

namespace pellucid::test {

using nlohmann::json;

json unlit(float r, float g, float b, float alpha) {
  return {{"alphaMode", "BLEND"},
          {"doubleSided", true},
          {"pbrMetallicRoughness", {{"baseColorFactor", {r, g, b, alpha}}}},
          {"extensions", {{"KHR_materials_unlit", json::object()}}}};
}

namespace {

// Appends the animation's numbers to the binary chunk, and everything that names them to the document.
void addMotions(const std::vector<Motion>& motions, json& root, std::string& bin) {
  if (motions.empty()) return;
  constexpr float kSeconds = 10.0f;
  const auto accessor = [&](const std::vector<float>& values, const char* type, std::size_t count) {
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", values.size() * 4}});
    bin.append(reinterpret_cast<const char*>(values.data()), values.size() * 4);
    root["accessors"].push_back(
        {{"bufferView", root["bufferViews"].size() - 1}, {"componentType", 5126}, {"count", count}, {"type", type}});
    return root["accessors"].size() - 1;
  };
  json animation{{"name", "moves"}};
  const std::size_t times = accessor({0.0f, kSeconds}, "SCALAR", 2);
  for (const Motion& motion : motions) {
    const auto& v = motion.perSecond;
    const std::size_t places =
        accessor({0.0f, 0.0f, 0.0f, kSeconds * v[0], kSeconds * v[1], kSeconds * v[2]}, "VEC3", 2);
    animation["samplers"].push_back({{"input", times}, {"output", places}});
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", motion.node}, {"path", "translation"}}}});
  }
  root["animations"] = {animation};
}

}  // namespace

void writeGlb(const std::string& path, const std::vector<Quad>& quads, const GlbOptions& options) {
  std::string bin;
  const auto put = [&](const void* data, std::size_t bytes) {
    const std::size_t at = bin.size();
    bin.append(static_cast<const char*>(data), bytes);
    return at;
  };
  json root{{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  json nodes = json::array(), scene = json::array();
  for (const Quad& quad : quads) {
    float positions[4][3];
    const float uv[4][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    for (int i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        positions[i][k] = quad.corner[k] + (i == 1 || i == 2 ? quad.across[k] : 0) + (i >= 2 ? quad.up[k] : 0);
    const std::uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
    const std::size_t at = root.contains("accessors") ? root["accessors"].size() : 0;
    const auto view = [&](std::size_t offset, std::size_t bytes) {
      root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}});
      return root["bufferViews"].size() - 1;
    };
    json low = json::array(), high = json::array();
    for (std::size_t k = 0; k < 3; ++k) {
      float least = positions[0][k], most = positions[0][k];
      for (const auto& position : positions) least = std::min(least, position[k]), most = std::max(most, position[k]);
      low.push_back(least);
      high.push_back(most);
    }
    root["accessors"].push_back({{"bufferView", view(put(positions, sizeof positions), sizeof positions)},
                                 {"componentType", 5126},
                                 {"count", 4},
                                 {"type", "VEC3"},
                                 {"min", low},
                                 {"max", high}});
    root["accessors"].push_back(
        {{"bufferView", view(put(uv, sizeof uv), sizeof uv)}, {"componentType", 5126}, {"count", 4}, {"type", "VEC2"}});
    root["accessors"].push_back({{"bufferView", view(put(indices, sizeof indices), sizeof indices)},
                                 {"componentType", 5123},
                                 {"count", 6},
                                 {"type", "SCALAR"}});
    root["materials"].push_back(quad.material);
    root["meshes"].push_back({{"primitives",
                               {{{"attributes", {{"POSITION", at}, {"TEXCOORD_0", at + 1}}},
                                 {"indices", at + 2},
                                 {"material", root["materials"].size() - 1}}}}});
    scene.push_back(nodes.size());
    nodes.push_back({{"mesh", root["meshes"].size() - 1}, {"name", "quad" + std::to_string(nodes.size())}});
  }
  if (options.camera) {
    root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", options.yfov}, {"znear", 0.1}}}}};
    scene.push_back(nodes.size());
    nodes.push_back({{"camera", 0}, {"name", "cam"}});
  }
  for (const json& node : options.nodes) {
    scene.push_back(nodes.size());
    nodes.push_back(node);
  }
  root["nodes"] = nodes;
  root["scenes"] = {{{"nodes", scene}}};
  root["extensionsUsed"] = {"KHR_materials_unlit"};
  while (bin.size() % 4) bin.push_back('\0');
  addMotions(options.motions, root, bin);
  if (!bin.empty()) root["buffers"] = {{{"byteLength", bin.size()}}};
  root.merge_patch(options.extra);
  std::string text = root.dump();
  while (text.size() % 4) text.push_back(' ');
  std::ofstream out(path, std::ios::binary);
  const auto word = [&](std::size_t value) {
    const auto narrow = static_cast<std::uint32_t>(value);
    out.write(reinterpret_cast<const char*>(&narrow), 4);
  };
  word(0x46546c67);
  word(2);
  word(12 + 8 + text.size() + (bin.empty() ? 0 : 8 + bin.size()));
  word(text.size());
  word(0x4e4f534a);
  out << text;
  if (!bin.empty()) {
    word(bin.size());
    word(0x004e4942);
    out << bin;
  }
}

}  // namespace pellucid::test
