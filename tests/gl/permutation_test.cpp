// Every text of the fragment stage that a material and a frame can ask for compiles and links.
#include <gtest/gtest.h>

#include <chrono>
#include <set>

#include "engine_bridge/gl/gl_program.h"
#include "engine_bridge/gl/permutation.h"
#include "shaders/weights.h"
#include "tests/gl/builder.h"

namespace pellucid::test {
namespace {

using Defines = std::vector<std::string>;

// Every combination of what surfaceDefines() looks at, as sets of defines without repeats.
std::set<Defines> surfaces() {
  std::set<Defines> found;
  for (int bits = 0; bits < 1 << 14; ++bits) {
    auto bit = [bits](int i) { return (bits >> i & 1) != 0; };
    Material material;
    material.alphaMode = bit(0) ? AlphaMode::blend : bit(1) ? AlphaMode::mask : AlphaMode::opaque;
    material.unlit = bit(2);
    material.transmission = bit(3) ? 1.0f : 0.0f;
    material.volume = bit(4);
    material.thickness = material.attenuationDistance = 1.0f;
    material.emission = glm::vec3(1.0f);
    if (bit(5)) material.baseColorTexture.texture = 0;
    if (bit(6)) material.metallicRoughnessTexture.texture = 0;
    if (bit(7)) material.emissiveTexture.texture = 0;
    if (bit(8)) material.transmissionTexture.texture = 0;
    if (bit(9)) material.thicknessTexture.texture = 0;
    gl::FrameFeatures frame;
    frame.mask = bit(10) ? MaskEdge::hard : MaskEdge::smooth;
    frame.lights = bit(11);
    frame.surroundings = bit(12);
    found.insert(gl::surfaceDefines(material, bit(13), frame));
  }
  return found;
}

SumsSettings sumsOf(int weight, int normalisation) {
  SumsSettings sums;
  sums.weight.kind = weight;
  sums.normalisation = normalisation;
  return sums;
}

void build(const Defines& output, const Defines& surface) {
  Defines defines = output;
  defines.insert(defines.end(), surface.begin(), surface.end());
  std::string text;
  for (const std::string& define : defines) text += define + ' ';
  ASSERT_NO_THROW(gl::buildProgram("gl/transparent.vert", "gl/transparent.frag", defines)) << text;
}

TEST(Permutations, EverySurfaceCompilesAndLinks) {
  GlContext context;
  const auto start = std::chrono::steady_clock::now();
  const std::set<Defines> all = surfaces();
  ASSERT_GT(all.size(), 1000u);
  // Each surface with one output in turn, so that all pairs of a feature and an output are met.
  gl::FrameFeatures frame;
  std::size_t turn = 0;
  for (const Defines& surface : all) {
    frame.solids = turn / gl::kOutputs % 2 == 1;
    frame.grey = turn / (2 * gl::kOutputs) % 2 == 1;
    build(gl::outputDefines(static_cast<gl::Output>(turn % gl::kOutputs), frame,
                            sumsOf(shading::PLD_WEIGHT_EQ5, turn / 8 % 2 ? 0 : 1)),
          surface);
    ++turn;
  }
  // How a mask's texture is stored is said apart (SceneTextures::defines).
  for (const char* edge : {"MASK_SMOOTH", "MASK_HARD"})
    for (const char* levels : {"MASK_LEVELLED", "MASK_UNLEVELLED"})
      build(gl::outputDefines(gl::Output::list, frame, sumsOf(shading::PLD_WEIGHT_EQ5, 0)),
            {edge, levels, "BASE_TEXTURE", "BASE_WEIGHTED"});
  std::printf("%zu surfaces in %.1f s\n", all.size(),
              std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

// Beside the others, which they do not touch.
TEST(Permutations, NormalAndSpecularTexturesAndEnvironmentsCompileAndLink) {
  GlContext context;
  for (int bits = 0; bits < 1 << 6; ++bits) {
    auto bit = [bits](int i) { return (bits >> i & 1) != 0; };
    Material material;
    material.transmission = 1.0f;
    material.alphaMode = bit(0) ? AlphaMode::blend : AlphaMode::mask;
    if (bit(1)) material.normalTexture.texture = 0;
    if (bit(5)) material.specularTexture.texture = material.specularColorTexture.texture = 0;
    gl::FrameFeatures frame;
    frame.environment = bit(2);
    frame.lights = bit(3);
    frame.refracts = frame.diffuses = bit(4);
    frame.prune = false;
    build(gl::outputDefines(bit(3) ? gl::Output::list : gl::Output::sums, frame, sumsOf(shading::PLD_WEIGHT_EQ5, 0)),
          gl::surfaceDefines(material, bit(0), frame));
  }
}

TEST(Permutations, EveryOutputCompilesAndLinks) {
  GlContext context;
  const Material plain = unlitBlend({1, 1, 1}, 0.5f);
  Material glass;
  glass.transmission = 1.0f;
  gl::FrameFeatures frame;
  frame.lights = frame.surroundings = true;
  for (const bool solids : {false, true}) {
    frame.solids = solids;
    for (const Material& material : {plain, glass}) {
      const Defines surface = gl::surfaceDefines(material, false, frame);
      for (const gl::Output output : {gl::Output::count, gl::Output::list, gl::Output::solid, gl::Output::published})
        build(gl::outputDefines(output, frame, sumsOf(0, 0)), surface);
      for (int weight = 0; depthWeightOf(weight); ++weight)
        for (const int normalisation : {shading::PLD_NORMALISE_SPECTRAL, shading::PLD_NORMALISE_PUBLISHED})
          build(gl::outputDefines(gl::Output::sums, frame, sumsOf(weight, normalisation)), surface);
    }
  }
}

TEST(Permutations, BrokenTextIsOurMistake) {
  GlContext context;
  EXPECT_THROW(gl::buildProgram("gl/transparent.vert", "gl/transparent.frag", {"OUTPUT_SUMS"}), std::logic_error);
  EXPECT_THROW(gl::buildProgram("gl/transparent.vert", "gl/nothing.frag", {}), std::logic_error);
}

}  // namespace
}  // namespace pellucid::test
