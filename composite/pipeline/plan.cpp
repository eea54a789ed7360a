#include "composite/pipeline/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "composite/antialias.h"
#include "composite/pipeline/default_weight.h"
#include "composite/pipeline/foliage_step.h"
#include "gbuffer/accum.h"
#include "gbuffer/errors.h"
#include "gbuffer/weight_text.h"

namespace pellucid {
namespace {

constexpr double kNearDefault = 0.1, kFarOverNear = 1e4;  // of a camera that states none, metres
// A pixel's veil, its mean and the picture; then the planes of a pass as floats.
constexpr std::uint64_t kVeilBytes = 2 * 60 + 16, kPlaneBytes = 128, kScatterBytes = 52;

// Where the transparent things begin, as the whole scene and the camera have it: powers of depth weigh 1 there. What is
// nearer than a 64th of the farthest would leave most of the others without a weight.
double referenceOf(const ShotFacts& facts, double rangeNear) {
  constexpr double kDeepest = 64.0;
  const double nearest = std::max(facts.layersNear, facts.layersFar / kDeepest);
  return nearest > 0.0 ? nearest : rangeNear;
}

// The range comes from the request, else from the camera.
shading::WeightSettings weightOf(const Request& request, const ShotFacts& facts) {
  const SumsRequest& sums = request.sums;
  shading::WeightSettings weight = sums.weight.value_or(PassSettings().weight);
  double rangeNear = facts.rangeNear > 0 ? facts.rangeNear : kNearDefault;
  double rangeFar = facts.rangeFar > rangeNear ? facts.rangeFar : rangeNear * kFarOverNear;
  if (sums.weightRange) std::tie(rangeNear, rangeFar) = *sums.weightRange;
  weight.rangeNear = static_cast<float>(rangeNear);
  weight.rangeFar = static_cast<float>(rangeFar);
  const DepthWeight* row = depthWeightOf(weight.kind);
  const bool overDepth = fitsWeight(request) || (row && row->reference == WeightReference::depth);
  weight.reference = static_cast<float>(sums.weightReference.value_or(overDepth ? referenceOf(facts, rangeNear) : 1.0));
  return weight;
}

// Those of systems: each as if it were the picture's.
void weighSystems(const Request& request, const ShotFacts& facts, Plan& plan) {
  auto* systems = std::get_if<PaintSystems>(&plan.paint);
  if (!systems) return;
  for (SystemWeight& each : systems->weights) {
    if (!each.weight || each.whole) continue;
    Request alone = request;
    alone.sums.weight = each.weight;
    alone.sums.fitWeight = false;
    each.weight = weightOf(alone, facts);
  }
}

PassSettings passOf(const Request& request, const ShotFacts& facts) {
  PassSettings pass;
  static_cast<ResidencySettings&>(pass) = request.residency;
  pass.filter = request.filter;
  pass.mask = request.mask;
  pass.scatter = request.scatter;
  pass.weight = weightOf(request, facts);
  const bool published = request.tier == Tier::published;
  pass.tier = published ? SumsTier::published : SumsTier::float32;
  pass.normalisation = request.sums.normalisation.value_or(published ? shading::PLD_NORMALISE_PUBLISHED
                                                                     : shading::PLD_NORMALISE_SPECTRAL);
  applyFoliage(request.foliage, pass.occlusion);
  return pass;
}

// Listed methods that are the transparent pass's own sums need no lists.
void chooseSums(Plan& plan) {
  const auto* listed = plan.as<PaintListed>();
  if (!listed) return;
  const std::string& name = listed->method.name;
  if (name == "blended") {
    plan.pass.weight.kind = shading::PLD_WEIGHT_UNIFORM;
    plan.pass.normalisation = shading::PLD_NORMALISE_SPECTRAL;
  }
  if (name == "weighted" || name == "blended") plan.paint = PaintSums{};
}

Route routeOf(const Plan& plan, const ShotFacts& facts) {
  if (plan.as<PaintSystems>()) return Route::systems;
  if (const auto* samples = plan.as<PaintSamples>()) return samples->onDevice ? Route::samplesOnDevice : Route::lists;
  if (!plan.as<PaintSums>() || plan.heldOut) return Route::lists;
  if (plan.counts && (plan.fog || plan.lowResolution > 1)) return Route::foldedSums;
  return plan.isExact() || plan.deepFiles || !facts.hasScene ? Route::foldedSums : Route::drawnSums;
}

// What the device cannot sample is sampled on the CPU: the same picture but for rounding.
void keepOffDevice(Plan& plan, const ShotFacts& facts) {
  auto* samples = std::get_if<PaintSamples>(&plan.paint);
  if (!samples || !samples->onDevice) return;
  const char* why = plan.deepFiles || !facts.hasScene ? "deep samples are no triangles"
                    : plan.fog                        ? "fog is no triangle"
                    : plan.heldOut                    ? "a deep picture holds layers out sample by sample"
                    : plan.lowResolution > 1          ? "layers at low resolution are no triangles"
                                                      : nullptr;
  if (!why) return;
  samples->onDevice = false;
  plan.notes.push_back(
      fmt::format("--sampled-on gl: {}, so the CPU samples them: the same picture but for rounding", why));
}

int lowResolutionOf(const Request& request, const ShotFacts& facts) {
  const bool asked = request.lowResolution.factor.value_or(1) > 1;
  if (asked && !facts.marksLowResolution)
    throw UsageError(
        fmt::format("--low-res: found {}, but no transparent material is marked; expected --set "
                    "MATERIAL.lowResolution=true",
                    *request.lowResolution.factor));
  return facts.marksLowResolution ? request.lowResolution.factor.value_or(LowResolutionRequest::kDefault) : 1;
}

// As asked for; else as the picture was taken, where something moves and several passes can have their times.
void chooseShutter(const Request& request, const ShotFacts& facts, Plan& plan) {
  plan.shutter = request.shutter;
  if (plan.shutter || !facts.moves || plan.passes == 1) return;
  if (facts.shutter && (facts.shutter->open != 0.0 || facts.shutter->close != 0.0)) {
    plan.shutter = Shutter{facts.shutter->open, facts.shutter->close, false};
    plan.notes.push_back(fmt::format("shutter: {} by attribute {}; --shutter 0:0 keeps everything at the frame's time",
                                     shutterText(*facts.shutter), kShutterAttribute));
  } else if (facts.exposure) {
    plan.notes.push_back(
        fmt::format("shutter: attribute expTime says {0:.4g} frames but not when, and nothing is blurred; --shutter "
                    "{1:.4g}:{2:.4g} "
                    "does so about the frame",
                    *facts.exposure, -0.5 * *facts.exposure, 0.5 * *facts.exposure));
  }
}

bool movesPicture(const Request& request, const ShotFacts& facts, const std::optional<Shutter>& shutter) {
  const bool byCamera = shutter && shutter->opens() && facts.cameraMoves && !shutter->holdsCamera;
  return byCamera || (request.lens.on() && request.lens.radius.value_or(1.0) > 0.0);
}

void noteBlur(const Request& request, const ShotFacts& facts, Plan& plan) {
  if (plan.shutter && plan.shutter->opens() && !facts.moves)
    plan.notes.emplace_back("--shutter: nothing in the glTF moves, so that every pass sees the same");
  if (!plan.pictureMoves) return;
  plan.notes.emplace_back(
      "the picture's one colour and one depth a pixel stand for all that passed there: what it shows in focus and at "
      "rest is composited exactly, and blurred things by the depth that the file gives them");
  if (request.edges == EdgeRule::resolve)
    plan.notes.emplace_back("--edges resolve: the picture's edges move with the camera, and are not taken apart");
}

// One pass samples pixel centres, whatever the picture was filtered by.
void chooseFilter(const Request& request, const ShotFacts& facts, Plan& plan) {
  if (plan.passes == 1) return;
  plan.pixelFilter = request.pixelFilter.value_or(facts.pixelFilter.value_or(PixelFilter()));
  if (!request.pixelFilter && facts.pixelFilter && !plan.pixelFilter.isPixelSquare())
    plan.notes.push_back(
        fmt::format("filter: {}, {}; --filter says otherwise", filterText(plan.pixelFilter), facts.pixelFilterBy));
}

}  // namespace

const char* nameOf(Route route) {
  switch (route) {
    case Route::drawnSums:
      return "sums that the device blends";
    case Route::foldedSums:
      return "sums that are added from fragment lists";
    case Route::lists:
      return "fragment lists";
    case Route::samplesOnDevice:
      return "samples that the device draws";
    case Route::systems:
      break;
  }
  return "a pass for each system";
}

Plan planFor(const Request& request, const ShotFacts& facts) {
  Plan plan;
  plan.method = request.method;
  plan.paint = request.paint;
  if (request.decided) {
    plan.methodReason = request.decided->reason;
    if (!request.decided->note.empty()) plan.notes.push_back(request.decided->note);
  }
  plan.tier = request.tier;
  plan.pass = passOf(request, facts);
  weighSystems(request, facts, plan);
  plan.fitsWeight = fitsWeight(request);
  if (plan.fitsWeight && !request.sums.fitWeight)
    plan.weightReason = "the default; planes of several shots that are to add up take one by --weight or --weight-from";
  plan.resolve.selfModulation = request.sums.selfModulation.value_or(plan.isPublished());
  plan.lookup = request.lookup;
  plan.resolvesOnDevice = request.resolveOnDevice;
  plan.heldOut = facts.deepPicture;
  plan.deepFiles = facts.deepFiles > 0;
  plan.fog = request.fog.on();
  plan.passes = request.passes;
  plan.supersampled = request.supersampled;
  chooseFilter(request, facts, plan);
  chooseShutter(request, facts, plan);
  plan.pictureMoves = movesPicture(request, facts, plan.shutter);
  noteBlur(request, facts, plan);
  plan.edges = !plan.pictureMoves && request.edges.value_or(EdgeRule::resolve) == EdgeRule::resolve &&
               plan.passes > 1 && !plan.heldOut;
  if (plan.heldOut && request.edges == EdgeRule::resolve)
    plan.notes.emplace_back("--edges resolve: a deep picture holds the surfaces of its edges apart already");
  plan.lowResolution = lowResolutionOf(request, facts);
  chooseSums(plan);
  keepOffDevice(plan, facts);
  plan.route = routeOf(plan, facts);
  if (plan.resolvesOnDevice && plan.heldOut) {
    plan.resolvesOnDevice = false;
    plan.notes.emplace_back("--resolve gl: each sample of a deep picture has sums of its own, which the CPU resolves");
  }
  const auto pixels = static_cast<std::uint64_t>(facts.width) * static_cast<std::uint64_t>(facts.height);
  plan.bytes = pixels * (kVeilBytes + kPlaneBytes + kScatterBytes) + plan.pass.budgetBytes;
  return plan;
}

Plan truthOf(const Plan& plan) {
  Plan truth = plan;
  truth.paint = PaintSorted{};
  truth.route = Route::lists;
  truth.fitsWeight = false;
  truth.resolvesOnDevice = false;
  truth.notes.clear();
  return truth;
}

Plan sumsPlanOf(const Plan& plan, const ShotFacts& facts) {
  Plan sums = plan;
  if (plan.as<PaintSorted>()) sums.method = "phenomenological";
  const auto* listed = plan.as<PaintListed>();
  if (listed && formulaOf(listed->method.name) != SumFormula::mean) {  // of plain sums, without a weight
    sums.pass.weight.kind = shading::PLD_WEIGHT_UNIFORM;
    sums.pass.normalisation = shading::PLD_NORMALISE_SPECTRAL;
    sums.counts = listed->method;
  }
  sums.paint = PaintSums{};
  sums.heldOut = false;
  sums.route = routeOf(sums, facts);
  return sums;
}

PassSettings samplePass(const PassSettings& pass, const Plan& plan, int index) {
  PassSettings sample = pass;
  sample.sample = samplePosition(index, plan.passes, plan.pixelFilter);
  sample.footprint = 1.0f / std::sqrt(static_cast<float>(plan.passes));
  if (plan.passes > 1) sample.footprint *= static_cast<float>(1.0 / plan.pixelFilter.peak());
  if (const auto* samples = plan.as<PaintSamples>()) sample.pieces = samples->settings.onObjects;
  return sample;
}

std::vector<std::string> describe(const Plan& plan, const ShotFacts& facts) {
  std::vector<std::string> lines;
  const auto say = [&](const char* what, const std::string& how) {
    lines.push_back(fmt::format("{:<12}{}", what, how));
  };
  say("method", plan.methodReason.empty() ? plan.method : fmt::format("{} ({})", plan.method, plan.methodReason));
  const auto* cheapest = plan.as<PaintCheapest>();
  say("painted by", cheapest ? fmt::format("sums where no pixel errs by more than {} of the larger of 1 and the truth, "
                                           "else the truth: probes and then every pixel decide",
                                           cheapest->tolerance)
                             : nameOf(plan.route));
  say("tier", plan.route == Route::lists && !plan.isExact() ? "double precision, pixel by pixel"
                                                            : std::string(tierRow(plan.tier).name));
  std::string layers = facts.hasScene ? fmt::format("{} triangles", facts.triangles) : "";
  const auto add = [&](const std::string& part) { layers += (layers.empty() ? "" : ", ") + part; };
  if (facts.deepFiles) add(fmt::format("{} deep {}", facts.deepFiles, facts.deepFiles == 1 ? "file" : "files"));
  if (plan.fog) add("fog");
  if (plan.lowResolution > 1) add(fmt::format("marked materials at 1/{} of the resolution", plan.lowResolution));
  say("layers", layers);
  if (plan.as<PaintSums>() || plan.as<PaintWithin>() || plan.as<PaintSystems>())
    say("weight", plan.fitsWeight ? fmt::format("fitted to the sorted truth on probe pixels{}",
                                                plan.weightReason.empty() ? "" : " (" + plan.weightReason + ")")
                                  : weightText(plan.pass.weight));
  say("picture", fmt::format("{}x{}, {}", facts.width, facts.height,
                             plan.heldOut ? "deep: each sample holds layers out" : "one depth a pixel"));
  say("passes", fmt::format("{}, each {}", plan.passes,
                            plan.route == Route::drawnSums || plan.route == Route::foldedSums
                                ? plan.resolvesOnDevice ? "resolved on the device" : "resolved on the CPU"
                                : "composited on the CPU"));
  if (plan.supersampled > 1)
    say("result", fmt::format("{}x{}, each pixel the mean of {} x {}", facts.width / plan.supersampled,
                              facts.height / plan.supersampled, plan.supersampled, plan.supersampled));
  if (plan.passes > 1) say("filter", filterText(plan.pixelFilter));
  say("edges", plan.edges ? "taken apart into their two surfaces" : "as pixels of one surface");
  say("memory", fmt::format("about {} MiB besides the picture", plan.bytes >> 20));
  for (const std::string& note : plan.notes) say("note", note);
  return lines;
}

}  // namespace pellucid
