#include "composite/cli/shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <sstream>

#include "engine_bridge/embree/environment.h"
#include "gbuffer/errors.h"
#include "gbuffer/part_camera.h"

namespace pellucid::cli {
namespace {

glm::dvec3 parsePoint(const std::string& text) {
  glm::dvec3 point{};
  char comma = 0, rest = 0;
  std::istringstream in(text);
  if (!(in >> point.x >> comma >> point.y >> comma >> point.z) || (in >> rest))
    throw UsageError(fmt::format("--camera: found '{}', expected three numbers X,Y,Z", text));
  return point;
}

// "eye=0,1,4;look=0,1,0;up=0,1,0;fov=45"
Camera cameraFromFlag(const std::string& flag, const GBuffer& gbuffer) {
  glm::dvec3 eye{0}, look{0, 0, -1}, up{0, 1, 0};
  double fov = 0;
  std::istringstream parts(flag);
  for (std::string part; std::getline(parts, part, ';');) {
    const auto equals = part.find('=');
    const std::string key = part.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
    if (key == "eye")
      eye = parsePoint(value);
    else if (key == "look")
      look = parsePoint(value);
    else if (key == "up")
      up = parsePoint(value);
    else if (key == "fov")
      fov = std::atof(value.c_str());
    else
      throw UsageError(fmt::format("--camera: found '{}', expected eye=, look=, up= or fov=", part));
  }
  if (!(fov > 0 && fov < 180))
    throw UsageError(fmt::format("--camera: found fov={}, expected degrees between 0 and 180", fov));
  if (glm::length(glm::cross(look - eye, up)) < 1e-12)
    throw UsageError("--camera: the view direction and up are parallel, expected two directions");
  SceneCamera camera;
  camera.viewFromWorld = glm::lookAt(eye, look, up);
  camera.yfov = glm::radians(fov);
  Camera result = cameraOf(camera, gbuffer.display, gbuffer.pixelAspect);
  result.origin = "--camera";
  return result;
}

std::string namesOf(const std::vector<SceneCamera>& cameras) {
  std::string names;
  for (const SceneCamera& camera : cameras) names += (names.empty() ? "" : ", ") + camera.name;
  return names.empty() ? "none" : names;
}

// A picture all of whose parts are deep becomes shot.deepOpaque, and what it flattens to.
OpaqueFile readPicture(const std::string& path, const ReadOptions& options, const Camera* camera, Shot& shot) {
  ExrDocument document = readExr(path);
  const bool deep =
      std::all_of(document.parts.begin(), document.parts.end(), [](const ExrPart& part) { return part.deep; });
  if (!deep) return interpretOpaque(std::move(document), options, camera);
  if (options.depthKind != "planar" || !options.depthChannel.empty() || !options.beautyLayer.empty())
    throw UsageError(
        fmt::format("{}: --beauty, --depth and --depth-kind are for flat pictures: found deep samples, "
                    "which have one colour and planar depth",
                    path));
  shot.deepOpaque = std::make_unique<DeepOpaque>(readDeepOpaque(path, options.metresPerUnit));
  const DeepOpaque& samples = *shot.deepOpaque;
  OpaqueFile file;
  file.metresPerUnit = options.metresPerUnit;
  file.gbuffer.display = samples.display;
  file.gbuffer.data = samples.data;
  file.gbuffer.pixelAspect = document.parts[0].pixelAspect;
  file.gbuffer.beauty = samples.flat;
  file.gbuffer.hasAlpha = true;
  file.gbuffer.viewZ = samples.farthest;
  file.document = std::move(document);
  readCamera(file.document.parts[0], options.metresPerUnit, file);
  file.notes.push_back(
      fmt::format("a deep picture: its {} samples hold transparent layers out one by one", samples.samples.size()));
  if (samples.oddities.notFinite)
    file.notes.push_back(fmt::format("{} deep samples are not finite and were skipped", samples.oddities.notFinite));
  return file;
}

}  // namespace

bool isExrName(const std::string& path) {
  std::string end = path.substr(path.size() - std::min<std::size_t>(path.size(), 4));
  std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
  return end == ".exr";
}

Camera chooseCamera(const std::string& flag, const GBuffer& gbuffer, const Scene& scene,
                    const std::string& opaquePath) {
  if (flag.find('=') != std::string::npos) return cameraFromFlag(flag, gbuffer);
  if (!flag.empty()) {
    for (const SceneCamera& camera : scene.cameras)
      if (camera.name == flag) return cameraOf(camera, gbuffer.display, gbuffer.pixelAspect);
    throw UsageError(
        fmt::format("--camera: found '{}', expected one of the scene's cameras ({})", flag, namesOf(scene.cameras)));
  }
  if (gbuffer.camera) return *gbuffer.camera;
  if (scene.cameras.size() == 1) return cameraOf(scene.cameras[0], gbuffer.display, gbuffer.pixelAspect);
  if (scene.cameras.empty())
    throw MeaningError(
        fmt::format("{}: no camera: found neither worldToCamera and worldToNDC attributes nor a glTF camera, expected "
                    "one or --camera",
                    opaquePath));
  throw MeaningError(fmt::format("{}: found {} cameras ({}), expected one, or --camera NAME", opaquePath,
                                 scene.cameras.size(), namesOf(scene.cameras)));
}

glm::vec3 medianSky(const GBuffer& gbuffer, std::size_t& pixels) {
  std::vector<float> channels[3];
  for (std::size_t i = 0; i < gbuffer.viewZ.size(); ++i) {
    const glm::vec4& colour = gbuffer.beauty[i];
    if (std::isfinite(gbuffer.viewZ[i]) || !std::isfinite(colour.r + colour.g + colour.b)) continue;
    for (int c = 0; c < 3; ++c) channels[c].push_back(std::max(colour[c], 0.0f));
  }
  pixels = channels[0].size();
  glm::vec3 median{0.0f};
  if (pixels == 0) return median;
  for (int c = 0; c < 3; ++c) {
    const auto middle = channels[c].begin() + static_cast<std::ptrdiff_t>(pixels / 2);
    std::nth_element(channels[c].begin(), middle, channels[c].end());
    median[c] = *middle;
  }
  return median;
}

std::unique_ptr<Shot> loadShot(const std::string& opaquePath, const std::vector<std::string>& scenePaths,
                               const ReadFlags& read, const SceneFlags& sceneFlags, Stages& stages, bool traced) {
  auto shot = std::make_unique<Shot>();
  std::vector<std::string> geometry, deep;
  for (const std::string& path : scenePaths) (isExrName(path) ? deep : geometry).push_back(path);
  shot->hasScene = !geometry.empty();
  stages.time("read scene", [&] { shot->scene = loadScene(geometry, sceneFlags.options(read.unit, traced)); });
  say(shot->scene.notes);
  stages.time("read picture", [&] {
    ReadOptions options = read.options();
    const bool depthNeedsCamera = options.depthKind == "ray" || options.depthKind == "device";
    if (depthNeedsCamera) options.depthKind = "planar";  // for the windows alone
    if (!shot->hasScene) {  // deep samples lie in the picture's own pixels: no camera is needed
      shot->opaque = readPicture(opaquePath, read.options(), nullptr, *shot);
      if (shot->opaque.gbuffer.camera) shot->camera = *shot->opaque.gbuffer.camera;
      return;
    }
    shot->opaque = readPicture(opaquePath, options, nullptr, *shot);
    shot->camera = chooseCamera(sceneFlags.camera, shot->opaque.gbuffer, shot->scene, opaquePath);
    if (depthNeedsCamera) shot->opaque = readPicture(opaquePath, read.options(), &shot->camera, *shot);
  });
  say(shot->opaque.notes);
  stages.time("read deep", [&] {
    for (std::size_t i = 0; i < deep.size(); ++i)
      shot->deep.push_back(
          std::make_unique<DeepSource>(deep[i], read.unit, shot->opaque.gbuffer, static_cast<std::uint32_t>(i)));
  });
  if (!shot->hasScene) return shot;
  std::optional<double> residual;
  if (!shot->deepOpaque) residual = verifyCamera(shot->opaque, shot->camera);
  spdlog::info("camera: {}{}", shot->camera.origin,
               residual ? fmt::format(", checked against positions: median {:.2g} px", *residual) : ", not checked");

  if (!sceneFlags.environment.empty()) {
    if (isColour(sceneFlags.environment)) {
      shot->surroundings = parseColour(sceneFlags.environment, "--environment");
    } else {
      std::vector<std::string> notes;
      shot->environment = stages.time("prepare environment", [&] {
        const Environment picture = readEnvironment(sceneFlags.environment, notes);
        return std::make_shared<const Surroundings>(prepareSurroundings(picture.map()));
      });
      say(notes);
    }
  } else {
    const bool lit = std::any_of(shot->scene.materials.begin(), shot->scene.materials.end(),
                                 [](const Material& material) { return material.transparent() && !material.unlit; });
    std::size_t pixels = 0;
    shot->surroundings = medianSky(shot->opaque.gbuffer, pixels);
    if (lit && pixels)
      spdlog::info("surroundings: {:.4g},{:.4g},{:.4g}, the median of {} sky pixels; --environment R,G,B sets them",
                   shot->surroundings.r, shot->surroundings.g, shot->surroundings.b, pixels);
    else if (lit)
      spdlog::info("surroundings: black, no pixel shows the sky; --environment R,G,B sets them");
  }
  return shot;
}

}  // namespace pellucid::cli
