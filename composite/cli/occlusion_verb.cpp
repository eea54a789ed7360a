#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "composite/cli/results.h"
#include "composite/cli/verbs.h"
#include "composite/occluders.h"
#include "composite/occlusion.h"
#include "composite/pipeline/shot.h"
#include "gbuffer/channels.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

struct OcclusionFlags {
  std::string opaque, layer, output;
  std::string layerBeauty, layerDepth, indirect, camera;
  std::string source = "auto", inference = "relative";
  double radius = 0.0, direct = 0.0;
  ReadFlags read;
  RunFlags run;
};

constexpr const char* kAttribute = "pellucid:occlusion";

// The light of the layer that came from all around, premultiplied as its beauty is.
Image<glm::vec3> indirectLight(const OpaqueFile& layer, const std::string& wanted) {
  const Image<glm::vec4>& beauty = layer.gbuffer.beauty;
  Image<glm::vec3> light(beauty.width(), beauty.height(), glm::vec3(0.0f));
  if (wanted == "beauty") {
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = glm::vec3(beauty[i]);
    return light;
  }
  const std::vector<NamedChannel> channels = nameChannels(layer.document);
  std::vector<std::string> found;
  for (const NamedChannel& channel : channels) {
    const std::string name = channel.layers.empty() ? "" : channel.layers.back();
    const bool matches = wanted.empty() ? name == "indirect" || name == "ambient" : channel.layerName == wanted;
    if (matches && std::find(found.begin(), found.end(), channel.layerName) == found.end())
      found.push_back(channel.layerName);
  }
  if (found.size() != 1)
    throw MeaningError(
        fmt::format("{}: {} of indirect light: found {}, expected {}", layer.document.path,
                    found.empty() ? "no layer" : "more than one layer",
                    found.empty() ? listNames(channels, 12) : fmt::format("{} and {}", found[0], found[1]),
                    wanted.empty() ? "indirect.R, .G and .B, or --indirect NAME (beauty takes all light for indirect)"
                                   : wanted + ".R, .G and .B"));
  bool seen[3] = {};
  for (const NamedChannel& channel : channels) {
    if (channel.layerName != found[0]) continue;
    const std::string& suffix = channel.suffix;
    const int c = suffix == "r" || suffix == "red"     ? 0
                  : suffix == "g" || suffix == "green" ? 1
                  : suffix == "b" || suffix == "blue"  ? 2
                                                       : -1;
    if (c < 0) continue;
    const ExrPart& part = layer.document.parts[static_cast<std::size_t>(channel.part)];
    if (part.data != layer.gbuffer.data)
      throw MeaningError(fmt::format("{}: {}: found another data window than the beauty's, expected the same",
                                     layer.document.path, channel.fullName));
    for (std::size_t i = 0; i < light.size(); ++i) light[i][c] = channel.channel->at(i);
    seen[c] = true;
  }
  if (!seen[0] || !seen[1] || !seen[2])
    throw MeaningError(
        fmt::format("{}: {}: found a layer without R, G and B, expected all three", layer.document.path, found[0]));
  return light;
}

// What is said of any picture names its flags; those of the layer are called otherwise.
std::string saidOfLayer(const std::string& text) {
  static const std::regex beauty("--beauty(?![-\\w])"), depth("--depth(?![-\\w])");
  return std::regex_replace(std::regex_replace(text, beauty, "--layer-beauty"), depth, "--layer-depth");
}

OpaqueFile readLayer(const OcclusionFlags& flags) {
  ReadOptions options = flags.read.options();
  options.beautyLayer = flags.layerBeauty;
  options.depthChannel = flags.layerDepth;
  const bool converts = options.depthKind == "ray" || options.depthKind == "device";
  OpaqueFile layer = [&] {
    if (!converts) return readOpaque(flags.layer, options);
    // Through the camera of the layer's own file, or of the flag.
    ReadOptions windows = options;
    windows.depthKind = "planar";
    OpaqueFile first = readOpaque(flags.layer, windows);
    const Camera camera = chooseCamera(cameraChoice(flags.camera), first.gbuffer, Scene{}, flags.layer);
    return interpretOpaque(std::move(first.document), options, &camera);
  }();
  if (!layer.gbuffer.hasAlpha)
    throw MeaningError(fmt::format("{}: no coverage: found a beauty without A, expected R, G, B and A", flags.layer));
  const ExrPart& part = layer.document.parts[static_cast<std::size_t>(layer.choice.beautyPart)];
  if (part.text(kAttribute))
    throw MeaningError(fmt::format("{}: found {} '{}', expected a layer whose rims are not occluded yet", flags.layer,
                                   kAttribute, *part.text(kAttribute)));
  if (part.find("occlusion"))
    throw MeaningError(
        fmt::format("{}: found a channel 'occlusion', expected that name free for the result", flags.layer));
  return layer;
}

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

void occlusionVerb(const OcclusionFlags& flags) {
  const Threads threads(flags.run.threads);
  Stages stages;
  OpaqueFile opaque = stages.time("read picture", [&] {
    ReadOptions options = flags.read.options();
    const bool converts = options.depthKind == "ray" || options.depthKind == "device";
    if (!converts) return readOpaque(flags.opaque, options);
    options.depthKind = "planar";
    OpaqueFile first = readOpaque(flags.opaque, options);
    const Camera camera = chooseCamera(cameraChoice(flags.camera), first.gbuffer, Scene{}, flags.opaque);
    return interpretOpaque(std::move(first.document), flags.read.options(), &camera);
  });
  say(opaque.notes);
  OpaqueFile layer = stages.time("read layer", [&] {
    try {
      return readLayer(flags);
    } catch (const Error& error) {
      throw Error(error.exitCode(), saidOfLayer(error.what()));
    }
  });
  for (std::string& note : layer.notes) note = saidOfLayer(note);
  say(layer.notes);
  if (layer.gbuffer.display != opaque.gbuffer.display)
    throw MeaningError(fmt::format("{}: found a display window of {}x{} at ({}, {}), expected {}x{} at ({}, {}) of {}",
                                   flags.layer, layer.gbuffer.display.width(), layer.gbuffer.display.height(),
                                   layer.gbuffer.display.x0, layer.gbuffer.display.y0, opaque.gbuffer.display.width(),
                                   opaque.gbuffer.display.height(), opaque.gbuffer.display.x0,
                                   opaque.gbuffer.display.y0, flags.opaque));
  const Image<glm::vec3> indirect = indirectLight(layer, flags.indirect);
  FoliagePlanes foliage;
  foliage.data = layer.gbuffer.data;
  foliage.viewZ = layer.gbuffer.viewZ;
  foliage.coverage = Image<float>(foliage.viewZ.width(), foliage.viewZ.height());
  for (std::size_t i = 0; i < foliage.coverage.size(); ++i) foliage.coverage[i] = layer.gbuffer.beauty[i].a;

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
    return writePicture(flags.output, layer, beauty, touched, added, {{kAttribute, flags.inference}});
  }));
  std::size_t changed = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < touched.size(); ++i) changed += touched[i];
  for (std::size_t i = 0; i < inferred.occlusion.size(); ++i)
    if (shading::isRim(foliage.coverage[i])) sum += static_cast<double>(inferred.occlusion[i]);
  nlohmann::json report{{"output", flags.output},
                        {"rims", inferred.rims},
                        {"changed", changed},
                        {"withoutDepth", inferred.withoutDepth},
                        {"withoutSources", inferred.withoutSources},
                        {"meanOcclusion", inferred.rims ? sum / static_cast<double>(inferred.rims) : 1.0}};
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
      ->capture_default_str();
  verb->add_option("--source", flags->source, "Occlusion of the opaque picture: its AO channel, or from its depth")
      ->check(CLI::IsMember({"auto", "file", "screen"}))
      ->capture_default_str();
  verb->add_option("--radius", flags->radius,
                   "Metres within which things occlude, from depth; a tenth of the depth "
                   "without it")
      ->check(CLI::PositiveNumber);
  verb->add_option("--inference", flags->inference, "published is PT17 listing 2 as printed")
      ->check(CLI::IsMember({"relative", "published"}))
      ->capture_default_str();
  verb->add_option("--camera", flags->camera,
                   "eye=X,Y,Z;look=X,Y,Z;up=X,Y,Z;fov=DEGREES, for occlusion from depth "
                   "where the file has no camera");
  verb->callback([flags] { occlusionVerb(*flags); });
}

}  // namespace pellucid::cli
