// Scenes and pictures that several tests here look at.
#pragma once
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "engine_bridge/scene/gltf.h"
#include "gbuffer/opaque_io.h"
#include "tests/support/program.h"

namespace pellucid::test {

// Writes a shipped sample's EXR and GLB; the result is their path without ending.
inline std::string makeSample(const std::string& name) {
  const std::string folder = freshFolder("embree_" + name);
  const std::string command =
      std::string(PELLUCID_BINARY_DIR) + "/bin/pellucid_samples " + folder + " " + name + " >/dev/null";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("pellucid_samples failed: " + command);
  return folder + "/" + name;
}

inline Scene sceneOf(const std::string& path) {
  return loadScene({path}, SceneOptions{});
}

// All of it as an opaque scene: what is glass becomes painted.
inline void makeOpaque(Scene& scene) {
  for (Material& material : scene.materials) {
    material.alphaMode = AlphaMode::opaque;
    material.transmission = 0.0f;
    material.additive = false;
    material.coverage.reset();
  }
}

inline Camera cameraIn(const Scene& scene, const Window& display) {
  return cameraOf(scene.cameras.at(0), display, 1.0);
}

}  // namespace pellucid::test
