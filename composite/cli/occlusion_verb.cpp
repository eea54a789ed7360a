#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "composite/cli/number_checks.h"
#include "composite/cli/occlusion_layer.h"
#include "composite/cli/over_frames.h"
#include "composite/cli/results.h"
#include "composite/cli/verbs.h"
#include "composite/occlusion.h"
#include "composite/picture_occluders.h"
#include "composite/pipeline/shot.h"
#include "gbuffer/errors.h"
#include "gbuffer/side_files.h"

namespace pellucid::cli {
namespace {

struct OcclusionFlags {
  std::string opaque, layer, output;
  std::string layerBeauty, layerDepth, indirect, camera;
  std::string source = "auto", inference = "relative";
  double radius = 0.0, direct = 0.0;
  ReadFlags read;
  RunFlags run;
  SequenceFlags sequence;
};

// Depth and occlusion beside the rims: the file's own, and from depth where it has none.
OccluderPlanes occludersBeside(const OcclusionFlags& flags, const GBuffer& gbuffer, const FoliagePlanes& layer,
                               int form) {
  NearestSolids solids = nearestSolids(gbuffer, solidDepth(layer, gbuffer.data));
  OccluderSettings settings;
  settings.fromFile = flags.source != "screen";
  settings.screen.radius = flags.radius;
  const bool hasFile = !gbuffer.occlusion.empty();
  if (flags.source == "file" && !hasFile)
    throw MeaningError(fmt::format("{}: no AO: found none, expected a channel AO, or --source screen", flags.opaque));
  if (flags.source == "file" && solids.lacked > 0)
    throw MeaningError(
        fmt::format("{}: AO: found none for {} pixels of leaves that only {} holds, expected --source auto",
                    flags.opaque, solids.lacked, flags.layer));
  const Image<std::uint8_t> wanted = occludersWanted(layer, gbuffer.data, form);
  bool computes = !settings.fromFile || !hasFile;
  for (std::size_t i = 0; i < wanted.size() && !computes; ++i) computes = wanted[i] && solids.lacking[i];
  const Camera camera = computes ? chooseCamera(cameraChoice(flags.camera), gbuffer, Scene{}, flags.opaque) : Camera{};
  std::size_t pixels = 0;
  OccluderPlanes occluders = occludersOf(gbuffer, camera, std::move(solids), settings, &wanted, pixels);
  if (pixels > 0)
    note("{}: occlusion of {} pixels from depth alone{}", flags.opaque, pixels,
         settings.fromFile && hasFile ? ", where leaves stand that it lacks" : "");
  return occluders;
}

void occlusionVerb(const OcclusionFlags& flags, const FrameRun& frame) {
  const Threads threads(flags.run.threads);
  Stages stages;
  const OpaqueFile opaque =
      stages.time("read picture", [&] { return readThroughCamera(flags.opaque, flags.read.options(), flags.camera); });
  say(understoodLines(opaque));
  say(opaque.notes);
  const OpaqueFile layer = stages.time("read layer", [&] {
    ReadOptions options = flags.read.options();
    options.beautyLayer = flags.layerBeauty;
    options.depthFile = sideFileOf(flags.layerDepth);
    options.depthChannel = options.depthFile ? "" : flags.layerDepth;
    options.aovs.clear();
    return readFoliageLayer(flags.layer, options, flags.camera);
  });
  say(layer.notes);
  if (layer.gbuffer.display != opaque.gbuffer.display)
    throw MeaningError(fmt::format("{}: found a display window of {}x{} at ({}, {}), expected {}x{} at ({}, {}) of {}",
                                   flags.layer, layer.gbuffer.display.width(), layer.gbuffer.display.height(),
                                   layer.gbuffer.display.x0, layer.gbuffer.display.y0, opaque.gbuffer.display.width(),
                                   opaque.gbuffer.display.height(), opaque.gbuffer.display.x0,
                                   opaque.gbuffer.display.y0, flags.opaque));
  const Image<glm::vec3> indirect = indirectLight(layer, flags.indirect);
  const FoliagePlanes foliage = foliageOf(layer.gbuffer);
  const int form = flags.inference == "published" ? shading::PLD_OCCLUSION_PUBLISHED : shading::PLD_OCCLUSION_RELATIVE;
  const OccluderPlanes occluders =
      stages.time("occluders", [&] { return occludersBeside(flags, opaque.gbuffer, foliage, form); });
  const InferredOcclusion inferred = stages.time("infer", [&] { return inferOcclusion(foliage, occluders, form); });
  if (inferred.withoutDepth > 0)
    note("{}: {} of {} rim pixels have no depth and stay open", flags.layer, inferred.withoutDepth, inferred.rims);
  if (inferred.withoutSources > 0)
    note("{}: {} of {} rim pixels have nothing opaque beside them and {}", flags.layer, inferred.withoutSources,
         inferred.rims, form == shading::PLD_OCCLUSION_PUBLISHED ? "turn black, as published" : "stay open");
  Image<glm::vec4> beauty = layer.gbuffer.beauty;
  Image<std::uint8_t> touched;
  stages.time("apply",
              [&] { applyOcclusion(inferred.occlusion, indirect, static_cast<float>(flags.direct), beauty, touched); });
  const std::vector<ExtraLayer> added{{"", {{"occlusion", inferred.occlusion}}}};
  say(stages.time("write", [&] {
    return writePicture(flags.output, layer, beauty, touched, added,
                        frame.with({{kOcclusionAttribute, flags.inference}}));
  }));
  std::size_t changed = 0;
  for (std::size_t i = 0; i < touched.size(); ++i) changed += touched[i];
  nlohmann::json report = occlusionReport(inferred, foliage);
  report["output"] = flags.output;
  report["changed"] = changed;
  if (!flags.run.json) fmt::print("{} rim pixels, {} darkened\n", inferred.rims, changed);
  reportRun(flags.run, stages, {}, "CPU", report);
}

}  // namespace

void addOcclusion(CLI::App& app) {
  auto flags = std::make_shared<OcclusionFlags>();
  CLI::App* verb = app.add_subcommand("occlusion", "Infer ambient occlusion at the rims of a rendered foliage layer");
  verb->add_option("opaque", flags->opaque, "EXR with depth and, if it has one, an AO channel")->required();
  verb->add_option("layer", flags->layer, "EXR of the foliage: R G B A premultiplied, Z, indirect.R/G/B")->required();
  verb->add_option("-o,--output", flags->output, "EXR to write: the layer, its rims darkened, and 'occlusion'")
      ->required();
  flags->read.addTo(*verb);
  flags->run.addTo(*verb);
  verb->add_option("--layer-beauty", flags->layerBeauty, "Layer of the foliage's beauty in its file");
  verb->add_option("--layer-depth", flags->layerDepth, "Channel of the foliage's depth in its file");
  verb->add_option("--indirect", flags->indirect,
                   "Layer of the foliage's indirect light; beauty takes all of it for indirect. Without it a layer "
                   "named indirect or ambient");
  verb->add_option("--direct", flags->direct, "How much of the occlusion darkens direct light too")
      ->check(CLI::Range(0.0, 1.0))
      ->check(isNumber())
      ->capture_default_str();
  verb->add_option("--source", flags->source, "Occlusion of the opaque picture: its AO channel, or from its depth")
      ->check(CLI::IsMember({"auto", "file", "screen"}))
      ->capture_default_str();
  verb->add_option("--radius", flags->radius,
                   "Metres within which things occlude, from depth; a tenth of the depth "
                   "without it")
      ->check(aboveZero());
  verb->add_option("--inference", flags->inference, "published is PT17 listing 2 as printed")
      ->check(CLI::IsMember({"relative", "published"}))
      ->capture_default_str();
  verb->add_option("--camera", flags->camera,
                   "eye=X,Y,Z;look=X,Y,Z;up=X,Y,Z;fov=DEGREES, for occlusion from depth "
                   "where the file has no camera");
  flags->sequence.addTo(*verb);
  verb->callback([verb, flags] {
    overFrames(*verb, flags->sequence, {flags->run.json, [&](const FrameRun& frame) { occlusionVerb(*flags, frame); }});
  });
}

}  // namespace pellucid::cli
