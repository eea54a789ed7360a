#include "composite/pipeline/refusals.h"

#include "shaders/weights.h"

namespace pellucid {

bool Refusal::ofMethod() const {
  return std::string(with).find("{}") != std::string::npos;
}

bool weighs(const Request& request) {
  if (const auto* listed = std::get_if<PaintListed>(&request.paint)) return listed->method.method->weighs;
  if (const auto* systems = std::get_if<PaintSystems>(&request.paint))
    return !systems->method || systems->method->method->weighs;
  return paintsBy<PaintSums>(request) || paintsBy<PaintWithin>(request) || paintsBy<PaintCheapest>(request);
}

namespace {

// How layers are averaged, by what the request says.
bool normalises(const Request& request) {
  if (const auto* listed = std::get_if<PaintListed>(&request.paint)) return listed->method.method->normalises;
  if (const auto* systems = std::get_if<PaintSystems>(&request.paint))
    return !systems->method || systems->method->method->normalises;
  return paintsBy<PaintSums>(request) || paintsBy<PaintWithin>(request) || paintsBy<PaintCheapest>(request);
}
// The transparent pass's own sums: phenomenological, weighted and blended.
bool hasSums(const Request& request) {
  if (const auto* listed = std::get_if<PaintListed>(&request.paint))
    return listed->method.name == "weighted" || listed->method.name == "blended";
  return paintsBy<PaintSums>(request) || paintsBy<PaintCheapest>(request);
}
bool opensLens(const Request& request) {
  return request.lens.on() && request.lens.radius.value_or(1.0) > 0.0;
}
bool takesExact(const Request& request) {
  if (const auto* listed = std::get_if<PaintListed>(&request.paint)) return listed->method.method->takesExact;
  if (const auto* systems = std::get_if<PaintSystems>(&request.paint))
    return !systems->method || systems->method->method->takesExact;
  return true;
}
bool readsRange(const SumsRequest& sums) {
  if (sums.fitWeight || !sums.weight) return true;
  const DepthWeight* row = depthWeightOf(sums.weight->kind);
  return row && row->readsRange;
}
bool readsReference(const SumsRequest& sums) {
  if (sums.fitWeight) return true;
  const DepthWeight* row = sums.weight ? depthWeightOf(sums.weight->kind) : nullptr;
  return row && row->reference != WeightReference::none;
}
bool asksPlanesOf(const Request& request) {
  for (const LayerName name : request.layers)
    if (name == LayerName::depth || name == LayerName::weight || name == LayerName::count) return true;
  return false;
}
bool tracesSamples(const Request& request) {
  const auto* samples = std::get_if<PaintSamples>(&request.paint);
  return samples && samples->settings.samples % request.passes != 0;
}

}  // namespace

const std::vector<Refusal>& refusals() {
  static const std::vector<Refusal> table{
      {"--weight", "a weight", "--method {}", "none, or a method that weighs", "its layers are not weighed",
       [](const Request& r) { return (r.sums.weight || r.sums.fitWeight) && !weighs(r); }},
      {"--weight-range", "a range", "--method {}", "none, or a method that weighs", "its layers are not weighed",
       [](const Request& r) { return r.sums.weightRange && !weighs(r); }},
      {"--weight-range", "a range", "a weight without one", "eq5, eq10, eq10z or linear", "the others read no range",
       [](const Request& r) { return r.sums.weightRange && weighs(r) && !readsRange(r.sums); }},
      {"--weight-reference", "a depth", "--method {}", "none, or a method that weighs", "its layers are not weighed",
       [](const Request& r) { return r.sums.weightReference && !weighs(r); }},
      {"--weight-reference", "a depth", "a weight without one",
       "power:K, fig6, eq7 to eq9, eq7z to eq9z, fig1 or fig10:K", "the others read none",
       [](const Request& r) { return r.sums.weightReference && weighs(r) && !readsReference(r.sums); }},
      {"--weight-from", "a file", "--method {}", "none, or a method that weighs", "its layers are not weighed",
       [](const Request& r) { return !r.sums.weightFrom.empty() && !weighs(r); }},
      {"--weight-from", "a file", "--weight, --weight-range or --weight-reference", "one or the other",
       "the file says all three",
       [](const Request& r) {
         return !r.sums.weightFrom.empty() &&
                (r.sums.weight || r.sums.fitWeight || r.sums.weightRange || r.sums.weightReference);
       }},
      {"--system-weight", "a weight", "--method {}", "none, or a method that weighs", "its layers are not weighed",
       [](const Request& r) {
         const auto* systems = std::get_if<PaintSystems>(&r.paint);
         return systems && !systems->weights.empty() && !weighs(r);
       }},
      {"--normalisation", "one", "--method {}", "none, or a method that normalises",
       "it averages in a way of its own, or not at all",
       [](const Request& r) { return r.sums.normalisation && !normalises(r); }},
      {"--self-modulation", "it", "--method {}", "none, or a method that is a weighted sum",
       "it corrects the weighted sum of the transparent pass, which is not made",
       [](const Request& r) { return r.sums.selfModulation && !hasSums(r); }},
      {"--precision", "published", "--tolerance", "float or exact", "its targets hold no bound of an error",
       [](const Request& r) { return r.tier == Tier::published && paintsBy<PaintWithin>(r); }},
      {"--precision", "published", "--systems", "float or exact", "its targets hold one pass over everything",
       [](const Request& r) { return r.tier == Tier::published && paintsBy<PaintSystems>(r); }},
      {"--precision", "published", "--method {}", "float or exact", "its targets hold the phenomenological sums alone",
       [](const Request& r) {
         return r.tier == Tier::published && !paintsBy<PaintSums>(r) && !paintsBy<PaintWithin>(r) &&
                !paintsBy<PaintSystems>(r);
       }},
      {"--precision", "published", "--normalisation spectral", "float or exact",
       "its targets have one denominator for all channels",
       [](const Request& r) {
         return r.tier == Tier::published && r.sums.normalisation == shading::PLD_NORMALISE_SPECTRAL;
       }},
      {"--precision", "exact", "--method unsorted", "float",
       "it composites in the order submitted, which exact promises not to show",
       [](const Request& r) { return r.tier == Tier::exact && !takesExact(r); }},
      {"--tolerance", "a tolerance", "--normalisation published", "spectral",
       "one denominator for all channels has no bound, and so no certificate",
       [](const Request& r) {
         return paintsBy<PaintWithin>(r) && r.sums.normalisation == shading::PLD_NORMALISE_PUBLISHED;
       }},
      {"--resolve", "gl", "--method {}", "cpu", "it has no sums to resolve",
       [](const Request& r) { return r.resolveOnDevice && !hasSums(r); }},
      {"--samples", "a number", "--aa", "a multiple of --aa", "every pass holds as many samples", tracesSamples},
      {"--filter", "a filter", "--aa 1", "none, or --aa 2 and more", "one pass samples pixel centres",
       [](const Request& r) { return r.pixelFilter && r.passes == 1; }},
      {"--edges", "resolve", "--aa 1", "off, or --aa 2 and more", "one pass sees one surface of a pixel",
       [](const Request& r) { return r.edges == EdgeRule::resolve && r.passes == 1; }},
      {"--edges", "resolve", "--lens-radius or --f-stop", "off", "what is out of focus has no edges to take apart",
       [](const Request& r) { return r.edges == EdgeRule::resolve && opensLens(r); }},
      {"--supersampled", "a number", "--tolerance", "none",
       "what is promised of every sample is no promise of their mean",
       [](const Request& r) { return r.supersampled > 1 && (paintsBy<PaintWithin>(r) || paintsBy<PaintCheapest>(r)); }},
      {"--shutter", "a time", "--aa 1", "--aa 2 and more", "each pass has one time",
       [](const Request& r) { return r.passes == 1 && r.shutter && r.shutter->close > r.shutter->open; }},
      {"--lens-radius or --f-stop", "a lens", "--aa 1", "--aa 2 and more", "each pass sees from one point of it",
       [](const Request& r) { return r.passes == 1 && opensLens(r); }},
      {"--gather", "exact", "--diffusion-kernel disc", "fast", "the disc has one gather, and its taps are few",
       [](const Request& r) { return r.lookup.exact && r.lookup.kernel == shading::PLD_DIFFUSE_DISC; }},
      {"--layers", "depth, weight or count", "--precision published", "float or exact", "its targets do not hold them",
       [](const Request& r) { return r.tier == Tier::published && asksPlanesOf(r); }},
      {"--occlusion", "apart", "--precision exact", "inferred, or --precision float",
       "rims are summed in floats, whose order shows",
       [](const Request& r) { return r.tier == Tier::exact && r.foliage.rule == FoliageRule::apart; }},
      {"--occlusion", "apart", "--precision published", "inferred, or --precision float", "rims are summed in floats",
       [](const Request& r) { return r.tier == Tier::published && r.foliage.rule == FoliageRule::apart; }},
  };
  return table;
}

void dropUnread(Request& request) {
  SumsRequest& sums = request.sums;
  if (!weighs(request)) {
    sums.weight.reset();
    sums.weightRange.reset();
    sums.weightReference.reset();
    sums.weightFrom.clear();
    sums.fitWeight = false;
    if (auto* systems = std::get_if<PaintSystems>(&request.paint)) systems->weights.clear();
  }
  if (request.passes == 1) {
    request.edges.reset();
    request.pixelFilter.reset();
    request.shutter.reset();
    request.lens = LensRequest();
  }
  const bool published = request.tier == Tier::published;
  if (!normalises(request) || (published && sums.normalisation == shading::PLD_NORMALISE_SPECTRAL))
    sums.normalisation.reset();
  if (!hasSums(request)) {
    sums.selfModulation.reset();
    request.resolveOnDevice = false;
  }
}

void setWeight(Request& request, const shading::WeightSettings& weight) {
  if (!weighs(request)) return;
  request.sums.fitWeight = false;
  request.sums.weightFrom.clear();
  request.sums.weight = weight;
  request.sums.weightReference.reset();
  if (readsReference(request.sums)) request.sums.weightReference = static_cast<double>(weight.reference);
  if (readsRange(request.sums))
    request.sums.weightRange = {static_cast<double>(weight.rangeNear), static_cast<double>(weight.rangeFar)};
  else
    request.sums.weightRange.reset();
}

}  // namespace pellucid
