// An engine as a draughtsman shows it: every part partly covering, closely packed. PT17 fig. 20.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "samples/cad/machine_parts.h"
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

// Four cylinders in line along x; the crankshaft turns about y = kCrank. Metres.
constexpr double kBore = 0.04, kPitch = 0.1, kCrank = 0.1, kThrow = 0.038, kRod = 0.12, kDeck = 0.3;
constexpr double kPhase[] = {0.35, 0.35 + glm::pi<double>(), 0.35 + glm::pi<double>(), 0.35};

double cylinderX(int i) {
  return kPitch * (i - 1.5);
}
glm::dvec3 crankPin(int i) {
  return {cylinderX(i), kCrank + kThrow * std::cos(kPhase[i]), kThrow * std::sin(kPhase[i])};
}
double wristPinY(int i) {
  const glm::dvec3 pin = crankPin(i);
  return pin.y + std::sqrt(kRod * kRod - pin.z * pin.z);
}

class Engine {
 public:
  explicit Engine(Glb& glb) : glb_(glb) {}
  // One material and one mesh for all parts of a kind.
  void part(const char* name, glm::dvec3 colour, double coverage, const Mesh& mesh, double metallic = 0.0) {
    const int material = glb_.addMaterial({{"name", name},
                                           {"alphaMode", "BLEND"},
                                           {"doubleSided", true},
                                           {"pbrMetallicRoughness",
                                            {{"baseColorFactor", {colour.r, colour.g, colour.b, coverage}},
                                             {"metallicFactor", metallic},
                                             {"roughnessFactor", 0.45}}}});
    glb_.addMesh(name, mesh, material);
  }

 private:
  Glb& glb_;
};

Mesh crankshaft() {
  Mesh mesh;
  for (int i = 0; i <= 4; ++i) add(mesh, cylinderOf(0.02, 0.014), moved({kPitch * (i - 2), kCrank, 0.0}) * alongX());
  for (int i = 0; i < 4; ++i) {
    add(mesh, cylinderOf(0.016, 0.014), moved(crankPin(i)) * alongX());
    // Webs: a bar from the journal to the pin, a counterweight on the other side.
    for (const double side : {-0.025, 0.025}) {
      const glm::dmat4 place = moved({cylinderX(i) + side, kCrank, 0.0}) * turnedX(kPhase[i]);
      add(mesh, boxOf({0.006, 0.032, 0.02}), place * moved({0.0, 0.018, 0.0}));
      add(mesh, boxOf({0.006, 0.022, 0.036}), place * moved({0.0, -0.03, 0.0}));
    }
  }
  add(mesh, cylinderOf(0.017, 0.04), moved({-0.25, kCrank, 0.0}) * alongX());
  add(mesh, cylinderOf(0.022, 0.015), moved({0.225, kCrank, 0.0}) * alongX());
  return mesh;
}

Mesh pistons() {
  Mesh mesh;
  for (int i = 0; i < 4; ++i) {
    const glm::dmat4 place = moved({cylinderX(i), wristPinY(i), 0.0});
    add(mesh,
        lathe({{0.0, 0.03}, {0.02, 0.03}, {0.038, 0.029}, {0.0385, 0.02}, {0.0385, 0.0}, {0.0385, -0.026}}, 3, 36),
        place);
    for (const double y : {0.023, 0.017, 0.011}) add(mesh, ring(0.036, 0.0396, 0.0016), place * moved({0.0, y, 0.0}));
    add(mesh, cylinderOf(0.009, 0.03), place * alongX());
  }
  return mesh;
}

Mesh rods() {
  Mesh mesh;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3 low = crankPin(i), high(cylinderX(i), wristPinY(i), 0.0);
    const glm::dmat4 lean = turnedX(std::atan2(high.z - low.z, high.y - low.y));
    add(mesh, ring(0.017, 0.027, 0.011), moved(low) * alongX());
    add(mesh, ring(0.0095, 0.016, 0.01), moved(high) * alongX());
    add(mesh, boxOf({0.006, 0.5 * kRod - 0.02, 0.009}), moved(0.5 * (low + high)) * lean);
  }
  return mesh;
}

Mesh liners() {
  Mesh mesh;
  for (int i = 0; i < 4; ++i) add(mesh, ring(kBore, kBore + 0.005, 0.06), moved({cylinderX(i), kDeck - 0.06, 0.0}));
  return mesh;
}

// Valves under their springs, two rows of eight.
void valveTrain(Engine& engine) {
  Mesh valves, springs, shafts;
  for (const double row : {-1.0, 1.0}) {
    add(shafts, cylinderOf(0.01, 0.215), moved({0.0, kDeck + 0.095, 0.03 * row}) * alongX());
    for (int i = 0; i < 4; ++i)
      for (const double aside : {-0.021, 0.021}) {
        const double x = cylinderX(i) + aside, lift = (i + (row > 0.0 ? 1 : 0)) % 4 == 1 ? 0.008 : 0.0;
        const glm::dmat4 place = moved({x, kDeck + 0.004 - lift, 0.022 * row}) * turnedX(0.16 * row);
        add(valves,
            lathe({{0.0, 0.0}, {0.014, 0.001}, {0.0145, 0.004}, {0.005, 0.01}, {0.003, 0.02}, {0.003, 0.075}}, 3, 24),
            place);
        add(springs, spring(0.0095, 0.0017, 0.034, 6), place * moved({0.0, 0.038, 0.0}));
        // A cam: round, with a nose that presses where the valve is open.
        const glm::dmat4 cam = moved({x, kDeck + 0.095, 0.03 * row}) * turnedX(lift > 0.0 ? 0.0 : 2.0 + 1.1 * i);
        add(shafts, cylinderOf(0.014, 0.006), cam * alongX());
        add(shafts, boxOf({0.006, 0.009, 0.008}), cam * moved({0.0, -0.014, 0.0}));
      }
  }
  engine.part("valves", {0.85, 0.36, 0.04}, 0.65, valves);
  engine.part("springs", {0.9, 0.7, 0.03}, 0.75, springs);
  engine.part("camshafts", {0.12, 0.36, 0.75}, 0.55, shafts);
}

void housing(Engine& engine) {
  Mesh block, head, pan, bolts;
  // Walls, not a solid: what is drawn is the skin.
  add(block, boxOf({0.215, 0.08, 0.068}), moved({0.0, kDeck - 0.08, 0.0}));
  add(block, boxOf({0.215, 0.055, 0.09}), moved({0.0, kCrank + 0.025, 0.0}));
  for (int i = 0; i <= 4; ++i) add(block, boxOf({0.007, 0.05, 0.082}), moved({kPitch * (i - 2), kCrank + 0.025, 0.0}));
  add(head, boxOf({0.215, 0.032, 0.075}), moved({0.0, kDeck + 0.034, 0.0}));
  add(head, prism({{-0.215, 0.062}, {0.215, 0.062}, {0.215, -0.062}, {-0.215, -0.062}}, 0.028),
      moved({0.0, kDeck + 0.098, 0.0}));
  add(pan, prism({{-0.21, 0.085}, {0.21, 0.085}, {0.21, -0.085}, {-0.21, -0.085}}, 0.022),
      moved({0.0, kCrank - 0.055, 0.0}));
  add(pan, boxOf({0.1, 0.02, 0.075}), moved({0.08, kCrank - 0.095, 0.0}));
  const std::vector<glm::dvec2> hexagon = {{0.0075, 0.0},  {0.00375, -0.0065}, {-0.00375, -0.0065},
                                           {-0.0075, 0.0}, {-0.00375, 0.0065}, {0.00375, 0.0065}};
  for (int i = 0; i <= 8; ++i)
    for (const double z : {-0.068, 0.068}) {
      add(bolts, prism(hexagon, 0.004), moved({0.05 * (i - 4), kDeck + 0.07, z}));
      add(bolts, prism(hexagon, 0.004), moved({0.05 * (i - 4), kCrank - 0.03, 1.12 * z}));
    }
  engine.part("block", {0.5, 0.56, 0.62}, 0.22, block);
  engine.part("head", {0.08, 0.5, 0.4}, 0.22, head);
  engine.part("oil pan", {0.2, 0.24, 0.42}, 0.3, pan);
  engine.part("bolts", {0.75, 0.75, 0.78}, 0.75, bolts);
}

void pipes(Engine& engine) {
  Mesh intake, exhaust;
  for (int i = 0; i < 4; ++i) {
    const double x = cylinderX(i);
    add(intake, tube(curve({{x, kDeck + 0.03, -0.07},
                            {x, kDeck + 0.05, -0.11},
                            {x, kDeck + 0.11, -0.15},
                            {x, kDeck + 0.12, -0.19}},
                           8),
                     0.018));
    add(exhaust, tube(curve({{x, kDeck + 0.025, 0.07},
                             {x, kDeck + 0.02, 0.105},
                             {0.7 * x + 0.03, kDeck - 0.06, 0.13},
                             {0.25 * x + 0.06, kDeck - 0.16, 0.135}},
                            10),
                      0.016));
  }
  add(intake, cylinderOf(0.034, 0.2), moved({0.0, kDeck + 0.125, -0.21}) * alongX());
  add(exhaust, tube(curve({{0.06, kDeck - 0.15, 0.135},
                           {0.07, kDeck - 0.22, 0.14},
                           {0.13, kDeck - 0.28, 0.15},
                           {0.27, kDeck - 0.29, 0.15}},
                          10),
                    0.026));
  engine.part("intake", {0.06, 0.22, 0.75}, 0.35, intake);
  engine.part("exhaust", {0.8, 0.12, 0.04}, 0.42, exhaust);
}

void drive(Engine& engine) {
  Mesh flywheel, gears, belt, fan;
  add(flywheel, gear(64, 0.105, 0.113, 0.009), moved({0.248, kCrank, 0.0}) * alongX());
  add(flywheel, ring(0.04, 0.085, 0.013), moved({0.262, kCrank, 0.0}) * alongX());
  add(gears, gear(20, 0.03, 0.036, 0.008), moved({-0.235, kCrank, 0.0}) * alongX());
  for (const double z : {-0.03, 0.03})
    add(gears, gear(40, 0.046, 0.05, 0.006), moved({z < 0.0 ? -0.235 : -0.249, kDeck + 0.095, z}) * alongX());
  for (const glm::dvec2 idle : {glm::dvec2(0.2, -0.04), {0.21, 0.05}})
    add(gears, gear(18, 0.026, 0.031, 0.008), moved({-0.235, idle.x, idle.y}) * alongX());
  add(gears, ring(0.03, 0.058, 0.012), moved({-0.275, kCrank, 0.0}) * alongX());
  add(gears, ring(0.012, 0.032, 0.012), moved({-0.275, 0.21, 0.125}) * alongX());
  add(gears, ring(0.015, 0.042, 0.012), moved({-0.275, 0.26, -0.02}) * alongX());
  // The belt round the three pulleys.
  add(belt, tube(curve({{-0.275, kCrank - 0.06, 0.005},
                        {-0.275, kCrank - 0.02, 0.058},
                        {-0.275, 0.2, 0.158},
                        {-0.275, 0.235, 0.145},
                        {-0.275, 0.3, 0.0},
                        {-0.275, 0.29, -0.055},
                        {-0.275, 0.2, -0.064},
                        {-0.275, kCrank, -0.062},
                        {-0.275, kCrank - 0.06, 0.005}},
                       8),
                 0.006));
  Mesh alternator;
  add(alternator, cylinderOf(0.045, 0.05), moved({-0.2, 0.21, 0.125}) * alongX());
  for (int i = 0; i < 6; ++i)
    add(alternator, ring(0.045, 0.05, 0.003), moved({-0.238 + 0.015 * i, 0.21, 0.125}) * alongX());
  add(alternator, cylinderOf(0.034, 0.045), moved({0.05, 0.16, 0.14}) * alongZ());
  for (int i = 0; i < 7; ++i)
    add(fan, boxOf({0.002, 0.045, 0.018}),
        moved({-0.31, 0.26, -0.02}) * turnedX(glm::two_pi<double>() * i / 7.0) * moved({0.0, 0.065, 0.0}) *
            glm::dmat4(
                glm::dmat3(std::cos(0.5), 0.0, -std::sin(0.5), 0.0, 1.0, 0.0, std::sin(0.5), 0.0, std::cos(0.5))));
  add(fan, cylinderOf(0.025, 0.014), moved({-0.305, 0.26, -0.02}) * alongX());
  engine.part("flywheel", {0.36, 0.16, 0.6}, 0.45, flywheel);
  engine.part("gears", {0.7, 0.5, 0.1}, 0.5, gears);
  engine.part("belt", {0.12, 0.12, 0.14}, 0.7, belt);
  engine.part("alternator", {0.14, 0.6, 0.12}, 0.42, alternator);
  engine.part("fan", {0.75, 0.2, 0.42}, 0.42, fan);
}

}  // namespace

Sample cad() {
  Sample sample;
  sample.view.eye = {-0.68, 0.66, 0.98};
  sample.view.target = {-0.02, 0.225, 0.0};
  sample.view.yfov = 0.42;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-0.25, 0.9, 0.6));
  studio.sunIrradiance = {2.4, 2.35, 2.3};
  studio.ambient = {0.3, 0.32, 0.35};
  studio.ambientReach = 0.3;
  const Albedo sheet = [](glm::dvec3 p) {  // a drawing sheet with a grid of 5 cm
    const auto line = [](double v) { return std::abs(std::remainder(v, 0.05)) < 0.0011; };
    return line(p.x) || line(p.z) ? glm::dvec3(0.16, 0.24, 0.36) : glm::dvec3(0.07, 0.11, 0.19);
  };
  studio.shapes = {{ShapeKind::box, {0.0, -0.06, 0.0}, {3.0, 0.05, 3.0}, 0.0, sheet}};
  studio.sky = [](glm::dvec3) { return glm::dvec3(0.08, 0.12, 0.2); };

  Engine engine(sample.glb);
  housing(engine);
  engine.part("liners", {0.6, 0.75, 0.8}, 0.28, liners());
  engine.part("pistons", {0.82, 0.84, 0.9}, 0.55, pistons());
  engine.part("connecting rods", {0.85, 0.42, 0.06}, 0.6, rods());
  engine.part("crankshaft", {0.7, 0.05, 0.07}, 0.6, crankshaft());
  valveTrain(engine);
  pipes(engine);
  drive(engine);
  sample.glb.addCamera("cam", sample.view);
  sample.glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
