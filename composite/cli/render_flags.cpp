#include "composite/cli/render_flags.h"

#include <fmt/format.h>

#include <algorithm>

#include "composite/cli/number_checks.h"
#include "composite/cli/system_flags.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

void addCommon(CLI::App& verb, RenderFlags& flags, bool allViews) {
  verb.add_option("opaque", flags.opaque, "EXR with beauty and depth")->required();
  verb.add_option("scenes", flags.inputs, "glTF, GLB or deep EXR with the transparent things")->required();
  flags.read.addTo(verb, allViews);
  flags.scene.addTo(verb);
  flags.time.addTo(verb);
  flags.shadow.addTo(verb);
  flags.fog.addTo(verb);
  verb.add_option("--particle-light", flags.particleLight,
                  "Texels along the longest edge of what tells particles how much of the lamps reaches them; 0: all "
                  "of it")
      ->check(CLI::Range(0, 512))
      ->capture_default_str();
}

void addWays(CLI::App& verb, RenderFlags& flags) {
  verb.add_option(
          "--tolerance", flags.tolerance,
          "Error to live with, proved for every pixel and channel of the mean of all passes: E times the larger of "
          "1 and the exact value, apart from the file's own rounding")
      ->check(notBelowZero());
  addSystemFlags(verb, flags.systems, flags.systemWeights);
  verb.add_flag("--measure", flags.measure, "Also composite the sorted truth and print the error against it");
}

}  // namespace

void RenderFlags::addTo(CLI::App& verb, const RenderVerb& what) {
  addCommon(verb, *this, what.allViews);
  foliage.addTo(verb, what.keepsRimsApart);
  if (what.weighs && what.precision) method.addTo(verb, what.listsToo, what.usual);
  if (what.weighs && !what.precision) method.addWeightTo(verb, true);
  if (what.bends) scatter.addTo(verb);
  if (what.weighs)
    lowResolutionOption_ =
        verb.add_option("--low-res", lowResolution,
                        "Draw materials marked lowResolution at 1/N of the resolution; 1 draws them like the others")
            ->check(CLI::IsMember({1, 2, 4, 8}))
            ->capture_default_str();
  passes = what.defaultPasses;
  ofOneMethod_ = what.precision;
  if (what.passes)
    passesOption_ = verb.add_option("--aa", passes, "Jittered passes, averaged; 1 samples pixel centres")
                        ->check(CLI::Range(1, 4096))
                        ->capture_default_str();
  if (what.blurs) blur.addTo(verb);
  if (what.edges) {
    verb.add_option("--filter", filter,
                    "Pixel filter of the picture, that --aa takes its places from: box, triangle, gaussian or "
                    "blackman-harris, each with :RADIUS in pixels to each side or without; else as the picture's "
                    "header or its program says, else box");
    edgesOption_ = verb.add_option("--edges", edges,
                                   "Pixels that the renderer filtered over an edge: resolve takes them apart into "
                                   "their two surfaces, which --aa composites at their own depths; off: one surface")
                       ->check(CLI::IsMember({"resolve", "off"}))
                       ->capture_default_str();
  }
  if (what.listsToo && what.weighs) stochastic.addTo(verb);
  if (what.listsToo && what.weighs && what.precision) addWays(verb, *this);
  if (!what.resolves) return;
  lookup.addTo(verb);
  lookup.addResolverTo(verb);
  selfModulation.addTo(verb);
  if (what.precision) addLayersOption(verb, layers);
}

void RenderFlags::paintInto(Request& request) const {
  method.into(request);
  request.passes = passes;
  request.supersampled = supersampled;
  if (supersampled > 1 && passesOption_->count() == 0)
    request.passes = std::max(1, passes / (supersampled * supersampled));
  if (!filter.empty()) request.pixelFilter = parsePixelFilter(filter);
  if (edgesOption_ && edgesOption_->count() > 0) request.edges = edges == "resolve" ? EdgeRule::resolve : EdgeRule::off;
  shadow.into(request);
  stochastic.into(request);
  if (ofOneMethod_) stochastic.expectRead({request.method}, "--method", request.shadows);
  const bool sums = paintsBy<PaintSums>(request);
  const auto* listed = std::get_if<PaintListed>(&request.paint);
  if (auto* cheapest = std::get_if<PaintCheapest>(&request.paint)) {
    if (!tolerance)
      throw UsageError("--method: found auto without --tolerance, expected the error to live with: --tolerance E");
    if (systems != "off")
      throw UsageError(
          "--method: found auto with --systems, expected one of them: passes for each system are a method");
    cheapest->tolerance = *tolerance;
  } else if (tolerance) {
    if (!sums && !(listed && (listed->method.name == "weighted" || listed->method.name == "blended")))
      throw UsageError(
          fmt::format("--tolerance: --method {} has no certificate, expected phenomenological, weighted or blended",
                      request.method));
    if (systems != "off")
      throw UsageError("--tolerance: found it with --systems, expected one of them: a tolerance sorts what needs it");
    if (listed && listed->method.name == "blended") {
      if (request.sums.weight || request.sums.fitWeight || !request.sums.weightFrom.empty())
        throw UsageError("--weight: found it with --method blended: its layers are not weighed");
      request.sums.weight = PassSettings().weight;
      request.sums.weight->kind = shading::PLD_WEIGHT_UNIFORM;
    }
    request.paint = PaintWithin{*tolerance};
  }
  systemsInto(request, systems, systemWeights);
}

Request RenderFlags::requestOfView(const std::string& view, const std::vector<std::string>& views) const {
  RenderFlags general = *this;
  general.scene.cameras.clear();
  Request request = general.request();
  request.shot.read.view = view;
  request.shot.camera = cameraOfView(scene.cameras, view, views);
  return request;
}

Request RenderFlags::request() const {
  Request request;
  request.shot.opaque = opaque;
  request.shot.inputs = inputs;
  request.shot.read = read.options();
  scene.into(request);
  request.shot.time = time.time();
  request.shutter = blur.shutterAsked();
  request.lens = blur.lens();
  paintInto(request);
  scatter.into(request);
  lookup.into(request);
  foliage.into(request);
  fog.into(request);
  request.particleLight = particleLight;
  request.sums.selfModulation = selfModulation.value();
  if (lowResolutionOption_ && lowResolutionOption_->count() > 0) request.lowResolution.factor = lowResolution;
  request.measure = measure;
  request.layers = layerNames(layers);
  return request;
}

}  // namespace pellucid::cli
