// A glTF and nothing else: its opaque part by our own rays, its transparent part over it.
#include <memory>
#include <nlohmann/json.hpp>

#include "composite/cli/fog_flags.h"
#include "composite/cli/gbuffer_render.h"
#include "composite/cli/number_checks.h"
#include "composite/cli/results.h"
#include "composite/cli/verbs.h"
#include "composite/pipeline/compositor.h"
#include "gbuffer/atomic_file.h"

namespace pellucid::cli {
namespace {

constexpr int kSharedPasses = 8;  // as `composite` takes them

struct SceneRenderFlags {
  GbufferFlags opaque;  // what both steps read, too
  FogFlags fog;
  int passes = kSharedPasses;
  std::string thin = "auto";
};

// The second step: what `composite` does with the first one's file.
Request requestOver(const std::string& opaque, const SceneRenderFlags& flags, bool lit) {
  Request request;
  request.shot.opaque = opaque;
  request.shot.renderedHere = true;
  request.shot.inputs = flags.opaque.scenes;
  request.shot.scene.metresPerUnit = flags.opaque.unit;
  request.shot.scene.lumensPerWatt = flags.opaque.lumensPerWatt;
  request.shot.scene.overrides = flags.opaque.overrides;
  request.shot.scene.assetRoot = flags.opaque.assetRoot;
  request.shot.scene.closedGlass = flags.thin == "auto";
  request.shot.surroundings = surroundingsChoice(flags.opaque.environment);
  request.shot.colour = flags.opaque.colour.request();
  request.passes = flags.passes;
  if (lit && flags.opaque.shadows != "off") request.shadows.source = ShadowSource::rays;
  flags.fog.into(request);
  return request;
}

void render(const SceneRenderFlags& flags) {
  const Threads threads(flags.opaque.run.threads);
  validate(requestOver(flags.opaque.output, flags, true));
  Stages stages;
  // Lies beside the output while it is needed, and is removed however the run ends.
  const AtomicFile opaque(flags.opaque.output);
  bool lit = false;
  {
    const RenderedPart part = renderPart(flags.opaque, true, stages);
    lit = part.lights > 0;
    stages.time("write", [&] { writePart(opaque.temporary(), part, flags.opaque.renderer); });
  }
  const Request request = requestOver(opaque.temporary(), flags, lit);
  Compositor compositor(request, [](const std::string& note) { say(note); });
  const Result result = compositor.run(request);
  for (const auto& [name, seconds] : result.stages.seconds()) stages.add(name, seconds);
  nlohmann::json report{{"output", flags.opaque.output}, {"method", request.method}};
  reportSpace(compositor.shot().opaque.space, report);
  say(stages.time("write", [&] { return compositor.write(flags.opaque.output, result); }));
  flags.opaque.preview.write(request.shot.colour, request.shot.scene.assetRoot, compositor.shot().opaque.space,
                             result.picture.rgba);
  reportRun(flags.opaque.run, stages, result.counts, result.device, report);
}

}  // namespace

void addRender(CLI::App& app) {
  auto flags = std::make_shared<SceneRenderFlags>();
  CLI::App* verb = app.add_subcommand(
      "render",
      "A glTF and nothing else: renders its opaque part, and composites its transparent part onto it, with "
      "shadows and surroundings");
  GbufferFlags& opaque = flags->opaque;
  opaque.size = "1280x720";
  opaque.environment = "0.5,0.5,0.5";
  verb->add_option("scenes", opaque.scenes, "glTF or GLB")->required();
  verb->add_option("-o,--output", opaque.output, "EXR to write")->required();
  verb->add_option("--size", opaque.size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  verb->add_option("--camera", opaque.camera,
                   "glTF camera by name, eye=X,Y,Z;look=X,Y,Z;up=X,Y,Z;fov=DEGREES (vertical), or "
                   "fit[:AZIMUTH,ELEVATION]; without it the scene's only one, else fit:30,20, which frames the scene");
  verb->add_option("--environment", opaque.environment, "Surrounding radiance: R,G,B, or a lat-long EXR")
      ->capture_default_str();
  verb->add_option("--samples", opaque.samples, "Colour samples per pixel of the opaque part; without it 16")
      ->check(CLI::Range(1, 65536));
  verb->add_option("--aa", flags->passes, "Jittered passes of the transparent part, averaged")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  opaque.shadows = "exact";
  verb->add_option("--shadows", opaque.shadows, "Shadows of opaque and of transparent things, by rays")
      ->check(CLI::IsMember({"exact", "off"}))
      ->capture_default_str();
  flags->fog.addTo(*verb);
  verb->add_option("--set", opaque.overrides,
                   "MATERIAL.key=value: thin, collimation, coverage, additive, lowResolution, castsShadow")
      ->allow_extra_args(false);
  addThinFlag(*verb, flags->thin);
  verb->add_option("--asset-root", opaque.assetRoot,
                   "Folder whose files a glTF may name besides those under its own folder");
  verb->add_option("--scene-unit", opaque.unit,
                   "Metres in one unit of the glTF and of the grids of fog; --fog is in metres")
      ->check(aboveZero())
      ->capture_default_str();
  verb->add_option("--lumens-per-watt", opaque.lumensPerWatt, "glTF lights are photometric, renders are not")
      ->check(aboveZero())
      ->capture_default_str();
  opaque.colour.addTo(*verb, "Linear space to render in; auto is linear Rec.709, as glTF has it");
  opaque.preview.addTo(*verb);
  opaque.run.addTo(*verb);
  verb->callback([flags] { render(*flags); });
}

}  // namespace pellucid::cli
