// Light and openness against closed forms.
#include "engine_bridge/embree/point_lighting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine_bridge/embree/opaque_render.h"
#include "tests/gl/builder.h"

namespace pellucid::rays {
namespace {

constexpr float kAlbedo = 0.6f;

Material lambert() {
  Material material;
  material.name = "lambert";
  material.doubleSided = true;
  material.baseColor = glm::vec4(kAlbedo, kAlbedo, kAlbedo, 1.0f);
  material.metallic = 0.0f;
  material.ior = 1.0f;  // reflects nothing specularly
  return material;
}

// Part of a sphere of radius 1 about the origin, around +z: polar angles to `polar`, azimuths to `azimuth`.
Primitive dome(double polar, double azimuth) {
  constexpr int rings = 64, steps = 128;
  Primitive primitive;
  const auto vertex = [&](int ring, int step) {
    const double theta = polar * ring / rings, phi = azimuth * step / steps;
    Vertex v{};
    v.position = {static_cast<float>(std::sin(theta) * std::cos(phi)),
                  static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta))};
    v.normal = v.position;
    v.colour = glm::vec4(1.0f);
    primitive.vertices.push_back(v);
  };
  for (int ring = 0; ring <= rings; ++ring)
    for (int step = 0; step <= steps; ++step) vertex(ring, step);
  for (std::uint32_t ring = 0; ring < rings; ++ring)
    for (std::uint32_t step = 0; step < steps; ++step) {
      const std::uint32_t a = ring * (steps + 1) + step, b = a + 1, c = a + steps + 1, d = c + 1;
      for (const std::uint32_t i : {a, c, b, b, c, d}) primitive.indices.push_back(i);
    }
  return primitive;
}

// Looks up along +z.
ShadePoint pointAt(glm::vec3 position) {
  ShadePoint point;
  point.position = position;
  point.normal = point.flat = point.toEye = {0, 0, 1};
  shading::MaterialPoint values{};
  values.specular = glm::vec4(1.0f);
  values.base = glm::vec4(kAlbedo, kAlbedo, kAlbedo, 1.0f);
  values.emission = glm::vec3(0.0f);
  values.metallic = values.transmission = 0.0f;
  values.roughness = 0.5f;
  values.ior = 1.0f;
  point.surface = shading::surfaceOf(values, 1.0f, glm::vec3(1.0f), false);
  return point;
}

struct Dome {
  Scene scene;
  Dome(double polar, double azimuth) {
    scene.materials.push_back(lambert());
    scene.primitives.push_back(dome(polar, azimuth));
    scene.instances.push_back({});
  }
};

// Points in the middle see a dome's half, or what a cap leaves: 1 - sin^2(polar).
TEST(Openness, HalfDomeAndCaps) {
  const struct {
    double polar, azimuth, open;
  } cases[] = {{M_PI / 2, M_PI, 0.5}, {M_PI / 2, 2 * M_PI, 0.0}, {M_PI / 4, 2 * M_PI, 0.5}, {M_PI / 6, 2 * M_PI, 0.75}};
  for (const auto& one : cases) {
    const Dome dome(one.polar, one.azimuth);
    const OpaqueScene traced(dome.scene, Camera{});
    const Environment black;
    const Lighting lighting(traced, black, Camera{}, true);
    double sum = 0, worst = 0;
    constexpr int seeds = 64, rays = 256;
    for (std::uint32_t seed = 0; seed < seeds; ++seed) {
      const double open =
          static_cast<double>(lighting.openness(pointAt(glm::vec3(0.0f)), 2.0f, rays, shading::hashOf(seed)));
      sum += open / seeds;
      worst = std::max(worst, std::abs(open - one.open));
    }
    std::printf("openness %.4f, closed form %.4f, worst of %d pixels with %d rays %.4f\n", sum, one.open, seeds, rays,
                worst);
    // 128 steps leave 2e-4 of the rim open; 64 * 256 stratified rays scatter by less than 1e-3.
    EXPECT_NEAR(sum, one.open, 1.5e-3);
    EXPECT_LE(worst, 0.03);
    // Beyond the reach nothing hides anything.
    EXPECT_EQ(lighting.openness(pointAt(glm::vec3(0.0f)), 0.5f, 64, 1), 1.0f);
  }
}

TEST(Surroundings, ConstantOverLambertIsAlbedoTimesOpenness) {
  const Dome dome(M_PI / 2, M_PI);
  const OpaqueScene traced(dome.scene, Camera{});
  const Environment sky(glm::vec3(2.0f));
  for (const bool shadows : {false, true}) {
    const Lighting lighting(traced, sky, Camera{}, shadows);
    const glm::vec3 light = lighting.surroundings(pointAt(glm::vec3(0.0f)), 4096, 0, 11);
    const double expected = 2.0 * static_cast<double>(kAlbedo) * (shadows ? 0.5 : 1.0);
    std::printf("constant surroundings: %.5f, closed form %.5f\n", static_cast<double>(light.r), expected);
    EXPECT_NEAR(static_cast<double>(light.r), expected, shadows ? 2e-3 : 1e-6);
  }
}

// L = max(cos, 0)^n about an axis; a plane that faces the axis has irradiance 2 pi / (n + 2).
TEST(Surroundings, OneLobeMap) {
  const Dome nothing(1e-3, 1e-3);
  const OpaqueScene traced(nothing.scene, Camera{});
  for (const int power : {1, 8, 100})
    for (const glm::vec3 axis : {glm::vec3(0, 1, 0), glm::vec3(1, 0, 0), glm::vec3(0, 0, -1)}) {
      Image<glm::vec3> map(512, 256);
      for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) {
          const glm::vec2 uv((static_cast<float>(x) + 0.5f) / 512.0f, (static_cast<float>(y) + 0.5f) / 256.0f);
          const float cosine = std::max(glm::dot(shading::directionOfLatLong(uv), axis), 0.0f);
          map.at(x, y) = glm::vec3(std::pow(cosine, static_cast<float>(power)));
        }
      const Environment environment(std::move(map));
      const Lighting lighting(traced, environment, Camera{}, true);  // view is world
      ShadePoint point = pointAt(glm::vec3(0, 0, -5));
      point.normal = point.flat = point.toEye = axis;
      const double expected = static_cast<double>(kAlbedo) * 2.0 / (power + 2);
      const double found = static_cast<double>(lighting.surroundings(point, 4096, 0, 5).r);
      point.normal = point.flat = point.toEye = -axis;
      const double behind = static_cast<double>(lighting.surroundings(point, 256, 0, 5).r);
      std::printf("lobe %3d: %.5f, closed form %.5f\n", power, found, expected);
      EXPECT_NEAR(found, expected, 3e-3 * expected);  // 4096 directions, and texels of 0.7 degrees
      EXPECT_LE(behind, 1e-3 * expected);
    }
}

// E = I cos / d^2: the light of a point source on a plane, at every pixel, through the whole renderer.
TEST(Direct, PointLightOverAPlane) {
  test::Stage stage(64, 64);
  const int material = stage.add(lambert());
  stage.quad(-64, -64, 128, 128, 4.0, material);
  Light light;
  light.name = "lamp";
  light.kind = LightKind::point;
  light.intensity = 10.0f;
  light.position = {0.5, 0.25, -2.0};
  stage.scene.lights.push_back(light);
  for (const bool shadows : {false, true}) {
    OpaqueRenderSettings settings;
    settings.samples = 1;
    settings.shadows = shadows;
    settings.aoRadius = 0.0f;
    const OpaquePlanes planes =
        renderOpaque(stage.scene, stage.camera, stage.gbuffer.display, stage.gbuffer.data, Environment{}, settings);
    ASSERT_EQ(planes.lights.size(), 1u);
    EXPECT_TRUE(planes.occlusion.empty() && planes.indirect.empty() && planes.emission.empty());
    double worst = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const glm::dvec3 p(stage.at(x + 0.5, y + 0.5, 4.0));
        const glm::dvec3 path = glm::dvec3(0.5, 0.25, -2.0) - p;
        const double expected = static_cast<double>(kAlbedo) / M_PI * 10.0 * path.z / std::pow(glm::length(path), 3);
        const double found = static_cast<double>(planes.beauty.at(x, y).r);
        worst = std::max(worst, std::abs(found - expected) / expected);
        EXPECT_NEAR(static_cast<double>(planes.viewZ.at(x, y)), 4.0, 1e-6);
        EXPECT_EQ(planes.beauty.at(x, y).a, 1.0f);
      }
    std::printf("point light over a plane: worst relative error %.2g\n", worst);
    EXPECT_LE(worst, 5e-6);
  }
}

// A square board halfway between lamp and plane: its shadow is twice its size, with edges where geometry says.
TEST(Direct, ShadowOfABoard) {
  test::Stage stage(64, 64);
  const int material = stage.add(lambert());
  stage.quad(-64, -64, 128, 128, 4.0, material);
  // Not seen by the camera: it is behind it. Lamp at z = +4, board at z = 0, plane at z = -4.
  Light lamp;
  lamp.kind = LightKind::point;
  lamp.intensity = 100.0f;
  lamp.position = {0.0, 0.0, 4.0};
  stage.scene.lights.push_back(lamp);
  Primitive board;
  for (const glm::vec2 corner :
       {glm::vec2(-0.25f, -0.25f), glm::vec2(0.25f, -0.25f), glm::vec2(0.25f, 0.25f), glm::vec2(-0.25f, 0.25f)}) {
    Vertex vertex{};
    vertex.position = {corner.x, corner.y, 1e-3f};
    vertex.normal = {0, 0, 1};
    vertex.colour = glm::vec4(1.0f);
    board.vertices.push_back(vertex);
  }
  board.indices = {0, 1, 2, 0, 2, 3};
  board.material = material;
  stage.place(board);
  OpaqueRenderSettings settings;
  settings.samples = 1;
  settings.aoRadius = 0.0f;
  const OpaquePlanes planes =
      renderOpaque(stage.scene, stage.camera, stage.gbuffer.display, stage.gbuffer.data, Environment{}, settings);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const glm::dvec3 p(stage.at(x + 0.5, y + 0.5, 4.0));
      const double edge = 0.25 * 8.0 / (4.0 - 1e-3);
      const double inside = edge - std::max(std::abs(p.x), std::abs(p.y));
      if (std::abs(inside) < 1e-4) continue;
      EXPECT_EQ(planes.beauty.at(x, y).r == 0.0f, inside > 0) << x << ' ' << y;
    }
}

}  // namespace
}  // namespace pellucid::rays
