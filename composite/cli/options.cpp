#include "composite/cli/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "composite/cli/budget.h"
#include "composite/cli/number_checks.h"
#include "engine_bridge/scene/set_keys.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

SubmissionOrder parseOrder(const std::string& text) {
  SubmissionOrder order;
  if (text == "file") return order;
  if (text == "reverse") {
    order.kind = SubmissionOrder::reverse;
    return order;
  }
  const std::string key = "shuffle:";
  if (text.rfind(key, 0) == 0 && text.size() > key.size()) {
    order.kind = SubmissionOrder::shuffle;
    const auto [next, error] = std::from_chars(text.data() + key.size(), text.data() + text.size(), order.seed);
    if (error == std::errc() && next == text.data() + text.size()) return order;
  }
  throw UsageError(fmt::format("--order: found '{}', expected file, reverse or shuffle:SEED", text));
}

}  // namespace

void addThinFlag(CLI::App& verb, std::string& thin) {
  verb.add_option(
          "--thin", thin,
          "Glass of exporters that write no volumes, Blender's: auto takes balls and boxes as solid, file leaves "
          "everything the thin sheet that the file makes of it")
      ->check(CLI::IsMember({"auto", "file"}))
      ->capture_default_str();
}

void SceneFlags::addTo(CLI::App& verb) {
  verb.add_option(
          "--camera", cameras,
          "glTF camera by name, picture for the EXR's own, eye=X,Y,Z;look=X,Y,Z;up=X,Y,Z;fov=DEGREES (vertical), or "
          "fit[:AZIMUTH,ELEVATION], which "
          "frames the scene from there (30,20); VIEW=CAMERA is that of one view")
      ->allow_extra_args(false);
  verb.add_option("--environment", environment,
                  "Surroundings: radiance R,G,B or a lat-long EXR; without it the sky's median");
  verb.add_option("--set", overrides, "MATERIAL.key=value: " + gltf::setKeyNames())->allow_extra_args(false);
  addThinFlag(verb, thin);
  verb.add_option("--scene-unit", unit,
                  "Metres in one unit of the glTF and of the grids of fog; --fog is in metres; --unit is the picture's")
      ->check(aboveZero())
      ->capture_default_str();
  verb.add_option("--asset-root", assetRoot,
                  "Folder whose files a glTF and an OpenColorIO config may name besides those under their own folders");
  verb.add_option("--lumens-per-watt", lumensPerWatt, "glTF lights are photometric, renders are not")
      ->check(aboveZero())
      ->capture_default_str();
  verb.add_option("--texture-filter", textureFilter, "How textures are read where a texel is not a pixel")
      ->check(CLI::IsMember({"mipmap", "bilinear", "nearest"}))
      ->capture_default_str();
  verb.add_option("--mask", mask, "Edges of alpha-tested materials")
      ->check(CLI::IsMember({"smooth", "hard"}))
      ->capture_default_str();
  verb.add_option("--order", order, "Submission order: file, reverse or shuffle:SEED")->capture_default_str();
  verb.add_option("--budget", budget,
                  "Geometry resident at once, in bytes (64M, 2G; at least 1M): chunks, their GL buffers and pages of "
                  "the files. "
                  "--shadows exact decodes all triangles besides")
      ->capture_default_str();
  verb.add_option("--device", device, "EGL device by number, see inspect --devices");
  colour.addTo(
      verb,
      "Linear space of the picture's colours, into which those of the glTF are brought; auto goes by the EXR's "
      "chromaticities, the config's rules for files, the preset, and else takes linear Rec.709");
}

namespace {

// Pages of the files: more would only keep what has been drawn.
std::size_t pageBytes(std::size_t budget) {
  constexpr std::size_t kShare = 4, kMost = std::size_t{16} << 20;
  return std::min(budget / kShare, kMost);
}

}  // namespace

void SceneFlags::into(Request& request) const {
  const std::size_t bytes = parseBudget(budget), pages = pageBytes(bytes);
  SceneOptions& scene = request.shot.scene;
  scene.metresPerUnit = unit;
  scene.lumensPerWatt = lumensPerWatt;
  scene.overrides = overrides;
  scene.assetRoot = assetRoot;
  scene.closedGlass = thin == "auto";
  scene.streamBytes = pages;
  const std::string& view = request.shot.read.view;
  request.shot.camera = cameraOfView(cameras, view, {view});
  request.shot.surroundings = surroundingsChoice(environment);
  request.filter = textureFilter == "mipmap"     ? TextureFilter::mipmap
                   : textureFilter == "bilinear" ? TextureFilter::bilinear
                                                 : TextureFilter::nearest;
  request.mask = mask == "smooth" ? MaskEdge::smooth : MaskEdge::hard;
  request.residency.order = parseOrder(order);
  request.residency.budgetBytes = bytes - pages;
  request.device = device;
  request.shot.colour = colour.request();
}

void RunFlags::addTo(CLI::App& verb) {
  verb.add_option("--threads", threads, "0 uses every core")->check(CLI::Range(0, kMostThreads));
  verb.add_flag("--stats", stats, "Print counts and the time of every stage");
  verb.add_flag("--json", json, "Print results as JSON");
}

}  // namespace pellucid::cli
