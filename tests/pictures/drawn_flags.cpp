#include "tests/pictures/drawn_flags.h"

#include <fmt/format.h>

#include <algorithm>

#include "tests/pictures/scene_parts.h"

namespace pellucid::test {
namespace {

template <std::size_t N>
const char* oneOf(Random& random, const char* const (&texts)[N]) {
  return texts[random.below(static_cast<std::uint32_t>(N))];
}

void drawFilter(Random& random, DrawnFlags& flags) {
  if (flags.passes == 1 || chance(random, 0.5)) return;
  static constexpr const char* kShapes[] = {"box", "triangle", "gaussian", "blackman-harris"};
  flags.filter.shape = oneOf(random, kShapes);
  flags.filter.radius = std::round(random.between(0.5, 1.6) * 64.0) / 64.0;
  flags.words.push_back(fmt::format("--filter={}:{}", flags.filter.shape, flags.filter.radius));
}

void drawDepth(const DrawnScene& scene, Random& random, DrawnFlags& flags) {
  static constexpr const char* kKinds[] = {"ray", "inverse", "negative"};
  if (chance(random, 0.3)) {
    flags.form.depthKind = oneOf(random, kKinds);
    flags.words.push_back("--depth-kind=" + flags.form.depthKind);
  }
  if (chance(random, 0.1)) {
    flags.form.metresPerUnit = 0.01;
    flags.words.emplace_back("--unit=0.01");
  }
  // Halves below 2^-14 have larger steps, and none is above 65504.
  const double unit = scene.size / flags.form.metresPerUnit;
  flags.form.half = chance(random, 0.4) && unit < (flags.form.depthKind == "inverse" ? 50.0 : 1000.0);
}

void drawMethod(const DrawnScene& scene, Random& random, DrawnFlags& flags) {
  if (scene.oneColour) {
    static constexpr const char* kMeans[] = {"over",       "phenomenological", "weighted",
                                             "front+tail", "mlab:4",           "wavelet:2"};
    flags.method = oneOf(random, kMeans);
  }
  if (scene.oneLayer) {
    static constexpr const char* kSums[] = {"phenomenological", "phenomenological", "front+tail", "mlab:4"};
    flags.method = oneOf(random, kSums);
  }
  const bool hasExact = flags.method == "over" || flags.method == "phenomenological";
  const bool exact = hasExact && chance(random, 0.4);
  // Precision by itself asks for the sums.
  if (exact || flags.method != "over" || chance(random, 0.5)) flags.words.push_back("--method=" + flags.method);
  if (exact) flags.words.emplace_back("--precision=exact");
  if (flags.method == "phenomenological" && chance(random, 0.3)) flags.words.emplace_back("--resolve=gl");
  static constexpr const char* kWeights[] = {"auto", "power:2", "eq7", "uniform"};
  if (flags.method == "phenomenological" || flags.method == "weighted")
    flags.words.push_back(std::string("--weight=") + oneOf(random, kWeights));
}

// The surroundings light the fog; of what it scatters all that is not its albedo's share is theirs.
void drawAir(const reference::PictureScene& scene, Random& random, DrawnFlags& flags) {
  const reference::EvenAir& air = scene.air;
  const Vec3 around = scene.surroundings;
  const bool lit = around != Vec3(0.0);
  if (!(air.density > 0.0)) {
    const bool mirrors = std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const reference::Mesh& mesh) {
      return mesh.coat.filling.mirrors || mesh.coat.finish.lit;
    });
    // Else the picture's sky would light them.
    if (mirrors) flags.words.push_back(fmt::format("--environment={},{},{}", around.r, around.g, around.b));
    return;
  }
  const double part = lit ? air.light.r / around.r : random.between(0.3, 1.0);
  std::string fog = fmt::format("--fog=density={},albedo={}", air.density, part);
  if (air.farthest) fog += fmt::format(",far={}", *air.farthest);
  if (air.inside) {
    const reference::Vec3 low = air.inside->centre - air.inside->half, high = air.inside->centre + air.inside->half;
    fog += fmt::format(",box={}:{}:{}:{}:{}:{}", low.x, low.y, low.z, high.x, high.y, high.z);
  }
  if (chance(random, 0.3)) fog += fmt::format(",g={:.2f}", random.between(-0.9, 0.9));
  if (chance(random, 0.3)) fog += fmt::format(",steps={}", 1 + random.below(96));
  flags.words.push_back(fog);
  flags.words.push_back(
      fmt::format("--environment={},{},{}", air.light.r / part, air.light.g / part, air.light.b / part));
}

// Rough glass spreads what stands behind it, and surroundings are dimmed on leaves by what stands beside them: the
// reference knows nothing of either.
void addLight(const reference::PictureScene& scene, DrawnFlags& flags) {
  if (scene.lamps.empty()) return;
  flags.words.emplace_back("--diffusion=off");
  flags.words.emplace_back("--occlusion=off");
  if (scene.shadows) flags.words.emplace_back("--shadows=exact");
}

void addBending(const reference::PictureScene& scene, DrawnFlags& flags) {
  using Until = reference::Bending::Until;
  switch (scene.bending.until) {
    case Until::depth:
      return;
    case Until::never:
      return flags.words.emplace_back("--refract=off"), void();
    case Until::slab:
      return flags.words.emplace_back("--refract=thickness"), void();
    case Until::distance:
      flags.words.push_back(fmt::format("--refract=fixed:{}", scene.bending.distance));
  }
}

}  // namespace

DrawnFlags drawFlags(const DrawnScene& scene, Random& random) {
  static constexpr int kPasses[] = {1, 1, 2, 3, 4, 5, 8, 8, 8, 16, 16, 32, 64};
  DrawnFlags flags;
  flags.passes = kPasses[random.below(static_cast<std::uint32_t>(std::size(kPasses)))];
  flags.words.push_back(fmt::format("--aa={}", flags.passes));
  drawFilter(random, flags);
  drawDepth(scene, random, flags);
  drawMethod(scene, random, flags);
  flags.edges = flags.passes > 1;
  if (flags.edges && chance(random, 0.2)) {
    flags.edges = false;
    flags.words.emplace_back("--edges=off");
  }
  if (scene.kind == "cut-outs" && chance(random, 0.4)) {
    flags.softMask = false;
    flags.words.emplace_back("--mask=hard");
  }
  drawAir(scene.numbers, random, flags);
  addBending(scene.numbers, flags);
  addLight(scene.numbers, flags);
  if (chance(random, 0.2)) flags.words.emplace_back("--budget=1M");
  if (chance(random, 0.2)) flags.words.push_back(fmt::format("--order=shuffle:{}", random.below(100)));
  return flags;
}

}  // namespace pellucid::test
