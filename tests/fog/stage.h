// Fog before a wall, for one camera that looks down -z from (0, 1, 0).
#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

#include "composite/fog.h"
#include "composite/resolve.h"
#include "engine_bridge/scene/blocks.h"
#include "tests/gl/builder.h"
#include "tests/reference/ordered_march.h"

namespace pellucid::test {

struct FogStage : Stage {
  FogStage(int width, int height, float wall) : Stage(width, height) {
    gbuffer.viewZ = Image<float>(width, height, wall);
    gbuffer.beauty = Image<glm::vec4>(width, height, glm::vec4(0.5f, 0.25f, 0.125f, 1.0f));
    camera.viewFromWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -1.0, 0.0));
  }

  Fog fog(const MediumSettings& settings, glm::vec3 ambient = glm::vec3(0.0f)) const {
    return placeFog(settings, camera, {ambient, {}}, lightBlocks(scene.lights, camera));
  }
  Light& sun(glm::dvec3 toSun, float irradiance) {
    Light light;
    light.kind = LightKind::directional;
    light.direction = -glm::normalize(toSun);
    light.intensity = irradiance;
    scene.lights.push_back(light);
    return scene.lights.back();
  }
  Light& lamp(glm::dvec3 position, float intensity) {
    Light light;
    light.position = position;
    light.intensity = intensity;
    scene.lights.push_back(light);
    return scene.lights.back();
  }
  // Unit, world, through a pixel's centre; and metres a planar metre.
  glm::dvec3 way(int x, int y) const {
    const PixelRays rays = pixelRays(camera, gbuffer.display, {0, 0}, {0.5, 0.5});
    return glm::normalize(glm::dvec3(glm::dvec2(rays.offset + rays.scale * glm::vec2(x, y)), -1.0));
  }

  OitPlanes sums(const Fog& fog,
                 const shading::WeightSettings& weight = {shading::PLD_WEIGHT_EQ5, 0.1f, 1000.0f, 3.0f, 1.0f}) const {
    OitPlanes planes = emptyPlanes(gbuffer.display, gbuffer.data);
    planes.info.weight = weight;
    addFog(fog, gbuffer, {0.5, 0.5}, planes);
    return planes;
  }
  // The sums of all layers and the fog, marched by the CPU and by the pass.
  struct Both {
    OitPlanes cpu, gl;
  };
  Both both(const Fog& fog) {
    PassSettings settings;
    Both planes;
    planes.cpu = accumulate(settings);
    planes.cpu.info.weight = settings.weight;
    addFog(fog, gbuffer, {0.5, 0.5}, planes.cpu);
    settings.fog = std::make_shared<Fog>(fog);
    planes.gl = accumulate(settings);
    return planes;
  }
  Picture picture(const OitPlanes& planes) const { return compose(resolve(planes, {}), gbuffer); }
};

// A light volume over a box of the world from a function of world points.
inline std::shared_ptr<const LightVolume> volumeOf(const Camera& camera, const Box& box, glm::ivec3 size,
                                                   const std::function<glm::vec3(int, glm::dvec3)>& visible,
                                                   int lights) {
  auto volume = std::make_shared<LightVolume>();
  volume->size = size;
  volume->visibility = Volume<glm::vec4>({size.x, size.y, size.z * lights}, glm::vec4(1.0f));
  const glm::dvec3 extent = box.high - box.low;
  for (int light = 0; light < lights; ++light)
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
          volume->visibility.at({x, y, z + light * size.z}) =
              glm::vec4(visible(light, box.low + extent * (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(size)), 1.0f);
  glm::dmat4 texelFromWorld(1.0);
  for (int c = 0; c < 3; ++c) {
    texelFromWorld[c][c] = size[c] / extent[c];
    texelFromWorld[3][c] = -box.low[c] * size[c] / extent[c];
  }
  volume->texelFromView = glm::mat4(texelFromWorld * glm::inverse(camera.viewFromWorld));
  return volume;
}

}  // namespace pellucid::test
