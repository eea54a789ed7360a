// The kinds of scenes, one function each.
#include <algorithm>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "tests/pictures/scene_finish.h"
#include "tests/pictures/scene_parts.h"
#include "tests/pictures/scene_textured.h"

namespace pellucid::test {
namespace {

using reference::Face;

double drawnSize(Random& random) {
  return chance(random, 0.4) ? random.between(1.0, 10.0) : logBetween(random, 0.05, 5000.0);
}
// Where the line of sight through parts of the picture meets a plane.
std::optional<Vec3> onPlane(const SceneMaker& maker, double x, double y, const Vec3& point, const Vec3& normal) {
  const Vec3 from = maker.parallel() ? maker.at(x, y, 0.0) : Vec3(0.0);
  const Vec3 along = maker.parallel() ? Vec3(0, 0, -1) : maker.at(x, y, 1.0);
  const double z = glm::dot(normal, point - from) / glm::dot(normal, along);
  if (!(z > 0.0) || z > 1e3 * glm::length(point)) return std::nullopt;
  return from + z * along;
}
// Sheets on a tilted wall, and off it by little: before it whole, behind it not at all.
void decals(SceneMaker& maker, Random& random) {
  const double z = maker.scene().size;
  const Vec3 normal = tilted(random, 82.0), point = maker.at(0, 0, z);
  const int wall = maker.plane(point, normal);
  if (chance(random, 0.25)) maker.plane(maker.at(0, 0, 1.5 * z), {0, 0, 1});
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      if (chance(random, 0.3)) continue;
      const auto middle = onPlane(maker, i - 0.5, j - 0.5, point, normal);
      if (!middle) continue;
      const double half = 0.45 * widthAt(maker, -middle->z);
      const Face on{wall, 0};
      maker.placeOn(on, drawnSheet(random, half), *middle, facing(normal, drawnSpin(random)));
    }
  const int off = static_cast<int>(random.below(3));
  for (int i = 0; i < off; ++i) {
    const auto middle = onPlane(maker, random.between(-1, 1), random.between(-1, 1), point, normal);
    if (!middle) continue;
    const double by = logBetween(random, 1e-5, 1e-2) * (chance(random, 0.5) ? 1.0 : -1.0) * z;
    maker.place(drawnSheet(random, widthAt(maker, -middle->z)), *middle + by * normal,
                facing(normal, drawnSpin(random)));
  }
}

// Panes that cut a floor, and a wall.
void contact(SceneMaker& maker, Random& random) {
  const double z = maker.scene().size;
  const Vec3 normal = tilted(random, 88.0);
  maker.plane(maker.at(random.between(-0.5, 0.5), random.between(-0.5, 0.5), z), normal);
  if (chance(random, 0.4)) maker.plane(maker.at(0, 0, random.between(1.1, 2.0) * z), tilted(random, 60.0));
  const int panes = 1 + static_cast<int>(random.below(4));
  for (int i = 0; i < panes; ++i) {
    const double depth = z * random.between(0.7, 1.4);
    maker.place(drawnSheet(random, random.between(0.3, 2.0) * widthAt(maker, depth)),
                maker.at(random.between(-0.8, 0.8), random.between(-0.8, 0.8), depth), turned(random),
                chance(random, 0.3));
  }
}

// Crates and balls, panes around them, labels on them.
void shapes(SceneMaker& maker, Random& random) {
  const double z = maker.scene().size;
  if (chance(random, 0.7)) maker.plane(maker.at(0, 0, 1.6 * z), tilted(random, 50.0));
  const int things = 1 + static_cast<int>(random.below(3));
  for (int i = 0; i < things; ++i) {
    const double depth = z * random.between(0.7, 1.5), width = widthAt(maker, depth);
    const Vec3 centre = maker.at(random.between(-0.7, 0.7), random.between(-0.7, 0.7), depth);
    if (chance(random, 0.4)) {
      maker.ball(centre, width * random.between(0.2, 0.6));
      continue;
    }
    const glm::dmat3 axes = turned(random);
    const Vec3 half = width * Vec3(random.between(0.1, 0.6), random.between(0.1, 0.6), random.between(0.1, 0.6));
    const int box = maker.box(centre, axes, half);
    const int side = static_cast<int>(random.below(6)), axis = side / 2;
    if (chance(random, 0.4)) continue;
    const Vec3 out = axes[axis] * (side % 2 == 0 ? -1.0 : 1.0);
    const double least = std::min(half[(axis + 1) % 3], half[(axis + 2) % 3]);
    maker.placeOn({box, side}, drawnSheet(random, 0.7 * least), centre + half[axis] * out,
                  facing(out, drawnSpin(random)));
  }
  const int panes = 1 + static_cast<int>(random.below(5));
  for (int i = 0; i < panes; ++i) {
    const double depth = z * random.between(0.4, 1.8);
    maker.place(drawnSheet(random, random.between(0.5, 4.0) * widthAt(maker, depth)),
                maker.at(random.between(-0.8, 0.8), random.between(-0.8, 0.8), depth),
                chance(random, 0.5) ? facing(tilted(random, 60.0), drawnSpin(random)) : turned(random),
                chance(random, 0.3));
  }
}

// Posts before a wall, whose edges the picture's filter mixes, and panes before, between and behind them.
void posts(SceneMaker& maker, Random& random) {
  const double z = maker.scene().size, width = widthAt(maker, z);
  const double far = z * random.between(1.3, 4.0);
  const bool wall = chance(random, 0.75);
  if (wall) maker.plane(maker.at(0, 0, far), tilted(random, 20.0));
  const int count = 1 + static_cast<int>(random.below(2));
  for (int i = 0; i < count; ++i) {
    const Vec3 out = tilted(random, 15.0);
    maker.box(maker.at(count == 1 ? random.between(-0.4, 0.4) : i - 0.5, 0, z), facing(out, drawnSpin(random)),
              width * Vec3(random.between(0.2, 0.4), 6.0, 0.0005));
  }
  const int panes = 1 + static_cast<int>(random.below(4));
  for (int i = 0; i < panes; ++i) {
    const double depth = chance(random, 0.4) ? z * random.between(0.3, 0.8) : random.between(1.15 * z, 1.2 * far);
    maker.place(chance(random, 0.6) ? quadSheet(20.0 * widthAt(maker, depth), 20.0 * widthAt(maker, depth))
                                    : drawnSheet(random, 1.5 * widthAt(maker, depth)),
                maker.at(random.between(-0.5, 0.5), random.between(-0.5, 0.5), depth),
                facing(tilted(random, 10.0), drawnSpin(random)));
  }
}

// Needles, specks, bumps, closed shells, many layers.
void meshes(SceneMaker& maker, Random& random) {
  const double z = maker.scene().size;
  if (chance(random, 0.6)) maker.plane(maker.at(0, 0, 2.0 * z), tilted(random, 70.0));
  const int count = 1 + static_cast<int>(random.below(6));
  for (int i = 0; i < count; ++i) {
    const double depth = z * random.between(0.5, 1.8), width = widthAt(maker, depth);
    Sheet sheet;
    switch (random.below(5)) {
      case 0:
        sheet = gridSheet(random, 3 + static_cast<int>(random.below(5)), width * random.between(0.3, 1.5),
                          width * random.between(0.0, 0.3));
        break;
      case 1:
        sheet = ballSheet(4 + static_cast<int>(random.below(3)), width * random.between(0.2, 0.8));
        break;
      case 2: {  // needles about a middle
        const int needles = 30 + static_cast<int>(random.below(120));
        sheet.points.emplace_back(0.0);
        for (int k = 0; k <= needles; ++k) {
          const double angle = 2.0 * std::numbers::pi * k / needles;
          sheet.points.emplace_back(width * std::cos(angle), width * std::sin(angle), 0.0);
          if (k > 0) sheet.triangles.push_back({0, k, k + 1});
        }
        break;
      }
      case 3:  // specks
        for (int k = 0; k < 60; ++k) {
          const Vec3 middle = width * Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
          for (int c = 0; c < 3; ++c)
            sheet.points.push_back(middle + width * logBetween(random, 1e-3, 1.0) * turned(random)[0]);
          sheet.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
        }
        break;
      default:
        sheet = drawnSheet(random, 2.0 * width);
    }
    PlacedMesh& mesh = maker.place(
        sheet, maker.at(random.between(-0.6, 0.6), random.between(-0.6, 0.6), depth),
        chance(random, 0.5) ? facing(tilted(random, 70.0), drawnSpin(random)) : turned(random), chance(random, 0.3));
    if (mesh.uv.empty() && chance(random, 0.3) && !maker.scene().oneColour)
      for (std::size_t k = 0; k < mesh.points.size(); ++k)
        mesh.colours.emplace_back(random.uniformf(), random.uniformf(), random.uniformf(), random.uniformf());
  }
}

// Crates on a floor, panes and shells above them, and lamps: everything shadows what is lit.
void shadowed(SceneMaker& maker, Random& random) {
  const double z = maker.scene().size, width = widthAt(maker, z);
  const Vec3 up = glm::normalize(Vec3(0.3 * random.between(-1, 1), 1.0, random.between(0.2, 2.0)));
  maker.box(maker.at(0, -0.6, z) - 1.1 * width * up, facing(up, drawnSpin(random)), width * Vec3(12, 12, 1));
  const int crates = static_cast<int>(random.below(3));
  for (int i = 0; i < crates; ++i)
    maker.box(maker.at(random.between(-0.8, 0.8), random.between(-0.6, 0.6), z * random.between(0.8, 1.2)),
              turned(random),
              width * Vec3(random.between(0.1, 0.4), random.between(0.1, 0.4), random.between(0.1, 0.4)));
  const int panes = 2 + static_cast<int>(random.below(4));
  for (int i = 0; i < panes; ++i) {
    const double depth = z * random.between(0.5, 1.2), half = random.between(0.3, 1.2) * widthAt(maker, depth);
    const Sheet sheet = chance(random, 0.25)  ? ballSheet(4, 0.6 * half)
                        : chance(random, 0.3) ? gridSheet(random, 2, half, 0.2 * half)
                                              : drawnSheet(random, half);
    maker.place(sheet, maker.at(random.between(-0.8, 0.8), random.between(-0.6, 0.8), depth), turned(random));
  }
  if (chance(random, 0.3)) {
    textured(maker, random, chance(random, 0.5));
    maker.scene().numbers.solids.pop_back();  // its wall, which is no box
  }
  maker.scene().numbers.shadows = true;
}

// One sheet before a wall, or through it.
void single(SceneMaker& maker, Random& random) {
  const double z = maker.scene().size, depth = z * random.between(0.4, 1.1);
  maker.plane(maker.at(0, 0, z), tilted(random, 60.0));
  maker.place(drawnSheet(random, random.between(0.5, 1.5) * widthAt(maker, depth)),
              maker.at(random.between(-0.4, 0.4), random.between(-0.4, 0.4), depth),
              facing(tilted(random, 75.0), drawnSpin(random)));
}

void drawInto(const std::string& kind, SceneMaker& maker, Random& random) {
  if (kind == "decals") return decals(maker, random);
  if (kind == "contact") return contact(maker, random);
  if (kind == "shapes") return shapes(maker, random);
  if (kind == "posts") return posts(maker, random);
  if (kind == "meshes") return meshes(maker, random);
  if (kind == "textures") return textured(maker, random, false);
  if (kind == "cut-outs") return textured(maker, random, true);
  static const std::vector<std::string> any{"decals", "contact", "posts", "shapes", "meshes", "textures", "cut-outs"};
  if (kind == "far") return drawInto(any[random.below(5)], maker, random);
  if (kind == "refracting") {
    maker.keepProportions();
    maker.scene().oneLayer = chance(random, 0.25);
    if (maker.scene().oneLayer)
      single(maker, random);
    else
      drawInto(any[random.below(static_cast<std::uint32_t>(any.size()))], maker, random);
    makeRefracting(maker, random);
    if (maker.scene().oneLayer || !chance(random, 0.2)) return;
    fillAir(maker, random);
    // What lights the fog is mirrored.
    maker.scene().numbers.surroundings = maker.scene().numbers.air.light / random.between(0.3, 1.0);
    return;
  }
  if (kind == "lamps" || kind == "shadows") {
    maker.keepProportions();
    if (kind == "shadows")
      shadowed(maker, random);
    else
      drawInto(any[random.below(static_cast<std::uint32_t>(any.size()))], maker, random);
    if (chance(random, 0.3)) makeRefracting(maker, random);
    lightUp(maker, random);
    return;
  }
  if (kind != "air" && kind != "glass") throw std::invalid_argument("no kind of scene '" + kind + "'");
  drawInto(any[random.below(static_cast<std::uint32_t>(any.size()))], maker, random);
  if (kind == "glass") makeGlass(maker, random);
  if (kind == "air" || chance(random, 0.3)) fillAir(maker, random);
}

}  // namespace

const std::vector<std::string>& sceneKinds() {
  static const std::vector<std::string> kinds{"decals",     "contact",  "posts",  "shapes", "meshes",
                                              "textures",   "cut-outs", "far",    "air",    "glass",
                                              "refracting", "lamps",    "shadows"};
  return kinds;
}

DrawnScene drawScene(const std::string& kind, Random& random) {
  const double size = drawnSize(random);
  const bool far = kind == "far" || (kind == "refracting" && chance(random, 0.2));
  SceneMaker maker(kind, random, size, far ? logBetween(random, 1e3, 1e7) : 0.0);
  drawInto(kind, maker, random);
  return maker.finish();
}

}  // namespace pellucid::test
