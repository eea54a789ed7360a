#include "tests/pipeline/shot_files.h"

#include <algorithm>

#include "composite/deep/sample_channels.h"
#include "gbuffer/deep_io.h"
#include "tests/support/exr_shots.h"
#include "tests/support/shots.h"

namespace pellucid::test {

DeepHeader deepHeaderOf(int width, int height) {
  DeepHeader header;
  header.display = header.data = {0, 0, width, height};
  header.channels = {"A", "B", "G", "R", "Z"};
  return header;
}

DeepRows noSamplesOf(const DeepHeader& header) {
  DeepRows rows;
  rows.window = header.data;
  rows.channels.resize(header.channels.size());
  rows.offsets.assign(1, 0);
  return rows;
}

double farthestApart(const Image<glm::vec4>& a, const Image<glm::vec4>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, static_cast<double>(glm::length(glm::vec3(a[i] - b[i]))));
  return largest;
}

namespace {

using nlohmann::json;

json smoke(float alpha) {
  return {{"name", "smoke"},
          {"alphaMode", "BLEND"},
          {"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {0.8, 0.7, 0.6, alpha}}, {"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}}};
}

json glass(const char* name, json colour) {
  return {{"name", name},
          {"pbrMetallicRoughness", {{"baseColorFactor", colour}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.3}}},
          {"extensions",
           {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
            {"KHR_materials_ior", {{"ior", 1.5}}},
            {"KHR_materials_volume", {{"thicknessFactor", 0.1}}}}}};
}

json sun() {
  return {
      {"extensionsUsed",
       {"KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_volume"}},
      {"extensions",
       {{"KHR_lights_punctual", {{"lights", {{{"name", "sun"}, {"type", "directional"}, {"intensity", 1366.0}}}}}}}}};
}

void writeScene(const std::string& path) {
  std::vector<Quad> quads;
  for (int i = 0; i < 3; ++i) {
    const auto z = static_cast<float>(-6.0 - 0.3 * i);
    quads.push_back(Quad{{-3.0f, -2.0f, z}, {5.0f, 0, 0}, {0, 4.0f, 0}, smoke(0.3f)});
  }
  quads.push_back(Quad{{-1.0f, -1.0f, -4.0f}, {3.0f, 0, 0}, {0, 2.0f, 0}, glass("glass", {1.0, 0.4, 0.3, 1.0})});
  quads.push_back(Quad{{-2.0f, -2.0f, -5.0f}, {4.0f, 0, 0}, {0, 3.0f, 0}, glass("green", {0.3, 1.0, 0.5, 1.0})});
  GlbOptions options;
  options.extra = sun();
  options.nodes = json::array({{{"name", "sun"},
                                {"rotation", {-0.38268343, 0.0, 0.0, 0.92387953}},
                                {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}});
  // A card of smoke and a glass; without a time both stand where they are.
  options.motions = {{0, {6.0f, 0.0f, 0.0f}}, {3, {-3.0f, 1.5f, 0.0f}}};
  writeGlb(path, quads, options);
}

// The flat picture as deep samples: a wall, and in the left half a post before it that covers half of each pixel.
void writeDeepPicture(const std::string& path, bool withPost) {
  DeepHeader header;
  header.display = header.data = {0, 0, kShotWidth, kShotHeight};
  header.channels = {"A", "B", "G", "R", "Z"};
  header.attributes = {};
  DeepWriter writer(path, header);
  DeepRows rows;
  rows.window = header.data;
  rows.channels.resize(5);
  rows.offsets.assign(1, 0);
  const auto put = [&](float a, float b, float g, float r, float z) {
    const float values[] = {a, b, g, r, z};
    for (std::size_t c = 0; c < 5; ++c) rows.channels[c].push_back(values[c]);
  };
  for (int y = 0; y < kShotHeight; ++y)
    for (int x = 0; x < kShotWidth; ++x) {
      if (withPost && x < kShotWidth / 2) put(0.5f, 0.05f, 0.1f, 0.2f, 5.0f);
      put(1.0f, 0.75f, 0.5f, 0.25f, 20.0f);
      rows.offsets.push_back(rows.channels[0].size());
    }
  writer.write(rows);
  writer.finish();
}

// One even card in front of everything.
void writeDeepLayers(const std::string& path) {
  const DeepHeader header = deepHeaderOf(kShotWidth, kShotHeight);
  DeepWriter writer(path, header);
  DeepRows rows = noSamplesOf(header);
  for (int i = 0; i < kShotWidth * kShotHeight; ++i) {
    const float values[] = {0.25f, 0.02f, 0.05f, 0.1f, 3.0f};
    for (std::size_t c = 0; c < 5; ++c) rows.channels[c].push_back(values[c]);
    rows.offsets.push_back(rows.channels[0].size());
  }
  writer.write(rows);
  writer.finish();
}

void writeFlat(const std::string& path) {
  const auto plane = [&](float value) { return Image<float>(kShotWidth, kShotHeight, value); };
  const std::vector<ExtraLayer> layers{
      {"", {{"R", plane(0.25f)}, {"G", plane(0.5f)}, {"B", plane(0.75f)}, {"A", plane(1.0f)}, {"Z", plane(20.0f)}}},
      {"light.sun", {{"R", plane(0.2f)}, {"G", plane(0.3f)}, {"B", plane(0.4f)}}}};
  const Window window{0, 0, kShotWidth, kShotHeight};
  writeLayers(path, window, window, layers);
}

}  // namespace

ShotFiles writeShotFiles(const std::string& folder) {
  ShotFiles files{folder + "/flat.exr",  folder + "/deep.exr",   folder + "/scene.glb",
                  folder + "/unlit.glb", folder + "/layers.exr", folder + "/wall.exr"};
  writeFlat(files.flat);
  writeDeepPicture(files.deepPicture, true);
  writeDeepPicture(files.deepWall, false);
  writeScene(files.scene);
  writeGlb(files.unlitScene, {Quad{{-30, -30, -5}, {60, 0, 0}, {0, 60, 0}, unlit(0.1f, 0.1f, 0.1f, 0.7f)}});
  writeDeepLayers(files.deepLayers);
  return files;
}

Request requestOf(const std::string& opaque, const std::string& scene) {
  Request request;
  request.shot.opaque = opaque;
  request.shot.inputs = {scene};
  request.shot.surroundings = glm::vec3(0.2f, 0.3f, 0.4f);
  request.method = "phenomenological";
  request.paint = PaintSums{};
  return request;
}

void openShutter(Request& request) {
  request.passes = std::max(request.passes, 2);
  request.shot.time.frame = 12;
  request.shutter = Shutter{-0.5, 0.5, false};
}

void openLens(Request& request) {
  request.passes = std::max(request.passes, 2);
  request.lens.radius = 0.2;
  request.lens.focus = 9.0;
}

Paint paintOf(const std::string& method) {
  if (method == "phenomenological") return PaintSums{};
  if (method == "over") return PaintSorted{};
  if (method.rfind("stochastic", 0) == 0) {
    PaintSamples samples;
    if (method == "stochastic:basic") samples.settings.variant = StochasticSettings::Variant::basic;
    if (method == "stochastic:alpha") samples.settings.variant = StochasticSettings::Variant::alpha;
    return samples;
  }
  return PaintListed{*chooseMethod(method)};
}

}  // namespace pellucid::test
