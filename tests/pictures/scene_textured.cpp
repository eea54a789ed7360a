#include "tests/pictures/scene_textured.h"

#include <cmath>

namespace pellucid::test {
namespace {

StoredTexture drawnTexture(Random& random, bool clearToo) {
  StoredTexture texture;
  texture.width = 2 + static_cast<int>(random.below(7));
  texture.height = 2 + static_cast<int>(random.below(7));
  for (int i = 0; i < texture.width * texture.height; ++i) {
    for (int c = 0; c < 3; ++c) texture.rgba.push_back(static_cast<std::uint8_t>(random.below(256)));
    const bool clear = clearToo && chance(random, 0.3);
    texture.rgba.push_back(clear ? 0 : static_cast<std::uint8_t>(1 + random.below(255)));
  }
  const auto wrap = [&] { return static_cast<reference::Wrap>(random.below(3)); };
  texture.wrapS = wrap();
  texture.wrapT = wrap();
  texture.nearest = chance(random, 0.3);
  return texture;
}

}  // namespace

void textured(SceneMaker& maker, Random& random, bool cut) {
  const double z = maker.scene().size;
  maker.scene().oneColour = false;
  maker.plane(maker.at(0, 0, 2.0 * z), tilted(random, 70.0));
  const int count = 1 + static_cast<int>(random.below(3));
  for (int i = 0; i < count; ++i) {
    StoredTexture texture = drawnTexture(random, true);
    const double depth = z * random.between(0.6, 1.5), half = random.between(0.7, 2.0) * widthAt(maker, depth);
    PlacedMesh& mesh = maker.place(chance(random, 0.5) ? quadSheet(half, half * random.between(0.5, 1.0))
                                                       : gridSheet(random, 3, half, 0.03 * half),
                                   maker.at(random.between(-0.4, 0.4), random.between(-0.4, 0.4), depth),
                                   facing(tilted(random, 50.0), drawnSpin(random)));
    reference::Coat& coat = mesh.coat;
    // 6 to 30 pixels a texel, so that the finest level is read throughout; even where tilted.
    const double pixels = maker.scene().numbers.eye.displayWidth * half / widthAt(maker, depth);
    const double texels = pixels / random.between(6.0, 30.0);
    const Vec2 scale = texels / Vec2(texture.width, texture.height);
    const double turn = chance(random, 0.5) ? drawnSpin(random) : 0.0, c = std::cos(turn), s = std::sin(turn);
    // KHR_texture_transform: scaled, turned, moved.
    coat.fromUv = glm::dmat3(c * scale.x, -s * scale.x, 0.0, s * scale.y, c * scale.y, 0.0, random.between(-1, 1),
                             random.between(-1, 1), 1.0);
    coat.texture = static_cast<int>(maker.scene().stored.size());
    if (cut) {
      coat.covering = reference::Covering::mask;
      coat.cutoff = random.between(0.2, 0.8);
      coat.colour.a = 1.0;
      texture.nearest = false;
    }
    maker.scene().stored.push_back(std::move(texture));
  }
}

}  // namespace pellucid::test
