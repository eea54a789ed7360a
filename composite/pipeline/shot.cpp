#include "composite/pipeline/shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "composite/pipeline/colour_step.h"
#include "composite/pipeline/memory_picture.h"
#include "composite/pipeline/same_cameras.h"
#include "composite/pipeline/understood_scene.h"
#include "engine_bridge/embree/environment.h"
#include "engine_bridge/scene/working_space.h"
#include "gbuffer/depth_kind.h"
#include "gbuffer/errors.h"
#include "gbuffer/part_camera.h"
#include "gbuffer/side_files.h"

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

// Where neither file has a camera, as one would type it.
constexpr const char* kCameraExamples =
    "such as --camera 'eye=0,1,5;look=0,0,0;fov=40', or --camera fit, which frames the scene";

std::string namesOf(const std::vector<SceneCamera>& cameras) {
  std::string names;
  for (const SceneCamera& camera : cameras) names += (names.empty() ? "" : ", ") + camera.name;
  return names.empty() ? "none" : names;
}

// How a deep file's depth is read: planar, as OpenEXR has it, unless --depth-kind says otherwise.
DepthConverter deepDepth(const ReadOptions& options, const Camera* camera, const Window& display,
                         const std::string& path) {
  const DepthKind kind = options.depthKind.empty() ? DepthKind{} : parseDepthKind(options.depthKind);
  if (kind.meaning == DepthMeaning::evidence)
    throw UsageError(
        fmt::format("{}: --depth-kind: found auto, which is for flat pictures, expected a kind of deep "
                    "samples: {}",
                    path, depthKindForms()));
  return {kind,    PixelType::float32,     options.farValue, options.metresPerUnit.value_or(1.0), camera,
          display, path + ": deep samples"};
}

// What deep samples are read as where their numbers cannot be planar depth, "" where they can. What looks doubtful is
// noted, as of flat pictures.
std::string kindByNumbers(const StoredDepths& stored, OpaqueFile& file) {
  const std::string which = fmt::format("depth {} of deep samples", file.choice.depthChannel);
  if (stored.negative > 0 && stored.positive == 0) {
    file.notes.push_back(
        fmt::format("{} is negative, {:.6g} to {:.6g}: read as minus planar depth; --depth-kind says otherwise", which,
                    stored.least, stored.most));
    return depthKindText({DepthMeaning::negative});
  }
  if (stored.positive > 0 && stored.negative == 0 && stored.most <= 1.0)
    file.notes.push_back(
        fmt::format("{} lies within 0 to 1, {:.6g} to {:.6g}, and is read as metres of {:g}: if it is normalised, give "
                    "--depth-kind normalised:NEAR:FAR[:inverted]",
                    which, stored.least, stored.most, file.metresPerUnit));
  return "";
}

// A picture all of whose parts are deep becomes its samples, and what it flattens to.
OpaqueFile interpretDeep(ExrDocument document, const ReadOptions& options, const Camera* camera,
                         std::unique_ptr<DeepOpaque>& deep) {
  if (!options.depthChannel.empty() || !options.beautyLayer.empty())
    throw UsageError(
        fmt::format("{}: --beauty and --depth are for flat pictures: found deep samples, which have one "
                    "colour and one depth",
                    document.path));
  OpaqueFile file;
  file.document = std::move(document);
  file.metresPerUnit = options.metresPerUnit.value_or(1.0);
  const DeepChannels channels = resolveDeep(file.document, options.view);
  expectCameraPicture(channels, file.document.path);
  const ExrPart& part = file.document.parts[static_cast<std::size_t>(channels.part)];
  file.choice.beautyPart = file.choice.depthPart = channels.part;
  file.choice.depthChannel = channels.names[static_cast<std::size_t>(channels.z)];
  file.gbuffer.display = part.display;
  file.gbuffer.data = part.data;
  file.gbuffer.pixelAspect = part.pixelAspect;
  readCamera(part, file.metresPerUnit, file);
  file.space = statedSpace(part, "", file.notes);
  if (options.framingAlone) return file;
  if (!camera && file.gbuffer.camera) camera = &*file.gbuffer.camera;
  const auto readAs = [&](const ReadOptions& asked) {
    const DepthConverter depth = deepDepth(asked, camera, part.display, file.document.path);
    file.choice.depthKind = depthKindText(depth.kind());
    deep = std::make_unique<DeepOpaque>(readDeepOpaque(file.document.path, channels, depth));
    const ExrChannel* stored = part.find(file.choice.depthChannel);
    if (stored && stored->type == PixelType::half) deep->depthPrecision = 0x1p-10f;
  };
  readAs(options);
  if (options.depthKind.empty()) {  // nobody said what the numbers mean, so they have a say, as of flat pictures
    ReadOptions settled = options;
    settled.depthKind = kindByNumbers(deep->stored, file);
    if (!settled.depthKind.empty()) readAs(settled);
  }
  const DeepOpaque& samples = *deep;
  file.choice.least = samples.stored.least;
  file.choice.most = samples.stored.most;
  file.gbuffer.beauty = samples.flat;
  file.gbuffer.hasAlpha = true;
  file.gbuffer.viewZ = samples.farthest;
  file.gbuffer.depthPrecision = samples.depthPrecision;
  if (!channels.note.empty()) file.notes.push_back(channels.note);
  const std::string range =
      samples.samples.empty() ? "" : fmt::format(", {:.6g} to {:.6g}", file.choice.least, file.choice.most);
  file.notes.push_back(fmt::format(
      "a deep picture: its {} samples hold transparent layers out one by one; depth: {}, {}{}, 1 unit is {:g} m",
      samples.samples.size(), file.choice.depthChannel, depthKindWords(parseDepthKind(file.choice.depthKind)), range,
      file.metresPerUnit));
  if (samples.oddities.notFinite)
    file.notes.push_back(fmt::format("{} deep samples are not numbers and were skipped", samples.oddities.notFinite));
  return file;
}

OpaqueFile interpretPicture(ExrDocument document, const ReadOptions& options, const Camera* camera,
                            std::unique_ptr<DeepOpaque>& deep) {
  return isDeep(document) ? interpretDeep(std::move(document), options, camera, deep)
                          : interpretOpaque(std::move(document), options, camera);
}

bool isChosen(const CameraChoice& camera) {
  return !std::holds_alternative<std::monostate>(camera);
}

// --camera picture: the file's own, unless a glTF camera has that name.
bool isPictures(const CameraChoice& choice, const Scene& scene) {
  const auto* named = std::get_if<NamedCamera>(&choice);
  return named && named->name == "picture" &&
         std::none_of(scene.cameras.begin(), scene.cameras.end(),
                      [](const SceneCamera& camera) { return camera.name == "picture"; });
}

void takeCameraInMemory(const ShotRequest& request, Shot& shot) {
  shot.hasCamera = shot.hasScene || shot.opaque.gbuffer.camera || isChosen(request.camera);
  if (shot.hasCamera) shot.camera = chooseCamera(request.camera, shot.opaque.gbuffer, shot.scene, kMemoryPicture);
}

// Whether both are one in every number.
bool sameNumbers(const Camera& a, const Camera& b) {
  return a.viewFromWorld == b.viewFromWorld && a.orthographic == b.orthographic && a.focal == b.focal &&
         a.centre == b.centre && a.rangeNear == b.rangeNear && a.rangeFar == b.rangeFar;
}

// Deep samples lie in the picture's own pixels: they need no camera, but fog does.
void takeCamera(const ShotRequest& request, const OpaqueFile& picture, Shot& shot) {
  shot.hasCamera = shot.hasScene || picture.gbuffer.camera || isChosen(request.camera);
  if (shot.hasCamera)
    shot.camera = chooseCamera(request.camera, picture.gbuffer, shot.scene, request.opaque, picture.cameraRefusal);
}

// What --view says of the picture: nothing of one without views, where a deep file has that view.
std::string viewOfPicture(const ShotRequest& request, const ExrDocument& document) {
  const std::string& view = request.read.view;
  const auto isOfViews = [](const std::string& path) { return isExrName(path) && tellsViews(readExr(path)); };
  if (view.empty() || tellsViews(document)) return view;
  return std::any_of(request.inputs.begin(), request.inputs.end(), isOfViews) ? "" : view;
}

// The camera is chosen before depth is converted, which may take it.
void readPicture(const ShotRequest& request, ExrDocument document, Shot& shot) {
  ReadOptions read = request.read;
  read.view = viewOfPicture(request, document);
  ReadOptions framing = read;
  framing.framingAlone = true;
  OpaqueFile first = interpretPicture(std::move(document), framing, nullptr, shot.deepOpaque);
  takeCamera(request, first, shot);
  shot.opaque =
      interpretPicture(std::move(first.document), read, shot.hasCamera ? &shot.camera : nullptr, shot.deepOpaque);
}

// The picture of the frame before, unless the camera that may have converted its depth has moved.
void keepPicture(const ShotRequest& request, Shot& shot) {
  const Camera before = shot.camera;
  const bool hadCamera = shot.hasCamera;
  takeCamera(request, shot.opaque, shot);
  shot.keptPicture = hadCamera == shot.hasCamera && (!hadCamera || sameNumbers(before, shot.camera));
  if (!shot.keptPicture) readPicture(request, std::move(shot.opaque.document), shot);
}

// The scene is loaded at the moment of the picture.
void takeMoment(const ShotRequest& request, const std::optional<ShotMoment>& moment, SceneOptions& options) {
  const ShotTime& time = request.time;
  if (moment) {
    options.seconds = moment->seconds;
    options.secondsBy = moment->origin;
    return;
  }
  const bool asked = time.framesPerSecond || time.offset || (!time.animations.empty() && !time.none());
  if (asked)
    throw MeaningError(
        fmt::format("{}: found no frame in its header (Frame or timeCode), expected one for {}, or --frame N or --time "
                    "SECONDS",
                    request.opaque,
                    time.framesPerSecond ? "--fps"
                    : time.offset        ? "--time-offset"
                                         : "--animation"));
  options.secondsBy =
      time.none() ? "--animation none" : "the picture's header names no frame; --frame N or --time SECONDS plays them";
}

// What was understood of the picture.
std::vector<std::string> linesOf(const Shot& shot) {
  const ColourSpace& space = shot.opaque.space;
  std::vector<std::string> lines{"picture: deep samples, colours in " + spaceText(space)};
  if (!shot.deepOpaque) lines = understoodLines(shot.opaque);
  if (space.source == SpaceSource::nothing) lines[0] += " (--working-space NAME would)";
  return lines;
}

//   keeps  the picture of the frame before may be taken
void chooseSurroundings(const ShotRequest& request, bool keeps, Shot& shot, Journal& journal) {
  if (!keeps) shot.environment.reset();
  shot.surroundings = glm::vec3(0.0f);
  if (const auto* colour = std::get_if<glm::vec3>(&request.surroundings)) {
    shot.surroundings = *colour;
    return;
  }
  if (const auto* picture = std::get_if<PictureOfSurroundings>(&request.surroundings)) {
    if (keeps && shot.environment) return;
    std::vector<std::string> notes;
    shot.environment = journal.time("prepare environment", [&] {
      const Environment environment = readEnvironment(picture->path, notes, shot.opaque.space.fromRec709);
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

OpaqueFile readPictureFile(const std::string& path, const ReadOptions& options, const Camera* camera,
                           std::unique_ptr<DeepOpaque>& deep) {
  return interpretPicture(readWithSides(path, options), options, camera, deep);
}

bool isExrName(const std::string& path) {
  std::string end = path.substr(path.size() - std::min<std::size_t>(path.size(), 4));
  std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
  return end == ".exr";
}

Camera chooseCamera(const CameraChoice& choice, const GBuffer& gbuffer, const Scene& scene,
                    const std::string& opaquePath, const std::string& refused) {
  if (gbuffer.camera && isPictures(choice, scene)) return *gbuffer.camera;
  if (const auto* placed = std::get_if<PlacedCamera>(&choice)) return placedCamera(*placed, gbuffer);
  if (const auto* named = std::get_if<NamedCamera>(&choice)) return namedCamera(named->name, scene, gbuffer);
  if (const auto* fitted = std::get_if<FittedCamera>(&choice))
    return fittedCamera(*fitted, scene, gbuffer.display, gbuffer.pixelAspect);
  if (const auto* matrices = std::get_if<Camera>(&choice)) return *matrices;
  if (gbuffer.camera) return *gbuffer.camera;
  if (allOneCamera(scene.cameras, gbuffer)) return cameraOf(scene.cameras[0], gbuffer.display, gbuffer.pixelAspect);
  if (scene.cameras.empty() && !refused.empty())
    throw MeaningError(refused + "; found no glTF camera either, expected one or --camera, " + kCameraExamples);
  if (scene.cameras.empty())
    throw MeaningError(
        fmt::format("{}: no camera: found neither worldToCamera and worldToNDC attributes nor a glTF camera, expected "
                    "one or --camera, {}",
                    opaquePath, kCameraExamples));
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

namespace {

// What of an earlier frame's shot may serve again; a shot that has read nothing where none may.
std::unique_ptr<Shot> shotToFill(const ShotRequest& request, std::unique_ptr<Shot> earlier) {
  if (!earlier || request.memory || earlier->inMemory) return std::make_unique<Shot>();
  earlier->keptPicture = earlier->keptScene = false;
  earlier->deep.clear();
  earlier->geometry.clear();
  if (earlier->deepOpaque) earlier->opaque = OpaqueFile();
  earlier->deepOpaque.reset();
  return earlier;
}

void loadFiles(const SceneOptions& options, Shot& shot, Journal& journal) {
  shot.keptScene = false;
  shot.files.reset();
  shot.scene = Scene();
  journal.time("read scene", [&] { shot.files = std::make_unique<SceneFiles>(shot.geometry, options, shot.scene); });
}

// Poses the scene of the frame before.
void keepScene(const SceneOptions& options, Shot& shot, Journal& journal) {
  shot.keptScene = true;
  if (!shot.files->moves() || !options.seconds) return;
  journal.time("read scene", [&] {
    const std::vector<int> read = shot.files->pose(*options.seconds, options.secondsBy);
    bringInto(shot.scene, shot.origin.fromRec709, &read);
  });
}

void readDeep(const ShotRequest& request, const std::vector<std::string>& paths, Shot& shot) {
  const GBuffer& gbuffer = shot.opaque.gbuffer;
  const Camera* camera = shot.hasCamera ? &shot.camera : nullptr;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    shot.deep.push_back(std::make_unique<DeepSource>(paths[i],
                                                     deepDepth(request.read, camera, gbuffer.display, paths[i]),
                                                     gbuffer, static_cast<std::uint32_t>(i), request.read.view));
    shot.deep.back()->bringInto(shot.opaque.space);
  }
}

// The scene's colours, in the picture's space.
void bringScene(const SceneOptions& options, ShotOrigin& origin, Shot& shot, Journal& journal) {
  const glm::dmat3& space = shot.opaque.space.fromRec709;
  if (shot.keptScene && shot.origin.fromRec709 != space) loadFiles(options, shot, journal);
  if (!shot.keptScene)
    origin.outside = journal.time("read scene", [&] { return bringInto(shot.scene, space); });
  else
    origin.outside = shot.origin.outside;
  origin.fromRec709 = space;
  journal.note(origin.outside);
}

// Checks the camera, and says where the scene lies before it.
void tellScene(const ShotRequest& request, Shot& shot, Journal& journal) {
  std::optional<double> residual;
  if (!shot.deepOpaque) residual = verifyCamera(shot.opaque, shot.camera);
  if (!isChosen(request.camera) && !request.renderedHere) expectOneCamera(shot, request.opaque);
  std::vector<std::string> lines{fmt::format(
      "camera: {}{}", shot.camera.origin,
      residual ? fmt::format(", checked against positions: median {:.2g} px", *residual) : ", not checked")};
  for (std::string& line : sceneLines(shot)) lines.push_back(std::move(line));
  journal.note(lines);
  shot.understood.insert(shot.understood.end(), lines.begin(), lines.end());
}

}  // namespace

std::unique_ptr<Shot> loadShot(const ShotRequest& request, bool traced, Journal& journal,
                               std::unique_ptr<Shot> earlier) {
  std::unique_ptr<Shot> shot = shotToFill(request, std::move(earlier));
  std::vector<std::string> deep;
  for (const std::string& path : request.inputs) (isExrName(path) ? deep : shot->geometry).push_back(path);
  shot->hasScene = !shot->geometry.empty();
  const WorkingSpace colours(request.colour, request.scene.assetRoot);
  SceneOptions options = request.scene;
  options.animations = request.time.animations;
  options.textured = Textured::transparent;
  if (traced) options.streamBytes = 0;
  ShotOrigin origin = originOf(request, shot->geometry, options);
  const bool keepsPicture = !shot->opaque.document.parts.empty() && origin.samePicture(shot->origin);
  ExrDocument document;
  if (request.memory) {
    shot->inMemory = true;
    journal.time("read picture", [&] { readMemoryPicture(request.memory, shot->opaque); });
  } else if (!keepsPicture) {
    shot->opaque = OpaqueFile();  // before the next one takes as much memory
    document = journal.time("read picture", [&] { return readWithSides(request.opaque, request.read); });
  }
  if (!keepsPicture) shot->headerTime = headerTimeOf(document);
  shot->moment = momentOf(request.time, shot->headerTime);
  takeMoment(request, shot->moment, options);
  const bool posed = options.seconds.has_value();
  if (shot->files && origin.sameScene(shot->origin) && posed == shot->origin.posed)
    keepScene(options, *shot, journal);
  else
    loadFiles(options, *shot, journal);
  origin.posed = posed;
  journal.note(shot->scene.notes);
  journal.time("read picture", [&] {
    request.memory ? takeCameraInMemory(request, *shot)
    : keepsPicture ? keepPicture(request, *shot)
                   : readPicture(request, std::move(document), *shot);
    // A camera of the glTF's own may be animated.
    const bool picturesOwn =
        shot->opaque.gbuffer.camera && (!isChosen(request.camera) || isPictures(request.camera, shot->scene));
    shot->sceneCamera = shot->hasCamera && !picturesOwn &&
                        (!isChosen(request.camera) || std::holds_alternative<NamedCamera>(request.camera));
  });
  OpaqueFile& picture = shot->opaque;
  if (!shot->keptPicture) picture.space = colours.of(picture.space, request.opaque, picture.notes);
  bringScene(options, origin, *shot, journal);
  shot->understood = linesOf(*shot);
  journal.note(shot->understood);
  journal.note(picture.notes);
  if (const std::string before = shot->inMemory ? "" : compositedBefore(picture); !before.empty()) journal.note(before);
  journal.time("read deep", [&] { readDeep(request, deep, *shot); });
  if (shot->hasScene) tellScene(request, *shot, journal);
  const bool sameSurroundings = origin.sameSurroundings(shot->origin);
  shot->origin = std::move(origin);
  chooseSurroundings(request, sameSurroundings, *shot, journal);
  return shot;
}

}  // namespace pellucid
