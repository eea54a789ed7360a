// Scenes small enough to know the answer: quads that cover given pixels at given depths, in front of a G-buffer.
#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid::test {

constexpr float kSky = std::numeric_limits<float>::infinity();

// Identity view looking down -z. Square pixels: at depth z one pixel is z / width metres wide.
struct Stage {
  explicit Stage(int width, int height) {
    gbuffer.display = gbuffer.data = {0, 0, width, height};
    gbuffer.viewZ = Image<float>(width, height, kSky);
    gbuffer.depthPrecision = 1e-5f;
    camera.focal = {2.0, 2.0 * width / height};
  }

  // World position that projects to pixel coordinates (x, y), y down, at planar depth z.
  glm::vec3 at(double x, double y, double z) const {
    const double u = 2.0 * x / gbuffer.display.width() - 1.0, v = 1.0 - 2.0 * y / gbuffer.display.height();
    const double scale = camera.orthographic ? 1.0 : z;
    return {static_cast<float>(u / camera.focal.x * scale), static_cast<float>(v / camera.focal.y * scale),
            static_cast<float>(-z)};
  }

  int add(const Material& material) {
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
  }

  Instance& place(Primitive primitive) {
    scene.primitives.push_back(std::move(primitive));
    Instance instance;
    instance.primitive = static_cast<int>(scene.primitives.size()) - 1;
    instance.identity = 1000u * static_cast<std::uint32_t>(scene.instances.size() + 1);
    scene.instances.push_back(instance);
    return scene.instances.back();
  }

  // Corners counter-clockwise seen from the camera: a front face. uv (0,0) at the top left pixel corner.
  Instance& quad(double x0, double y0, double x1, double y1, double z, int material) {
    return slanted(x0, y0, x1, y1, z, z, material);
  }
  // z0 along the left edge, z1 along the right.
  Instance& slanted(double x0, double y0, double x1, double y1, double z0, double z1, int material) {
    Primitive primitive;
    primitive.material = material;
    const glm::vec3 corners[] = {at(x0, y1, z0), at(x1, y1, z1), at(x1, y0, z1), at(x0, y0, z0)};
    const glm::vec2 uvs[] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    for (int i = 0; i < 4; ++i) {
      Vertex vertex{};
      vertex.position = corners[i];
      vertex.normal = normal;
      vertex.uv[0] = vertex.uv[1] = uvs[i];
      vertex.colour = glm::vec4(1.0f);
      primitive.vertices.push_back(vertex);
    }
    primitive.indices = {0, 1, 2, 0, 2, 3};
    return place(std::move(primitive));
  }

  int texture(int width, int height, std::vector<glm::vec4> texels) {
    Texture texture;
    texture.name = "texture " + std::to_string(scene.textures.size());
    texture.texels = Image<glm::vec4>(width, height);
    for (std::size_t i = 0; i < texels.size(); ++i) texture.texels[i] = texels[i];
    texture.wrapS = texture.wrapT = Wrap::clamp;
    scene.textures.push_back(std::move(texture));
    return static_cast<int>(scene.textures.size()) - 1;
  }

  OitPlanes accumulate(const PassSettings& settings = {}) {
    GlContext context;
    TransparentPass pass(context, scene, gbuffer, camera);
    OitPlanes planes = pass.accumulate(settings);
    statistics = pass.statistics();
    return planes;
  }

  std::vector<FragmentLists> fragments(const PassSettings& settings = {}) {
    GlContext context;
    TransparentPass pass(context, scene, gbuffer, camera);
    std::vector<FragmentLists> tiles;
    pass.fragments(settings, [&](const FragmentLists& lists) { tiles.push_back(lists); });
    statistics = pass.statistics();
    return tiles;
  }

  Scene scene;
  GBuffer gbuffer;
  Camera camera;
  PassStatistics statistics;
};

// L_r = colour, covers `alpha` of a pixel, transmits nothing.
inline Material unlitBlend(glm::vec3 colour, float alpha) {
  Material material;
  material.name = "unlit";
  material.alphaMode = AlphaMode::blend;
  material.unlit = material.doubleSided = true;
  material.baseColor = glm::vec4(colour, alpha);
  return material;
}

}  // namespace pellucid::test
