// Refraction offsets against the equations, written again in double.
#include <gtest/gtest.h>

#include <glm/glm.hpp>
#include <limits>

#include "shaders/shading.h"
#include "tests/support/random.h"

namespace pellucid {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kFocal = 1037.0;  // 1080p, 55 degrees
constexpr float kSky = std::numeric_limits<float>::infinity();

shading::RefractionSettings settingsOf(int mode, float distance = 2.0f) {
  shading::RefractionSettings settings;
  settings.mode = mode;
  settings.distance = distance;
  settings.focalX = settings.focalY = static_cast<float>(kFocal);
  settings.orthographic = 0;
  return settings;
}

dvec2 project(dvec3 p) {
  return {kFocal * p.x / -p.z, -kFocal * p.y / -p.z};
}

struct Entry {
  dvec3 pView, toEye, normal;
  double eta, backgroundZ, thickness;
};

Entry randomEntry(test::Random& random) {
  Entry entry;
  const double z = random.between(0.5, 20.0);
  entry.pView = {z * random.between(-0.6, 0.6), z * random.between(-0.4, 0.4), -z};
  entry.toEye = -glm::normalize(entry.pView);
  do {
    entry.normal = glm::normalize(dvec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)));
    if (glm::dot(entry.normal, entry.toEye) < 0) entry.normal = -entry.normal;
  } while (glm::dot(entry.normal, entry.toEye) < 0.2);
  entry.eta = random.between(1.0 / 2.4, 0.999);
  entry.backgroundZ = z + random.between(0.0, 30.0);
  entry.thickness = random.between(0.0, 0.3);
  return entry;
}

// MODEL section 5, eq. 9 with its product.
dvec3 inside(const Entry& e) {
  const double c = glm::dot(e.normal, e.toEye);
  const double k = 1 - e.eta * e.eta * (1 - c * c);
  return -e.eta * e.toEye + (e.eta * c - std::sqrt(k)) * e.normal;
}

glm::vec2 offsetOf(const shading::RefractionSettings& settings, const Entry& e) {
  return shading::refractionOffset(settings, glm::vec3(e.pView), glm::vec3(e.toEye), glm::vec3(e.normal),
                                   static_cast<float>(e.eta), static_cast<float>(e.backgroundZ),
                                   static_cast<float>(e.thickness));
}

TEST(Refraction, OffsetEqualsTheEquationsInDouble) {
  test::Random random(1);
  const float distance = 2.0f;
  double worstFixed = 0, worstDepth = 0;
  int used = 0;
  while (used < 1000) {
    const Entry e = randomEntry(random);
    const dvec3 w = inside(e);
    if (-w.z < 0.1) continue;  // the stated limit on sideways rays is tested below
    ++used;
    for (const bool fixed : {true, false}) {
      const double dz = fixed ? static_cast<double>(distance) : e.backgroundZ + e.pView.z;
      const dvec2 truth = project(e.pView + w * (dz / std::abs(w.z))) - project(e.pView);
      const auto settings = settingsOf(fixed ? shading::PLD_REFRACT_FIXED : shading::PLD_REFRACT_DEPTH, distance);
      const double error = glm::length(dvec2(offsetOf(settings, e)) - truth);
      (fixed ? worstFixed : worstDepth) = std::max(fixed ? worstFixed : worstDepth, error);
    }
  }
  std::printf("refraction of 1000 random faces: largest error %.2g px (fixed), %.2g px (depth)\n", worstFixed,
              worstDepth);
  EXPECT_LE(worstFixed, 0.01);
  EXPECT_LE(worstDepth, 0.01);
}

TEST(Refraction, DirectionIsTheBuiltInRefractAndUnit) {
  test::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Entry e = randomEntry(random);
    const glm::vec3 found =
        shading::refractedDirection(glm::vec3(e.toEye), glm::vec3(e.normal), static_cast<float>(e.eta));
    EXPECT_LE(glm::length(dvec3(found) - glm::refract(-e.toEye, e.normal, e.eta)), 1e-5);
    EXPECT_NEAR(glm::length(found), 1.0, 1e-5);
  }
}

TEST(Refraction, VanishesAsEtaTendsToOne) {
  test::Random random(3);
  for (int i = 0; i < 200; ++i) {
    Entry e = randomEntry(random);
    double last = 1e9;
    for (const double step : {1e-1, 1e-2, 1e-3}) {
      e.eta = 1 - step;
      const double length = static_cast<double>(glm::length(offsetOf(settingsOf(shading::PLD_REFRACT_DEPTH), e)));
      EXPECT_LE(length, last);
      last = length;
    }
    // In first order proportional to 1 - eta, and at most focal * (1 - eta) * tan / cos of angles below 80 degrees.
    EXPECT_LE(last, kFocal * 1e-3 * 40);
    e.eta = 1;
    EXPECT_EQ(offsetOf(settingsOf(shading::PLD_REFRACT_DEPTH), e), glm::vec2(0.0f));
  }
}

// A ray through a slab leaves it parallel to itself, displaced sideways by d sin(a - b) / cos b: Snell, nothing else.
TEST(Refraction, SlabDisplacesAsPhysicsSays) {
  test::Random random(4);
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const Entry e = randomEntry(random);
    const double cosA = glm::dot(e.normal, e.toEye), sinA = std::sqrt(1 - cosA * cosA), sinB = e.eta * sinA;
    const double cosB = std::sqrt(1 - sinB * sinB);
    const double displaced = e.thickness * (sinA * cosB - cosA * sinB) / cosB;
    dvec3 sideways = -e.normal + cosA * e.toEye;
    if (sinA < 1e-6) continue;
    sideways = glm::normalize(sideways);
    // A point of the leaving ray, carried on to the background's plane.
    const dvec3 start = e.pView + sideways * displaced;
    const double backgroundZ = e.backgroundZ + 1.0;
    const dvec3 hit = start - e.toEye * ((backgroundZ + start.z) / e.toEye.z);
    Entry far = e;
    far.backgroundZ = backgroundZ;
    const dvec2 truth = project(hit) - project(e.pView);
    worst = std::max(worst, glm::length(dvec2(offsetOf(settingsOf(shading::PLD_REFRACT_THICKNESS), far)) - truth));
  }
  std::printf("refraction of 1000 slabs: largest error %.2g px\n", worst);
  EXPECT_LE(worst, 0.01);
}

TEST(Refraction, SlabDoesNotTurnTheRay) {
  Entry e;
  e.pView = {0.3, 0.2, -2};
  e.toEye = -glm::normalize(e.pView);
  e.normal = glm::normalize(dvec3(0.4, 0.1, 1));
  e.eta = 1 / 1.5;
  e.thickness = 0.1;
  e.backgroundZ = static_cast<double>(kSky);
  EXPECT_LE(glm::length(offsetOf(settingsOf(shading::PLD_REFRACT_THICKNESS), e)), 0.02f);  // parallax against 10 km
  EXPECT_GE(glm::length(offsetOf(settingsOf(shading::PLD_REFRACT_DEPTH), e)), 50.0f);
}

TEST(Refraction, TotalReflectionLetsNothingThrough) {
  const glm::vec3 toEye(0, 0, 1);
  const glm::vec3 grazing = glm::normalize(glm::vec3(1, 0, 0.3f));
  EXPECT_TRUE(shading::reflectsAll(toEye, grazing, 1.5f));
  EXPECT_FALSE(shading::reflectsAll(toEye, grazing, 1 / 1.5f));
  EXPECT_EQ(shading::refractedDirection(toEye, grazing, 1.5f), glm::vec3(0.0f));
  EXPECT_EQ(shading::refractionOffset(settingsOf(shading::PLD_REFRACT_DEPTH), glm::vec3(0, 0, -2), toEye, grazing, 1.5f,
                                      10.0f, 0.0f),
            glm::vec2(0.0f));
}

// MODEL section 12: every eta, angle, depth and mode.
TEST(Refraction, StaysFiniteAndBounded) {
  for (const int mode : {shading::PLD_REFRACT_FIXED, shading::PLD_REFRACT_DEPTH, shading::PLD_REFRACT_THICKNESS})
    for (const float z : {1e-6f, 1.0f, 1e9f})
      for (const float behind : {0.0f, 1e-6f, 10.0f, 1e9f, kSky})
        for (const float eta : {1 / 2.4f, 0.5f, 0.9999f, 1.0f, 1.5f, 2.4f})
          for (const float cosine : {0.0f, 1e-4f, 0.1f, 1.0f}) {
            const glm::vec3 normal(std::sqrt(1 - cosine * cosine), 0, cosine);
            const glm::vec2 offset = shading::refractionOffset(settingsOf(mode), glm::vec3(0, 0, -z),
                                                               glm::vec3(0, 0, 1), normal, eta, z + behind, 1.0f);
            EXPECT_TRUE(std::isfinite(offset.x + offset.y)) << z << ' ' << behind << ' ' << eta << ' ' << cosine;
            EXPECT_LE(std::abs(offset.x), shading::PLD_LARGEST_OFFSET);
          }
}

TEST(Refraction, SmokeBeforeAGlassDoesNotWeakenIt) {
  shading::Layer glass, smoke;
  glass.radiance = smoke.radiance = glm::vec3(0.1f);
  glass.coverage = 1.0f;
  glass.transmission = glm::vec3(1.0f);  // perfectly clear
  glass.z = 5.0f;
  smoke.coverage = 0.9f;
  smoke.transmission = glm::vec3(0.0f);
  smoke.z = 2.0f;
  shading::Scatter bends, plain;
  bends.offset = glm::vec2(12.5f, -3.0f);
  bends.variance = plain.variance = 0.0f;
  plain.offset = glm::vec2(0.0f);
  const shading::ScatterTargets a = shading::packScatter(glass, bends), b = shading::packScatter(smoke, plain);
  const shading::Path path =
      shading::pathOf(a.refraction + b.refraction, a.refractionZ + b.refractionZ, std::min(a.diffuseZ, b.diffuseZ));
  EXPECT_TRUE(path.refracts);
  EXPECT_FLOAT_EQ(path.offset.x, 12.5f);
  EXPECT_FLOAT_EQ(path.offset.y, -3.0f);
  EXPECT_FLOAT_EQ(path.refractionZ, 5.0f);
}

}  // namespace
}  // namespace pellucid
