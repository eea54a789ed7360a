#include "tests/pictures/scene_finish.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::test {

void makeGlass(SceneMaker& maker, Random& random) {
  maker.scene().oneColour = false;
  for (PlacedMesh& mesh : maker.scene().placed) {
    const bool coloured = mesh.coat.texture >= 0 || !mesh.colours.empty();
    if ((coloured && (maker.scene().kind != "refracting" || chance(random, 0.5))) || chance(random, 0.3)) continue;
    mesh.coat.glass = true;
    mesh.coat.colour = Vec4(glm::min(drawnColour(random), Vec3(1.0)), chance(random, 0.5) ? 1.0 : mesh.coat.colour.a);
    if (chance(random, 0.5)) mesh.coat.emission = drawnColour(random);
  }
}

void makeRefracting(SceneMaker& maker, Random& random) {
  using Until = reference::Bending::Until;
  reference::PictureScene& numbers = maker.scene().numbers;
  makeGlass(maker, random);
  const double size = maker.scene().size;
  for (PlacedMesh& mesh : maker.scene().placed) {
    if (!mesh.coat.glass || chance(random, 0.2)) continue;
    reference::Filling& filling = mesh.coat.filling;
    filling.index = chance(random, 0.1) ? 1.0 : random.between(1.0, 2.4);
    filling.thickness = logBetween(random, 1e-3, 0.5) * size;
    filling.mirrors = chance(random, 0.4);
    if (chance(random, 0.25)) filling.dispersion = random.between(0.1, 2.0);
    if (chance(random, 0.6)) {
      filling.clearness = filling.thickness * logBetween(random, 0.2, 20.0);
      filling.colour = glm::min(drawnColour(random), Vec3(1.0));
    }
    if (chance(random, 0.5)) mesh.coat.colour = Vec4(1.0, 1.0, 1.0, mesh.coat.colour.a);
  }
  static constexpr Until kUntil[] = {Until::depth, Until::depth,    Until::slab, Until::slab,
                                     Until::slab,  Until::distance, Until::never};
  numbers.bending.until = kUntil[random.below(static_cast<std::uint32_t>(std::size(kUntil)))];
  numbers.bending.distance = logBetween(random, 0.01, 2.0) * size;
  if (chance(random, 0.4)) numbers.surroundings = drawnColour(random);
  if (chance(random, 0.3)) return;
  const double pixel = 2.0 * widthAt(maker, size) / numbers.eye.displayWidth;
  for (reference::Solid& solid : numbers.solids) {
    solid.stripes = random.between(0.2, 0.9) * solid.colour;
    solid.across = 2.0 * std::numbers::pi / (random.between(5.0, 20.0) * pixel) * turned(random)[0];
  }
}

void fillAir(SceneMaker& maker, Random& random) {
  const double size = maker.scene().size;
  reference::EvenAir& air = maker.scene().numbers.air;
  air.density = logBetween(random, 0.01, 3.0) / size;
  air.light = maker.scene().oneColour ? maker.oneColour() : glm::min(drawnColour(random), Vec3(1.0));
  if (chance(random, 0.5)) air.farthest = random.between(0.5, 3.0) * size;
  if (chance(random, 0.6)) return;
  const auto part = [&] { return size * random.between(0.2, 1.0); };
  const double across = part(), up = part();
  air.inside = reference::Box{Vec3(maker.worldFromEye() * Vec4(maker.at(0, 0, random.between(0.0, 1.2) * size), 1.0)),
                              glm::dmat3(1.0), Vec3(across, up, part())};
}

namespace {

void addLamp(SceneMaker& maker, Random& random) {
  using Kind = reference::PunctualLamp::Kind;
  const double size = maker.scene().size;
  reference::PunctualLamp lamp;
  lamp.kind = static_cast<Kind>(random.below(3));
  const Vec3 at = maker.at(random.between(-2, 2), random.between(-2, 2), random.between(-0.3, 1.2) * size);
  const Vec3 aim = maker.at(random.between(-0.5, 0.5), random.between(-0.5, 0.5), random.between(0.8, 1.3) * size);
  lamp.at = Vec3(maker.worldFromEye() * Vec4(at, 1.0));
  lamp.along = glm::dmat3(maker.worldFromEye()) * glm::normalize(aim - at);
  const double metres = lamp.kind == Kind::sun ? 1.0 : size;
  lamp.intensity = 3.0 * metres * metres * drawnColour(random);
  if (chance(random, 0.3)) lamp.range = random.between(0.8, 3.0) * size;
  lamp.outerCone = random.between(0.2, 1.4);
  lamp.innerCone = lamp.outerCone * random.between(0.0, 0.95);
  maker.scene().numbers.lamps.push_back(lamp);
}

}  // namespace

void lightUp(SceneMaker& maker, Random& random) {
  maker.scene().oneColour = false;
  const int lamps = 1 + static_cast<int>(random.below(3));
  for (int i = 0; i < lamps; ++i) addLamp(maker, random);
  for (PlacedMesh& mesh : maker.scene().placed) {
    reference::Coat& coat = mesh.coat;
    reference::Finish& finish = coat.finish;
    if (chance(random, 0.15) && !coat.glass) continue;
    finish.lit = true;
    finish.roughness = random.between(0.15, 1.0);
    if (chance(random, 0.3)) finish.metal = chance(random, 0.5) ? 1.0 : random.uniform();
    if (chance(random, 0.4) && coat.texture < 0 && mesh.colours.empty()) coat.glass = true;
    if (coat.glass && chance(random, 0.4)) finish.passes = random.uniform();
    coat.filling.mirrors = chance(random, 0.7);
    if (coat.filling.thickness == 0.0) coat.filling.index = random.between(1.0, 2.4);
  }
  if (chance(random, 0.3)) maker.scene().numbers.surroundings = drawnColour(random);
}

}  // namespace pellucid::test
