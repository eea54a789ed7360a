#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "composite/cli/gbuffer_render.h"
#include "composite/cli/results.h"
#include "composite/cli/verbs.h"
#include "composite/pipeline/colour_step.h"
#include "composite/pipeline/shot.h"
#include "engine_bridge/scene/working_space.h"

namespace pellucid::cli {
namespace {

constexpr int kMostSamples = 65536;

// There is no picture yet to say it: linear Rec.709, unless --working-space names another.
ColourSpace spaceToRender(const GbufferFlags& flags) {
  const ColourRequest request = flags.colour.request();
  checkColours(request);
  const WorkingSpace colours(request);  // reads the config, whatever it is then asked for
  if (request.workingSpace == "auto") return {};
  std::vector<std::string> notes;
  return colours.of({}, flags.output, notes);
}

void gbuffer(const GbufferFlags& flags) {
  const Threads threads(flags.run.threads);
  Stages stages;
  const Window window = parseSize(flags.size);
  checkFilter(flags);
  SceneOptions options;
  options.metresPerUnit = flags.unit;
  options.lumensPerWatt = flags.lumensPerWatt;
  options.overrides = flags.overrides;
  options.assetRoot = flags.assetRoot;
  const ColourSpace space = spaceToRender(flags);
  flags.preview.check(flags.colour.request());
  Scene scene = stages.time("read scene", [&] { return loadScene(flags.scenes, options); });
  say(scene.notes);
  say(bringInto(scene, space.fromRec709));
  GBuffer frame;
  frame.display = frame.data = window;
  const Camera camera = chooseCamera(cameraChoice(flags.camera), frame, scene, flags.scenes.front());
  note("camera: {}", camera.origin);
  const auto opaque = std::count_if(scene.instances.begin(), scene.instances.end(), [&](const Instance& instance) {
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    return !scene.materials[static_cast<std::size_t>(primitive.material)].transparent();
  });
  if (opaque == 0) note("{}: nothing opaque is in the scene: the picture shows the surroundings", flags.scenes[0]);

  std::string device = "Embree";
  const OpaquePlanes planes = flags.renderer == "gl" ? rasterise(flags, scene, camera, window, stages, device)
                                                     : trace(flags, scene, camera, window, space, stages);
  if (flags.renderer == "gl" && !planes.lights.empty()) say("lights without shadows: --renderer embree traces them");
  std::map<std::string, std::string> attributes{{"pellucid:renderer", flags.renderer}};
  const PixelFilter filter = flags.filter.empty() ? PixelFilter() : parsePixelFilter(flags.filter);
  if (!filter.isPixelSquare()) attributes[kFilterAttribute] = filterText(filter);
  say(stages.time("write", [&] {
    return writeLayers(flags.output, window, window, layersOf(planes), attributes, &camera, false, nullptr,
                       chromaticitiesToWrite(space));
  }));
  nlohmann::json report{{"output", flags.output}, {"renderer", flags.renderer}, {"opaqueInstances", opaque}};
  reportSpace(space, report);
  flags.preview.write(flags.colour.request(), space, planes.beauty);
  std::size_t triangles = 0;
  for (const Instance& instance : scene.instances)
    triangles += scene.primitives[static_cast<std::size_t>(instance.primitive)].indices.size() / 3;
  RunCounts counts;
  counts.triangles = triangles;
  reportRun(flags.run, stages, counts, device, report);
}

}  // namespace

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
  verb->add_option("--camera", flags->camera,
                   "glTF camera by name, or eye=X,Y,Z;look=X,Y,Z;up=X,Y,Z;fov=DEGREES (vertical)");
  verb->add_option("--samples", flags->samples, "Colour samples per pixel; embree 16, gl 1")
      ->check(CLI::Range(1, kMostSamples));
  verb->add_option("--filter", flags->filter,
                   "With embree the pixel filter of the samples, box without: box, triangle, gaussian or "
                   "blackman-harris, each with :RADIUS in pixels to each side or without");
  verb->add_option("--environment", flags->environment,
                   "Surrounding radiance: R,G,B, or with embree a lat-long EXR (middle +x, top +y); none is black");
  verb->add_option("--shadows", flags->shadows, "Default: exact with embree, off with gl")
      ->check(CLI::IsMember({"exact", "off"}));
  verb->add_option("--ao-radius", flags->aoRadius, "Reach of ambient occlusion in metres, embree 1; 0 leaves AO out")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--texture-filter", flags->textureFilter, "Default: mipmap with gl; embree filters by its samples")
      ->check(CLI::IsMember({"mipmap", "bilinear", "nearest"}));
  verb->add_option("--set", flags->overrides,
                   "MATERIAL.key=value: thin, collimation, coverage, additive, lowResolution, castsShadow")
      ->allow_extra_args(false);
  verb->add_option("--asset-root", flags->assetRoot,
                   "Folder whose files a glTF may name besides those under its own folder");
  verb->add_option("--unit", flags->unit, "Metres per scene unit")->check(CLI::PositiveNumber)->capture_default_str();
  verb->add_option("--lumens-per-watt", flags->lumensPerWatt, "glTF lights are photometric, renders are not")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--device", flags->device, "EGL device by number, see inspect --devices");
  flags->colour.addTo(*verb, "Linear space to render in; auto is linear Rec.709, as glTF has it");
  flags->preview.addTo(*verb);
  flags->run.addTo(*verb);
  verb->callback([flags] { gbuffer(*flags); });
}

}  // namespace pellucid::cli
