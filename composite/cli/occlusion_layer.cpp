#include "composite/cli/occlusion_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "composite/cli/options.h"
#include "composite/pipeline/shot.h"
#include "gbuffer/channels.h"
#include "gbuffer/depth_kind.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

// What is said of any picture names its flags; those of the layer are called otherwise.
std::string saidOfLayer(const std::string& text) {
  static const std::regex beauty("--beauty(?![-\\w])"), depth("--depth(?![-\\w])");
  return std::regex_replace(std::regex_replace(text, beauty, "--layer-beauty"), depth, "--layer-depth");
}

}  // namespace

OpaqueFile readThroughCamera(const std::string& path, const ReadOptions& options, const std::string& camera) {
  if (options.depthKind.empty() || !needsCamera(parseDepthKind(options.depthKind))) return readOpaque(path, options);
  ReadOptions framing = options;
  framing.framingAlone = true;
  OpaqueFile first = readOpaque(path, framing);
  const Camera chosen = chooseCamera(cameraChoice(camera), first.gbuffer, Scene{}, path, first.cameraRefusal);
  return interpretOpaque(std::move(first.document), options, &chosen);
}

OpaqueFile readFoliageLayer(const std::string& path, const ReadOptions& options, const std::string& camera) {
  OpaqueFile layer = [&] {
    try {
      return readThroughCamera(path, options, camera);
    } catch (const Error& error) {
      throw Error(error.exitCode(), saidOfLayer(error.what()));
    }
  }();
  for (std::string& note : layer.notes) note = saidOfLayer(note);
  if (!layer.gbuffer.hasAlpha)
    throw MeaningError(fmt::format("{}: no coverage: found a beauty without A, expected R, G, B and A", path));
  const ExrPart& part = layer.document.parts[static_cast<std::size_t>(layer.choice.beautyPart)];
  if (part.text(kOcclusionAttribute))
    throw MeaningError(fmt::format("{}: found {} '{}', expected a layer whose rims are not occluded yet", path,
                                   kOcclusionAttribute, *part.text(kOcclusionAttribute)));
  if (part.find("occlusion"))
    throw MeaningError(fmt::format("{}: found a channel 'occlusion', expected that name free for the result", path));
  return layer;
}

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

FoliagePlanes foliageOf(const GBuffer& layer) {
  FoliagePlanes foliage;
  foliage.data = layer.data;
  foliage.viewZ = layer.viewZ;
  foliage.coverage = Image<float>(foliage.viewZ.width(), foliage.viewZ.height());
  for (std::size_t i = 0; i < foliage.coverage.size(); ++i) foliage.coverage[i] = layer.beauty[i].a;
  return foliage;
}

nlohmann::json occlusionReport(const InferredOcclusion& inferred, const FoliagePlanes& foliage) {
  double sum = 0.0;
  for (std::size_t i = 0; i < inferred.occlusion.size(); ++i)
    if (shading::isRim(foliage.coverage[i])) sum += static_cast<double>(inferred.occlusion[i]);
  return {{"rims", inferred.rims},
          {"withoutDepth", inferred.withoutDepth},
          {"withoutSources", inferred.withoutSources},
          {"meanOcclusion", inferred.rims ? sum / static_cast<double>(inferred.rims) : 1.0}};
}

}  // namespace pellucid::cli
