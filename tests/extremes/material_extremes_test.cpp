// Materials and lamps of a glTF over all that their numbers may be, each with every other, by every route: the picture
// stays finite and nowhere negative. PELLUCID_EXTREMES=N tries N times as many.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"
#include "tests/support/random.h"
#include "tests/support/shots.h"

namespace pellucid::test {
namespace {

constexpr int kEdge = 16, kScenes = 40;

class MaterialDraw {
 public:
  explicit MaterialDraw(std::uint64_t seed) : random_(seed) {}

  bool chance(double of) { return random_.uniform() < of; }
  template <class T>
  T oneOf(const std::vector<T>& all) {
    return all[random_.below(static_cast<std::uint32_t>(all.size()))];
  }
  double size() {
    return oneOf<double>({0.0, 1e-38, 1e-30, 1e-12, 1e-6, 1e-3, 0.5, 1.0, 2.0, 1e3, 1e6, 1e12, 1e30, 3e38});
  }
  double part() { return oneOf<double>({0.0, 1e-38, 1e-12, 1e-6, 0.3, 0.5, 0.999999, 1.0}); }
  nlohmann::json colour() { return {part(), part(), part()}; }

  nlohmann::json material() {
    nlohmann::json base = colour();
    base.push_back(part());
    nlohmann::json made{
        {"alphaMode", "BLEND"},
        {"doubleSided", chance(0.5)},
        {"pbrMetallicRoughness", {{"baseColorFactor", base}, {"metallicFactor", part()}, {"roughnessFactor", part()}}}};
    nlohmann::json& extensions = made["extensions"] = nlohmann::json::object();
    if (chance(0.4)) {
      made["emissiveFactor"] = colour();
      extensions["KHR_materials_emissive_strength"] = {{"emissiveStrength", size()}};
    }
    if (chance(0.5)) extensions["KHR_materials_transmission"] = {{"transmissionFactor", part()}};
    if (chance(0.5))
      extensions["KHR_materials_ior"] = {{"ior", oneOf<double>({0.0, 1.0, 1.0000001, 1.0001, 1.5, 10.0, 1e3, 1e12})}};
    if (chance(0.5))
      extensions["KHR_materials_volume"] = {{"thicknessFactor", size()},
                                            {"attenuationDistance", std::max(size(), 1e-38)},
                                            {"attenuationColor", colour()}};
    if (chance(0.3)) extensions["KHR_materials_dispersion"] = {{"dispersion", size()}};
    if (chance(0.3))
      extensions["KHR_materials_specular"] = {{"specularFactor", part()},
                                              {"specularColorFactor", {size(), size(), size()}}};
    if (chance(0.3))
      extensions["KHR_materials_diffuse_transmission"] = {{"diffuseTransmissionFactor", part()},
                                                          {"diffuseTransmissionColorFactor", colour()}};
    return made;
  }

  nlohmann::json lamp() {
    nlohmann::json made{
        {"type", oneOf<std::string>({"point", "spot", "directional"})}, {"intensity", size()}, {"color", colour()}};
    if (made["type"] == "spot") made["spot"] = nlohmann::json::object();
    if (made["type"] != "directional" && chance(0.3)) made["range"] = std::max(size(), 1e-30);
    return made;
  }

 private:
  Random random_;
};

void writeScene(const std::string& path, MaterialDraw& draw) {
  std::vector<Quad> quads;
  const int sheets = draw.oneOf<int>({1, 2, 3});
  for (int i = 0; i < sheets; ++i) {
    const float z = -1.0f - static_cast<float>(i) * draw.oneOf<float>({0.0f, 1e-7f, 0.3f, 1.0f});
    quads.push_back({{-2, -2, z}, {4, 0, draw.oneOf<float>({0.0f, -0.5f})}, {0, 4, 0}, draw.material()});
  }
  GlbOptions options;
  options.nodes.push_back({{"translation",
                            {draw.oneOf<double>({0.0, 1.0}), draw.oneOf<double>({0.0, 1e-6, 1.0}),
                             draw.oneOf<double>({-1.0, 1.0, -1.0000001})}},
                           {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  options.extra = {{"extensionsUsed",
                    {"KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_transmission",
                     "KHR_materials_ior", "KHR_materials_volume", "KHR_materials_dispersion", "KHR_materials_specular",
                     "KHR_materials_diffuse_transmission"}},
                   {"extensions", {{"KHR_lights_punctual", {{"lights", {draw.lamp()}}}}}}};
  writeGlb(path, quads, options);
}

TEST(Extremes, MaterialsAndLampsOverTheWholeRange) {
  const std::string folder = freshFolder("extremes-materials");
  const auto plane = [](float value) { return Image<float>(kEdge, kEdge, value); };
  const Window window{0, 0, kEdge, kEdge};
  writeLayers(folder + "/wall.exr", window, window,
              {{"", {{"R", plane(0.2f)}, {"G", plane(0.4f)}, {"B", plane(0.6f)}, {"Z", plane(5.0f)}}}});
  const std::vector<std::vector<std::string>> routes{{},
                                                     {"--method", "phenomenological"},
                                                     {"--method", "phenomenological", "--precision", "exact"},
                                                     {"--method", "phenomenological", "--precision", "published"},
                                                     {"--method", "phenomenological", "--resolve", "gl"},
                                                     {"--method", "weighted"},
                                                     {"--method", "stochastic"},
                                                     {"--method", "moments:4"},
                                                     {"--method", "mlab:4"},
                                                     {"--method", "front+tail"},
                                                     {"--tolerance", "0.01"},
                                                     {"--shadows", "exact"},
                                                     {"--fog", "density=0.1"}};
  const char* asked = std::getenv("PELLUCID_EXTREMES");
  const int scenes = kScenes * (asked ? std::max(std::atoi(asked), 1) : 1);
  std::size_t drawn = 0, refused = 0;
  for (int i = 0; i < scenes; ++i) {
    MaterialDraw draw(static_cast<std::uint64_t>(i));
    writeScene(folder + "/scene.glb", draw);
    std::vector<std::string> words{"composite",
                                   folder + "/wall.exr",
                                   folder + "/scene.glb",
                                   "-o",
                                   folder + "/out.exr",
                                   "--environment",
                                   draw.oneOf<std::string>({"0,0,0", "0.5,0.5,0.5", "1e30,1e30,1e30"}),
                                   "--aa",
                                   draw.oneOf<std::string>({"1", "4"})};
    const std::vector<std::string>& route = routes[static_cast<std::size_t>(i) % routes.size()];
    words.insert(words.end(), route.begin(), route.end());
    const Ended ended = runProgram(words);
    SCOPED_TRACE(testing::Message() << "scene " << i << ", " << (route.empty() ? "default" : route[1]));
    if (ended.code == 4 && ended.err.find("no punctual light") != std::string::npos) {
      ++refused;  // --shadows of a lamp that does not shine
      continue;
    }
    ASSERT_EQ(ended.code, 0) << ended.err;
    const Image<glm::vec4> picture = readOpaque(folder + "/out.exr", {}).gbuffer.beauty;
    for (std::size_t k = 0; k < picture.size(); ++k)
      for (int c = 0; c < 3; ++c) {
        ASSERT_TRUE(std::isfinite(picture[k][c])) << ended.err;
        ASSERT_GE(picture[k][c], 0.0f);
      }
    ++drawn;
  }
  std::printf("%zu scenes drawn, %zu refused\n", drawn, refused);
  EXPECT_LE(refused, drawn / 10);
}

}  // namespace
}  // namespace pellucid::test
