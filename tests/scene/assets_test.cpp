// Real files that the project did not make, where they are present.
#include <cmath>

#include "tests/scene/gltf_builder.h"

namespace pellucid::test {
namespace {

const std::filesystem::path kAssets = std::filesystem::path(PELLUCID_SOURCE_DIR) / ".." / "shared" / "assets";

void expectSound(const Scene& scene) {
  for (const Primitive& primitive : scene.primitives) {
    ASSERT_EQ(primitive.indices.size() % 3, 0u);
    ASSERT_TRUE(primitive.material >= 0 && static_cast<std::size_t>(primitive.material) < scene.materials.size());
    for (const std::uint32_t i : primitive.indices) ASSERT_LT(i, primitive.vertices.size());
    for (const Vertex& vertex : primitive.vertices) {
      ASSERT_NEAR(glm::length(vertex.normal), 1.0f, 1e-5f);
      ASSERT_TRUE(std::isfinite(glm::dot(vertex.position, glm::vec3(1.0f))));
    }
  }
  for (const Instance& instance : scene.instances) {
    ASSERT_LT(static_cast<std::size_t>(instance.primitive), scene.primitives.size());
  }
}

TEST(Assets, EveryGlbLoadsOrIsRefusedByName) {
  if (!std::filesystem::exists(kAssets)) GTEST_SKIP() << kAssets << " is not here";
  int loaded = 0;
  for (const char* folder : {"gltf", "blender"}) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(kAssets / folder)) {
      if (entry.path().extension() == ".glb") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& path : files) {
      SCOPED_TRACE(path.filename());
      try {
        const Scene scene = loadScene({path.string()}, {});
        expectSound(scene);
        std::size_t triangles = 0;
        for (const Instance& instance : scene.instances) {
          triangles += scene.primitives[static_cast<std::size_t>(instance.primitive)].indices.size() / 3;
        }
        std::printf("%s: %zu triangles, %zu instances, %zu materials, %zu textures, %zu lights, %zu cameras\n",
                    path.filename().c_str(), triangles, scene.instances.size(), scene.materials.size(),
                    scene.textures.size(), scene.lights.size(), scene.cameras.size());
        for (const std::string& note : scene.notes) {
          std::printf("  %s\n", note.substr(path.parent_path().string().size() + 1).c_str());
        }
        EXPECT_GT(triangles, 0u);
        ++loaded;
      } catch (const MeaningError& error) {
        EXPECT_NE(std::string(error.what()).find("requires the extension"), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_GT(loaded, 0);
}

TEST(Assets, TextureTransformsAgreeWithTheSampleBesideThem) {
  const std::filesystem::path path = kAssets / "gltf" / "TextureTransformMultiTest.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const Scene scene = loadScene({path.string()}, {});
  // Corner positions to the texture coordinates that are looked up there, by node.
  const auto lookups = [&](const std::string& node) {
    std::vector<std::pair<glm::vec3, glm::vec2>> result;
    for (const Instance& instance : scene.instances) {
      if (instance.node != node) continue;
      const Primitive& primitive = scene.primitives.at(static_cast<std::size_t>(instance.primitive));
      const TextureRef& ref = scene.materials.at(static_cast<std::size_t>(primitive.material)).baseColorTexture;
      for (const Vertex& vertex : primitive.vertices) {
        result.emplace_back(vertex.position, glm::vec2(ref.uvTransform * glm::vec3(vertex.uv[ref.texCoord], 1.0f)));
      }
    }
    return result;
  };
  // The asset puts the same part of one image on all three quads, twice through a transform. It is 0.22 wide; the
  // transformed copies are off by up to 0.007 by its author's rounding, a wrong turn by more than 0.2.
  const auto sample = lookups("BaseColorSample");
  ASSERT_GE(sample.size(), 4u);
  for (const char* node : {"BaseColorUV0", "BaseColorUV1"}) {
    const auto transformed = lookups(node);
    int compared = 0;
    for (const auto& [position, uv] : transformed) {
      for (const auto& [samplePosition, sampleUv] : sample) {
        if (glm::length(position - samplePosition) > 1e-3f) continue;
        EXPECT_LE(glm::length(uv - sampleUv), 0.01f) << node << " " << uv.x << " " << uv.y;
        ++compared;
      }
    }
    EXPECT_GE(compared, 4) << node;
  }
}

TEST(Assets, BlendersCameraAndSun) {
  const std::filesystem::path folder = kAssets / "blender";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  const Scene scene = loadScene({(folder / "transparent_lit.glb").string()}, {});
  std::ifstream stream(folder / "camera.json");
  const Json truth = Json::parse(stream);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].name, "cam");
  const Camera camera = cameraOf(scene.cameras[0], Window{0, 0, truth["resolution"][0], truth["resolution"][1]}, 1.0);
  // The exporter writes yfov and the matrix as floats: 1e-6 of values up to 6.
  const double fx = truth["projection_gl"][0][0], fy = truth["projection_gl"][1][1];
  EXPECT_NEAR(camera.focal.x, fx, 1e-6);
  EXPECT_NEAR(camera.focal.y, fy, 1e-6);
  double worst = 0;
  for (const glm::dvec3 blender : {glm::dvec3(0, 0, 0), glm::dvec3(1, 2, 3), glm::dvec3(-4, 0.5, 2)}) {
    const glm::dvec3 gltf(blender.x, blender.z, -blender.y);  // Z-up to Y-up
    const glm::dvec3 found(camera.viewFromWorld * glm::dvec4(gltf, 1.0));
    for (int row = 0; row < 3; ++row) {
      const Json& m = truth["world_to_camera"][static_cast<std::size_t>(row)];
      const double expected = m[0].get<double>() * blender.x + m[1].get<double>() * blender.y +
                              m[2].get<double>() * blender.z + m[3].get<double>();
      worst = std::max(worst, std::abs(found[row] - expected));
    }
  }
  std::printf("camera against camera.json: focal %.6f %.6f, largest difference of view positions %.2g m\n",
              camera.focal.x, camera.focal.y, worst);
  EXPECT_LE(worst, 2e-6);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_NEAR(scene.lights[0].intensity, 2.5f, 1e-6f) << "Blender's 2.5 W/m2";
}

}  // namespace
}  // namespace pellucid::test
