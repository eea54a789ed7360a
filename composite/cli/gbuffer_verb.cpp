#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/gbuffer_blur.h"
#include "composite/cli/gbuffer_render.h"
#include "composite/cli/number_checks.h"
#include "composite/cli/over_frames.h"
#include "composite/cli/results.h"
#include "composite/cli/verbs.h"
#include "composite/pipeline/colour_step.h"
#include "composite/pipeline/shot.h"
#include "engine_bridge/scene/working_space.h"

namespace pellucid::cli {
namespace {

// There is no picture yet to say it: linear Rec.709, unless --working-space names another.
ColourSpace spaceToRender(const GbufferFlags& flags) {
  const ColourRequest request = flags.colour.request();
  checkColours(request);
  const WorkingSpace colours(request, flags.assetRoot);  // reads the config, whatever it is then asked for
  if (request.workingSpace == "auto") return {};
  std::vector<std::string> notes;
  return colours.of({}, flags.output, notes);
}

void gbuffer(const GbufferFlags& flags, const FrameRun& frame) {
  const Threads threads(flags.run.threads);
  Stages stages;
  const RenderedPart part = renderPart(flags, false, stages, [&](double share) { frame.voice->stage("trace", share); });
  flags.preview.write(flags.colour.request(), flags.assetRoot, part.space, part.planes.beauty);
  stages.time("write", [&] { writePart(flags.output, part, flags.renderer, withSettings(flags, frame.attributes)); });
  nlohmann::json report{
      {"output", flags.output}, {"renderer", flags.renderer}, {"opaqueInstances", part.opaqueInstances}};
  reportSpace(part.space, report);
  RunCounts counts;
  counts.triangles = part.triangles;
  reportRun(flags.run, stages, counts, part.device, report);
}

}  // namespace

RenderedPart renderPart(const GbufferFlags& flags, bool fits, Stages& stages, const std::function<void(double)>& told) {
  RenderedPart part;
  part.window = parseSize(flags.size);
  checkFlags(flags);
  SceneOptions options;
  options.metresPerUnit = flags.unit;
  options.lumensPerWatt = flags.lumensPerWatt;
  options.overrides = flags.overrides;
  options.assetRoot = flags.assetRoot;
  options.textured = Textured::opaque;
  const std::optional<ShotMoment> moment = playAnimations(flags.time.time(), options);
  checkBlur(flags, moment);
  part.space = spaceToRender(flags);
  flags.preview.check(flags.colour.request(), flags.assetRoot);
  Scene scene;
  const auto files =
      stages.time("read scene", [&] { return std::make_unique<SceneFiles>(flags.scenes, options, scene); });
  say(scene.notes);
  say(bringInto(scene, part.space.fromRec709));
  GBuffer frame;
  frame.display = frame.data = part.window;
  const bool fitted = fits && flags.camera.empty() && scene.cameras.empty();
  part.camera = chooseCamera(fitted ? FittedCamera() : cameraChoice(flags.camera), frame, scene, flags.scenes.front());
  note("camera: {}", part.camera.origin);
  part.opaqueInstances = std::count_if(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    return !scene.materials[static_cast<std::size_t>(primitive.material)].transparent();
  });
  if (part.opaqueInstances == 0)
    note("{}: nothing opaque is in the scene: the picture shows the surroundings", flags.scenes[0]);
  part.planes = renderBlurred(
      flags, scene, *files, moment, part.space, part.camera, [&](const Camera& from, std::optional<int> samples) {
        return flags.renderer == "gl" ? rasterise(flags, scene, from, part.window, stages, part.device)
                                      : trace(flags, scene, from, part.window, samples, part.space, told, stages);
      });
  if (flags.renderer == "gl" && !part.planes.lights.empty())
    say("lights without shadows: --renderer embree traces them");
  part.lights = part.planes.lights.size();
  for (const Instance& instance : scene.instances)
    part.triangles += scene.primitives[static_cast<std::size_t>(instance.primitive)].indices.size() / 3;
  return part;
}

void writePart(const std::string& path, const RenderedPart& part, const std::string& renderer,
               std::map<std::string, std::string> attributes) {
  attributes.emplace("pellucid:renderer", renderer);
  say(writeLayers(path, part.window, part.window, layersOf(part.planes), attributes, &part.camera, false, nullptr,
                  chromaticitiesToWrite(part.space)));
}

void addGbuffer(CLI::App& app) {
  auto flags = std::make_shared<GbufferFlags>();
  CLI::App* verb = app.add_subcommand("gbuffer", "The opaque part of a scene: colour, depth, normals, lights");
  verb->add_option("scenes", flags->scenes, "glTF or GLB; its transparent and alpha-tested materials are left out")
      ->required();
  verb->add_option("-o,--output", flags->output, "EXR to write")->required();
  verb->add_option(
          "--renderer", flags->renderer,
          "embree traces shadows, surroundings and AO; gl rasterises pixel centres without any of them in the way")
      ->check(CLI::IsMember({"embree", "gl"}))
      ->capture_default_str();
  verb->add_option("--size", flags->size, "WIDTHxHEIGHT in pixels")->required();
  verb->add_option(
      "--camera", flags->camera,
      "glTF camera by name, eye=X,Y,Z;look=X,Y,Z;up=X,Y,Z;fov=DEGREES (vertical), or fit[:AZIMUTH,ELEVATION], "
      "which frames the scene from there (30,20)");
  verb->add_option("--samples", flags->samples, "Colour samples per pixel; embree 16, gl 1")
      ->check(CLI::Range(1, 65536));
  verb->add_option("--filter", flags->filter,
                   "With embree the pixel filter of the samples, box without: box, triangle, gaussian or "
                   "blackman-harris, each with :RADIUS in pixels to each side or without");
  verb->add_option("--environment", flags->environment,
                   "Surrounding radiance: R,G,B, or with embree a lat-long EXR (middle +x, top +y); none is black");
  verb->add_option("--shadows", flags->shadows, "Default: exact with embree, off with gl")
      ->check(CLI::IsMember({"exact", "off"}));
  verb->add_option("--ao-radius", flags->aoRadius, "Reach of ambient occlusion in metres, embree 1; 0 leaves AO out")
      ->check(notBelowZero());
  verb->add_option("--texture-filter", flags->textureFilter, "Default: mipmap with gl; embree filters by its samples")
      ->check(CLI::IsMember({"mipmap", "bilinear", "nearest"}));
  verb->add_option("--set", flags->overrides,
                   "MATERIAL.key=value: thin, collimation, coverage, additive, lowResolution, castsShadow")
      ->allow_extra_args(false);
  verb->add_option(
      "--asset-root", flags->assetRoot,
      "Folder whose files a glTF and an OpenColorIO config may name besides those under their own folders");
  verb->add_option("--unit", flags->unit, "Metres per scene unit")->check(aboveZero())->capture_default_str();
  verb->add_option("--lumens-per-watt", flags->lumensPerWatt, "glTF lights are photometric, renders are not")
      ->check(aboveZero())
      ->capture_default_str();
  verb->add_option("--device", flags->device, "EGL device by number, see inspect --devices");
  flags->time.addTo(*verb);
  flags->blur.addTo(*verb);
  verb->add_option("--aa", flags->passes,
                   "Of --shutter and of the lens: renders at times and points of their own, averaged; without it 16")
      ->check(CLI::Range(2, 4096));
  flags->colour.addTo(*verb, "Linear space to render in; auto is linear Rec.709, as glTF has it");
  flags->preview.addTo(*verb);
  flags->run.addTo(*verb);
  flags->sequence.addTo(*verb);
  verb->callback([verb, flags] {
    overFrames(*verb, flags->sequence, {flags->run.json, [&](const FrameRun& frame) { gbuffer(*flags, frame); }});
  });
}

}  // namespace pellucid::cli
