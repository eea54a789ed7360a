// The cameras of a glTF file's nodes.
#include <fmt/format.h>

#include <cmath>

#include "engine_bridge/scene/nodes.h"
#include "gbuffer/errors.h"

namespace pellucid::gltf {

namespace {

constexpr double kMostMetres = 1e15;  // as of transforms

double positive(const JsonView& lens, const char* key, double most) {
  const double value = lens.at(key).number();
  if (!(value > 0.0 && value < most))
    lens.at(key).refuse(fmt::format("is {:g}; expected 0 to {:g}, exclusive", value, most));
  return value;
}

void readLens(const JsonView& source, double metresPerUnit, SceneCamera& camera) {
  const std::string kind = source.at("type").string();
  if (kind != "perspective" && kind != "orthographic") {
    source.at("type").refuse(fmt::format("is {}; expected perspective or orthographic", kind));
  }
  camera.orthographic = kind == "orthographic";
  const JsonView lens = source.at(kind.c_str());
  if (camera.orthographic) {
    camera.xmag = positive(lens, "xmag", kMostMetres) * metresPerUnit;
    camera.ymag = positive(lens, "ymag", kMostMetres) * metresPerUnit;
    camera.znear = lens.at("znear").number();  // 0 is allowed here
    camera.zfar = positive(lens, "zfar", kMostMetres);
  } else {
    constexpr double kPi = 3.14159265358979323846;
    camera.yfov = positive(lens, "yfov", kPi);
    if (lens.find("aspectRatio")) camera.aspect = positive(lens, "aspectRatio", kMostMetres);
    camera.znear = positive(lens, "znear", kMostMetres);
    if (lens.find("zfar")) camera.zfar = positive(lens, "zfar", kMostMetres);
  }
  if (camera.znear < 0.0 || (camera.zfar != 0.0 && camera.zfar <= camera.znear)) {
    lens.refuse(fmt::format("has znear {:g} and zfar {:g}; expected 0 <= znear < zfar", camera.znear, camera.zfar));
  }
  camera.znear *= metresPerUnit;
  camera.zfar *= metresPerUnit;
}

// A camera's scale and shear do not count (glTF 2.0, Cameras): only where it stands and where it looks.
glm::dmat4 viewOf(const JsonView& node, const glm::dmat4& world) {
  const glm::dvec3 back(world[2]), up(world[1]);
  const glm::dvec3 z = back / glm::length(back);
  const glm::dvec3 sideways = glm::cross(up, z);
  if (!(glm::length(back) > 0.0) || !(glm::length(sideways) > 1e-9 * glm::length(up))) {
    node.refuse("carries a camera and has a transform without orientation; expected a rotation");
  }
  const glm::dvec3 x = sideways / glm::length(sideways);
  const glm::dmat3 viewFromWorld = glm::transpose(glm::dmat3(x, glm::cross(z, x), z));
  glm::dmat4 view(viewFromWorld);
  view[3] = glm::dvec4(-(viewFromWorld * glm::dvec3(world[3])), 1.0);
  return view;
}

}  // namespace

void readCameras(const GltfFile& file, const std::vector<PlacedNode>& nodes, double metresPerUnit, Notes& notes,
                 std::vector<SceneCamera>& cameras) {
  for (const PlacedNode& placed : nodes) {
    const JsonView node = file.item("nodes", placed.index);
    const std::optional<JsonView> reference = node.find("camera");
    if (!reference) continue;
    try {
      const JsonView source = file.item("cameras", *reference);
      SceneCamera camera;
      camera.name = node.string("name", source.string("name", placed.name));
      readLens(source, metresPerUnit, camera);
      camera.viewFromWorld = viewOf(node, placed.worldFromObject);
      cameras.push_back(camera);
    } catch (const InputError& problem) {
      std::string what = problem.what();
      const std::string prefix = file.path() + ": ";
      if (what.compare(0, prefix.size(), prefix) == 0) what.erase(0, prefix.size());
      notes.add(fmt::format("the camera of node {} is left out: {}", placed.name, what));
    }
  }
}

}  // namespace pellucid::gltf
