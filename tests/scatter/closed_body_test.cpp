// Light through balls and boxes of glass, bent at both faces, against the law of refraction written again in double.
#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "shaders/closed_body_text.h"
#include "tests/gl/builder.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

constexpr double kFocalPixels = 1037.0;  // 1080p, 55 degrees

shading::RefractionSettings depthSettings(double focal = kFocalPixels) {
  shading::RefractionSettings settings;
  settings.mode = shading::PLD_REFRACT_DEPTH;
  settings.distance = 2.0f;
  settings.focalX = settings.focalY = static_cast<float>(focal);
  settings.orthographic = 0;
  return settings;
}

// A stretched and turned body before the eye.
glm::dmat4 drawnBody(Random& random, double z) {
  glm::dmat4 viewFromBody =
      glm::translate(glm::dmat4(1.0), dvec3(z * random.between(-0.4, 0.4), z * random.between(-0.3, 0.3), -z));
  const dvec3 axis = glm::normalize(dvec3(random.between(-1, 1), random.between(-1, 1), random.between(0.1, 1)));
  viewFromBody = glm::rotate(viewFromBody, random.between(0.0, 6.0), axis);
  const auto half = [&] { return z * random.between(0.02, 0.2); };
  const double x = half(), y = half();
  return glm::scale(viewFromBody, dvec3(x, y, half()));
}

// Where a line meets the unit ball or [-1,1]^3: how far along it enters and leaves.
std::optional<dvec2> crossing(int kind, const dvec3& from, const dvec3& along) {
  if (kind == shading::PLD_BODY_BALL) {
    const double a = glm::dot(along, along), b = glm::dot(from, along), c = glm::dot(from, from) - 1.0;
    const double root = b * b - a * c;
    if (root <= 0.0) return std::nullopt;
    return dvec2(-b - std::sqrt(root), -b + std::sqrt(root)) / a;
  }
  dvec2 span(-1e300, 1e300);
  for (int k = 0; k < 3; ++k) {
    const double one = (-1.0 - from[k]) / along[k], two = (1.0 - from[k]) / along[k];
    span = {std::max(span.x, std::min(one, two)), std::min(span.y, std::max(one, two))};
  }
  if (span.x >= span.y) return std::nullopt;
  return span;
}

dvec3 outwards(int kind, const glm::dmat4& bodyFromView, const dvec3& point) {
  dvec3 gradient = dvec3(bodyFromView * dvec4(point, 1.0));
  if (kind == shading::PLD_BODY_BOX) {
    int most = 0;
    for (int k = 1; k < 3; ++k)
      if (std::abs(gradient[k]) > std::abs(gradient[most])) most = k;
    const double side = gradient[most] > 0.0 ? 1.0 : -1.0;
    gradient = dvec3(0.0);
    gradient[most] = side;
  }
  return glm::normalize(glm::transpose(glm::dmat3(bodyFromView)) * gradient);
}

struct Bent {
  dvec3 enters, normal;
  dvec2 offset;
  bool smooth = true;  // away from grazing, from edges and from what is reflected inside
};

std::optional<Bent> bend(int kind, const glm::dmat4& viewFromBody, const dvec3& direction, double eta,
                         double backgroundZ) {
  const glm::dmat4 bodyFromView = glm::inverse(viewFromBody);
  const auto within = [&](const dvec3& from, const dvec3& along) {
    return crossing(kind, dvec3(bodyFromView * dvec4(from, 1.0)), dvec3(bodyFromView * dvec4(along, 0.0)));
  };
  const auto met = within(dvec3(0.0), direction);
  if (!met || met->x <= 0.0) return std::nullopt;
  Bent bent;
  bent.enters = met->x * direction;
  bent.normal = outwards(kind, bodyFromView, bent.enters);
  const dvec3 inside = glm::refract(direction, bent.normal, eta);
  const auto left = within(bent.enters, inside);
  if (!left) return std::nullopt;
  const dvec3 leaves = bent.enters + left->y * inside, normal = outwards(kind, bodyFromView, leaves);
  const dvec3 beyond = glm::refract(inside, -normal, 1.0 / eta);
  const dvec3 reached = leaves + beyond * ((backgroundZ + leaves.z) / -beyond.z);
  const auto project = [](const dvec3& p) { return dvec2(p.x, -p.y) * (kFocalPixels / -p.z); };
  bent.offset = project(reached) - project(bent.enters);
  bent.smooth = glm::dot(beyond, beyond) > 0.5 && -beyond.z > 0.3 && glm::dot(-direction, bent.normal) > 0.2 &&
                glm::dot(inside, normal) > 0.2 && left->y > 1e-3 * glm::length(bent.enters);
  if (kind == shading::PLD_BODY_BOX) {
    dvec3 at = glm::abs(dvec3(bodyFromView * dvec4(leaves, 1.0)));
    if (at.x > at.y) std::swap(at.x, at.y);
    if (at.y > at.z) std::swap(at.y, at.z);
    bent.smooth = bent.smooth && at.y < 0.999;
  }
  return bent;
}

TEST(ClosedBody, BallsAndBoxesBendAsTheLawOfRefractionSays) {
  Random random(7);
  for (const int kind : {shading::PLD_BODY_BALL, shading::PLD_BODY_BOX}) {
    double worst = 0.0, largest = 0.0;
    int used = 0;
    while (used < 2000) {
      const double z = random.between(0.5, 20.0), backgroundZ = z * random.between(1.5, 6.0);
      const glm::dmat4 viewFromBody = drawnBody(random, z);
      const dvec3 aim = dvec3(viewFromBody * dvec4(random.between(-0.9, 0.9), random.between(-0.9, 0.9), 0.0, 1.0));
      const dvec3 direction = glm::normalize(aim);
      const double eta = random.between(1.0 / 2.0, 0.95);
      const auto bent = bend(kind, viewFromBody, direction, eta, backgroundZ);
      if (!bent || !bent->smooth) continue;
      ++used;
      const shading::ClosedBody body{kind, glm::mat4(glm::inverse(viewFromBody))};
      const glm::vec2 found =
          shading::bodyOffset(depthSettings(), body, glm::vec3(bent->enters), glm::vec3(-direction),
                              glm::vec3(bent->normal), static_cast<float>(eta), static_cast<float>(backgroundZ));
      worst = std::max(worst, glm::length(dvec2(found) - bent->offset) / (1.0 + glm::length(bent->offset)));
      largest = std::max(largest, glm::length(bent->offset));
    }
    std::printf("%s: 2000 rays, offsets up to %.0f px, largest error %.2g px and of the offset\n",
                kind == shading::PLD_BODY_BALL ? "balls" : "boxes", largest, worst);
    // Floats hold a place on the body to 1e-6 of its distance, and two faces magnify that.
    EXPECT_LE(worst, 1e-3);
    EXPECT_GT(largest, 200.0);
  }
}

// A slab is the refraction that a stated thickness has had all along.
TEST(ClosedBody, SlabIsTheThicknessModeOfItsThickness) {
  const double thickness = 0.05;
  const glm::dmat4 viewFromBody =
      glm::scale(glm::translate(glm::dmat4(1.0), dvec3(0, 0, -3)), dvec3(2.0, 2.0, 0.5 * thickness));
  const shading::ClosedBody body{shading::PLD_BODY_BOX, glm::mat4(glm::inverse(viewFromBody))};
  shading::RefractionSettings stated = depthSettings();
  stated.mode = shading::PLD_REFRACT_THICKNESS;
  for (const double x : {-1.0, -0.2, 0.0, 0.7})
    for (const double y : {-0.6, 0.3}) {
      const glm::vec3 enters(static_cast<float>(x), static_cast<float>(y), static_cast<float>(-3.0 + 0.5 * thickness));
      const glm::vec3 toEye = -glm::normalize(enters), normal(0, 0, 1);
      const glm::vec2 found = shading::bodyOffset(depthSettings(), body, enters, toEye, normal, 1 / 1.5f, 7.0f);
      const glm::vec2 right =
          shading::refractionOffset(stated, enters, toEye, normal, 1 / 1.5f, 7.0f, static_cast<float>(thickness));
      EXPECT_LE(glm::length(found - right), 0.01f);
    }
}

TEST(ClosedBody, StaysFiniteAndBounded) {
  for (const int kind : {shading::PLD_BODY_BALL, shading::PLD_BODY_BOX})
    for (const float size : {1e-30f, 1e-6f, 1.0f, 1e9f, 1e30f})
      for (const float behind : {0.0f, 10.0f, 1e9f, std::numeric_limits<float>::infinity()})
        for (const float eta : {1 / 2.4f, 0.9999f, 1.0f, 1.5f, 2.4f})
          for (const float cosine : {0.0f, 1e-4f, 0.5f, 1.0f}) {
            const glm::vec3 normal(std::sqrt(1 - cosine * cosine), 0, cosine);
            const shading::ClosedBody body{kind, glm::mat4(1.0f / size)};
            const glm::vec2 offset = shading::bodyOffset(depthSettings(), body, glm::vec3(0, 0, -size),
                                                         glm::vec3(0, 0, 1), normal, eta, behind);
            EXPECT_TRUE(std::isfinite(offset.x + offset.y)) << size << ' ' << behind << ' ' << eta << ' ' << cosine;
            EXPECT_LE(std::abs(offset.x), shading::PLD_LARGEST_OFFSET);
          }
}

Primitive ballMesh(int rings, int material) {
  Primitive ball;
  ball.material = material;
  const int around = 2 * rings;
  for (int j = 0; j <= rings; ++j)
    for (int i = 0; i < around; ++i) {
      const double up = glm::pi<double>() * j / rings, turn = glm::pi<double>() * i / rings;
      Vertex vertex{};
      vertex.position = vertex.normal =
          glm::vec3(std::sin(up) * std::cos(turn), std::cos(up), -std::sin(up) * std::sin(turn));
      vertex.colour = glm::vec4(1.0f);
      ball.vertices.push_back(vertex);
    }
  const auto index = [&](int j, int i) { return static_cast<std::uint32_t>(j * around + i % around); };
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < around; ++i)
      for (const std::uint32_t corner :
           {index(j, i), index(j + 1, i), index(j + 1, i + 1), index(j, i), index(j + 1, i + 1), index(j, i + 1)})
        ball.indices.push_back(corner);
  return ball;
}

// Through the pass: every pixel of a fine ball has the offset of its ray through a smooth one.
TEST(ClosedBody, ThePassBendsAsTheClosedForm) {
  constexpr int kWidth = 96, kHeight = 64;
  Stage stage(kWidth, kHeight);
  stage.gbuffer.viewZ = Image<float>(kWidth, kHeight, 9.0f);
  Material glass;
  glass.name = "glass";
  glass.transmission = 1.0f;
  glass.metallic = glass.roughness = 0.0f;
  glass.thin = false;
  Primitive ball = ballMesh(96, stage.add(glass));
  ball.body = SolidBody{shading::PLD_BODY_BALL, glm::dmat4(1.0)};
  const double z = 4.0, radius = 0.6;
  stage.place(std::move(ball)).worldFromObject =
      glm::scale(glm::translate(glm::dmat4(1.0), dvec3(0.1, -0.05, -z)), dvec3(radius));
  PassSettings settings;
  const OitPlanes planes = stage.accumulate(settings);
  const glm::dmat4 viewFromBody = glm::scale(glm::translate(glm::dmat4(1.0), dvec3(0.1, -0.05, -z)), dvec3(radius));
  const double focal = stage.camera.focal.x * 0.5 * kWidth;
  double worst = 0.0;
  int pixels = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const glm::vec4 sum = planes.refraction.at(x, y);
      if (!(sum.z > 0.0f)) continue;
      const dvec3 direction =
          glm::normalize(dvec3((x + 0.5 - 0.5 * kWidth) / focal, -(y + 0.5 - 0.5 * kHeight) / focal, -1.0));
      const auto bent = bend(shading::PLD_BODY_BALL, viewFromBody, direction, 1 / 1.5, 9.0);
      if (!bent || !bent->smooth) continue;
      const dvec2 right = bent->offset * (focal / kFocalPixels),
                  found = dvec2(sum.x, sum.y) / static_cast<double>(sum.z);
      worst = std::max(worst, glm::length(found - right) / (1.0 + glm::length(right)));
      ++pixels;
    }
  std::printf("a ball of 96 rings, %d pixels: largest error %.2g px and of the offset\n", pixels, worst);
  EXPECT_GT(pixels, 150);
  EXPECT_LE(worst, 0.01);  // facets lie up to half a thousandth of the radius within the ball
}

}  // namespace
}  // namespace pellucid::test
