// A tree and a picket fence of cards with binary masks, over an opaque garden. PT17 fig. 6.
#include "samples/foliage/plants.h"
#include "samples/generate/files.h"
#include "samples/generate/sample.h"

namespace pellucid::samples {
namespace {

nlohmann::json cutOut(const std::string& name, int texture) {
  return {{"name", name},
          {"doubleSided", true},
          {"alphaMode", "MASK"},
          {"alphaCutoff", 0.5},
          {"pbrMetallicRoughness",
           {{"baseColorTexture", {{"index", texture}}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.9}}}};
}

}  // namespace

Sample foliage() {
  Sample sample;
  sample.view.eye = {0.3, 1.5, 5.2};
  sample.view.target = {0.05, 1.15, 0.0};
  sample.view.yfov = 0.5;

  Studio& studio = sample.studio;
  studio.toSun = glm::normalize(glm::dvec3(-0.5, 0.8, 0.35));
  studio.sunIrradiance = {1.6, 1.5, 1.3};
  studio.ambient = {0.6, 0.68, 0.78};
  studio.ambientReach = 0.6;
  studio.sky = [](glm::dvec3) { return glm::dvec3(0.6, 0.68, 0.78); };
  studio.shapes = {
      {ShapeKind::box, {0.0, -0.05, 0.0}, {12.0, 0.05, 12.0}, 0.0, checker({0.3, 0.34, 0.2}, {0.26, 0.3, 0.17}, 0.5)},
      {ShapeKind::cylinder, {-0.55, 0.5, 0.0}, {0.07, 0.5, 0.0}, 0.0, plain({0.3, 0.22, 0.15})},
      {ShapeKind::box, {0.9, 0.25, -1.2}, {1.6, 0.25, 0.12}, 0.0, plain({0.55, 0.5, 0.45})},
      {ShapeKind::sphere, {0.55, 0.2, 0.55}, glm::dvec3(0.2), 0.0, plain({0.6, 0.3, 0.2})},
  };

  Glb& glb = sample.glb;
  const int leaf = glb.addMaterial(cutOut("leaf", glb.addTexture("leaf", encodePng(leafMask(256)))));
  const int slat = glb.addMaterial(cutOut("slat", glb.addTexture("slat", encodePng(slatMask(512)))));
  glb.addMesh("tree", meshOf(crown({-0.55, 1.5, 0.0}, 0.75, 650, 0.2, 7)), leaf);
  glb.addMesh("fence", meshOf(fence({0.35, 0.0, -0.2}, 1.8, 1.1, 2, 0.05)), slat);
  glb.addCamera("cam", sample.view);
  glb.addSun("sun", studio.toSun, studio.sunIrradiance);
  return sample;
}

}  // namespace pellucid::samples
