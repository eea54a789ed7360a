#include "composite/pipeline/shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "composite/pipeline/same_cameras.h"
#include "engine_bridge/embree/environment.h"
#include "gbuffer/errors.h"
#include "gbuffer/part_camera.h"

namespace pellucid {
namespace {

Camera placedCamera(const PlacedCamera& placed, const GBuffer& gbuffer) {
  SceneCamera camera;
  camera.viewFromWorld = glm::lookAt(placed.eye, placed.look, placed.up);
  camera.yfov = glm::radians(placed.fov);
  Camera result = cameraOf(camera, gbuffer.display, gbuffer.pixelAspect);
  result.origin = "--camera";
  return result;
}

std::string namesOf(const std::vector<SceneCamera>& cameras) {
  std::string names;
  for (const SceneCamera& camera : cameras) names += (names.empty() ? "" : ", ") + camera.name;
  return names.empty() ? "none" : names;
}

bool isDeep(const ExrDocument& document) {
  return std::all_of(document.parts.begin(), document.parts.end(), [](const ExrPart& part) { return part.deep; });
}

// What a deep picture flattens to; its samples become shot.deepOpaque.
OpaqueFile flattenedPicture(ExrDocument document, const ReadOptions& options, Shot& shot) {
  const std::string path = document.path;
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

// Depths along rays and device depths are converted by the camera, which may be the scene's: it is chosen between.
void readPicture(const ShotRequest& request, Shot& shot) {
  ExrDocument document = readExr(request.opaque);
  const bool deep = isDeep(document);
  ReadOptions options = request.read;
  const bool depthNeedsCamera = !deep && (options.depthKind == "ray" || options.depthKind == "device");
  if (depthNeedsCamera && shot.hasScene) options.depthKind = "planar";  // for the windows alone
  shot.opaque = deep ? flattenedPicture(std::move(document), options, shot)
                     : interpretOpaque(std::move(document), options, nullptr);
  const GBuffer& gbuffer = shot.opaque.gbuffer;
  if (shot.hasScene) {
    shot.camera = chooseCamera(request.camera, gbuffer, shot.scene, request.opaque);
    if (depthNeedsCamera) shot.opaque = interpretOpaque(std::move(shot.opaque.document), request.read, &shot.camera);
    return;
  }
  // Deep samples lie in the picture's own pixels: they need no camera, but fog does.
  shot.hasCamera = gbuffer.camera || !std::holds_alternative<std::monostate>(request.camera);
  if (shot.hasCamera) shot.camera = chooseCamera(request.camera, gbuffer, shot.scene, request.opaque);
}

void chooseSurroundings(const ShotRequest& request, Shot& shot, Journal& journal) {
  if (const auto* colour = std::get_if<glm::vec3>(&request.surroundings)) {
    shot.surroundings = *colour;
    return;
  }
  if (const auto* picture = std::get_if<PictureOfSurroundings>(&request.surroundings)) {
    std::vector<std::string> notes;
    shot.environment = journal.time("prepare environment", [&] {
      const Environment environment = readEnvironment(picture->path, notes);
      return std::make_shared<const Surroundings>(prepareSurroundings(environment.map()));
    });
    journal.note(notes);
    return;
  }
  const bool lit = std::any_of(shot.scene.materials.begin(), shot.scene.materials.end(),
                               [](const Material& material) { return material.transparent() && !material.unlit; });
  std::size_t pixels = 0;
  shot.surroundings = medianSky(shot.opaque.gbuffer, pixels);
  if (lit && pixels)
    journal.note(
        fmt::format("surroundings: {:.4g},{:.4g},{:.4g}, the median of {} sky pixels; --environment R,G,B "
                    "sets them",
                    shot.surroundings.r, shot.surroundings.g, shot.surroundings.b, pixels));
  else if (lit)
    journal.note("surroundings: black, no pixel shows the sky; --environment R,G,B sets them");
}

}  // namespace

bool isExrName(const std::string& path) {
  std::string end = path.substr(path.size() - std::min<std::size_t>(path.size(), 4));
  std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
  return end == ".exr";
}

Camera chooseCamera(const CameraChoice& choice, const GBuffer& gbuffer, const Scene& scene,
                    const std::string& opaquePath) {
  if (const auto* placed = std::get_if<PlacedCamera>(&choice)) return placedCamera(*placed, gbuffer);
  if (const auto* named = std::get_if<NamedCamera>(&choice)) return namedCamera(named->name, scene, gbuffer);
  if (gbuffer.camera) return *gbuffer.camera;
  if (allOneCamera(scene.cameras, gbuffer)) return cameraOf(scene.cameras[0], gbuffer.display, gbuffer.pixelAspect);
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

std::unique_ptr<Shot> loadShot(const ShotRequest& request, bool traced, Journal& journal) {
  auto shot = std::make_unique<Shot>();
  std::vector<std::string> deep;
  for (const std::string& path : request.inputs) (isExrName(path) ? deep : shot->geometry).push_back(path);
  shot->hasScene = !shot->geometry.empty();
  SceneOptions options = request.scene;
  if (traced) options.streamBytes = 0;
  journal.time("read scene", [&] { shot->scene = loadScene(shot->geometry, options); });
  journal.note(shot->scene.notes);
  journal.time("read picture", [&] { readPicture(request, *shot); });
  journal.note(shot->opaque.notes);
  journal.time("read deep", [&] {
    for (std::size_t i = 0; i < deep.size(); ++i)
      shot->deep.push_back(std::make_unique<DeepSource>(deep[i], request.read.metresPerUnit, shot->opaque.gbuffer,
                                                        static_cast<std::uint32_t>(i)));
  });
  if (shot->hasScene) {
    std::optional<double> residual;
    if (!shot->deepOpaque) residual = verifyCamera(shot->opaque, shot->camera);
    journal.note(fmt::format(
        "camera: {}{}", shot->camera.origin,
        residual ? fmt::format(", checked against positions: median {:.2g} px", *residual) : ", not checked"));
  }
  chooseSurroundings(request, *shot, journal);
  return shot;
}

}  // namespace pellucid
