#include "engine_bridge/c/pass_permutation.h"

#include <charconv>
#include <cmath>

#include "shaders/plane_defines.h"

namespace pellucid::c {
namespace {

// Nine digits give back the same float, with a point in every locale. In brackets: it may be negative.
std::string literal(const char* name, float x) {
  char digits[40];
  const char* end = std::to_chars(digits, digits + sizeof(digits), x, std::chars_format::scientific, 8).ptr;
  return std::string(name) + " (" + std::string(digits, static_cast<std::size_t>(end - digits)) + "f)";
}

void defineFixed(const Permutation& p, pld_stage stage, std::vector<std::string>& defines) {
  const pld_frame& frame = p.fixed;
  const auto has = [&](pld_fixed field) { return (p.fixedFields & static_cast<uint32_t>(field)) != 0; };
  if (has(PLD_FIXED_UNITS)) defines.push_back(literal("UNITS", frame.metres_per_unit));
  if (has(PLD_FIXED_EXPOSURE)) defines.push_back(literal("EXPOSURE", frame.pre_exposure));
  if (has(PLD_FIXED_PROJECTION))
    defines.emplace_back(isOrthographic(frame.projection) ? "ORTHOGRAPHIC 1" : "ORTHOGRAPHIC 0");
  if (has(PLD_FIXED_WEIGHT)) {
    defines.push_back(literal("RANGE_NEAR", frame.weight_near));
    defines.push_back(literal("RANGE_FAR", frame.weight_far));
    defines.push_back(literal("EXPONENT", frame.weight_exponent));
    defines.push_back(literal("REFERENCE", referenceOf(frame)));
  }
  if (has(PLD_FIXED_REFRACTION)) {
    defines.push_back("REFRACT " + std::to_string(static_cast<int>(frame.refract)));
    defines.push_back(literal("REFRACT_DISTANCE", frame.refract_distance));
  }
  if (has(PLD_FIXED_LENS) && stage != PLD_STAGE_LOW) {  // where it depends on low_factor
    const Focal focal = focalOf(frame, 1);
    defines.push_back(literal("FOCAL_X", focal.x));
    defines.push_back(literal("FOCAL_Y", focal.y));
  }
  if (has(PLD_FIXED_DIFFUSION)) {
    defines.push_back(literal("DIFFUSION_K0", frame.diffusion_k0));
    defines.push_back(literal("DIFFUSION_K1", frame.diffusion_k1));
  }
}

PlaneStage planeStageOf(pld_stage stage) {
  switch (stage) {
    case PLD_STAGE_SOLIDS:
      return PlaneStage::solids;
    case PLD_STAGE_FRONT:
      return PlaneStage::front;
    case PLD_STAGE_RIMS:
      return PlaneStage::rims;
    default:
      return PlaneStage::layers;
  }
}

const char* nameOf(LayerPart part) {
  switch (part) {
    case LayerPart::published:
      return "PLD_TIER_PUBLISHED";
    case LayerPart::exact:
      return "PLD_TIER_EXACT";
    case LayerPart::sorted:
      return "PLD_METHOD_OVER";
    case LayerPart::front:
      return "PLD_METHOD_FRONT_TAIL";
    case LayerPart::dispersion:
      return "PLD_FEATURE_DISPERSION";
    case LayerPart::refraction:
      return "PLD_FEATURE_REFRACTION";
    case LayerPart::lowResolution:
      return "PLD_FEATURE_LOW_RESOLUTION";
    default:
      return "PLD_FEATURE_REFRACTION or PLD_FEATURE_DIFFUSION";
  }
}

std::string refusalOfMarks(const Permutation& p) {
  const bool depths = p.has(PLD_FEATURE_DEPTHS);
  if (p.published() && (depths || p.marked()))
    return std::string("found ") +
           (depths      ? "PLD_FEATURE_DEPTHS"
            : p.moves() ? "PLD_FEATURE_MOTION"
                        : "PLD_FEATURE_IDENTITY") +
           " with PLD_TIER_PUBLISHED, which has the planes of its paper and no other";
  if (depths && p.lowOver())
    return "found PLD_FEATURE_DEPTHS with PLD_FEATURE_LOW_RESOLUTION and PLD_METHOD_FRONT_TAIL, which keep no depth of "
           "what lies over the nearest layer";
  if (p.marked() && !hasRoomForMarks(modelOf(p)))
    return "found PLD_FEATURE_MOTION or PLD_FEATURE_IDENTITY with features whose planes take all eight targets: "
           "expected PLD_TIER_EXACT, or one of PLD_FEATURE_OUTPUTS, PLD_FEATURE_DEPTHS, PLD_FEATURE_LIGHT, "
           "PLD_FEATURE_COLOURED and PLD_FEATURE_DISPERSION less";
  return {};
}

// Every stage takes what a surface tells, so that one material serves all of them; two keep it.
void defineMarks(const Permutation& p, pld_stage stage, std::vector<std::string>& defines) {
  const bool layers = stage == PLD_STAGE_LAYERS, solids = stage == PLD_STAGE_SOLIDS;
  const auto define = [&](const char* name, bool wanted) {
    if (wanted) defines.emplace_back(name);
  };
  define("PLD_MARKS", true);
  if (p.exact() && (layers || solids)) defines.push_back(marksPlace(p));
  define("MARKS_HERE", layers && !p.exact());
  define("MOTION", layers && !p.exact() && p.moves());
  define("NEAREST_HERE", layers && !p.exact() && p.named());
  if (!p.exact() && (layers || solids))
    defines.push_back(markOutputs(modelOf(p), layers ? PlaneStage::marks : PlaneStage::solidMarks));
  else
    define("MARK_OUTPUTS", true);
}

}  // namespace

bool isPerspective(const float* p) {
  return p[3] == 0.0f && p[7] == 0.0f && p[11] == -1.0f && p[15] == 0.0f;
}
bool isOrthographic(const float* p) {
  return p[3] == 0.0f && p[7] == 0.0f && p[11] == 0.0f && p[15] == 1.0f;
}

float referenceOf(const pld_frame& frame) {
  return frame.weight_reference > 0.0f ? frame.weight_reference : 1.0f;
}

Focal focalOf(const pld_frame& frame, int pixelsATexel) {
  // Offsets are in pixels a metre where nothing converges.
  const float scale =
      (isOrthographic(frame.projection) ? 1.0f / frame.metres_per_unit : 1.0f) / static_cast<float>(pixelsATexel);
  return {std::fabs(frame.projection[0]) * (0.5f * static_cast<float>(frame.width)) * scale,
          std::fabs(frame.projection[5]) * (0.5f * static_cast<float>(frame.height)) * scale};
}

const uint32_t kEveryFeature = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT | PLD_FEATURE_REFRACTION |
                               PLD_FEATURE_DIFFUSION | PLD_FEATURE_DISPERSION | PLD_FEATURE_SOLIDS | PLD_FEATURE_RIMS |
                               PLD_FEATURE_LOW_RESOLUTION | PLD_FEATURE_OUTPUTS | PLD_FEATURE_DEPTHS |
                               PLD_FEATURE_MOTION | PLD_FEATURE_IDENTITY;

LayerModel modelOf(const Permutation& p) {
  LayerModel model;
  model.tier = p.exact()                 ? PlaneTier::exact
               : p.published()           ? PlaneTier::published
               : p.tier == PLD_TIER_HALF ? PlaneTier::half
                                         : PlaneTier::float32;
  model.weight = static_cast<int>(p.weight);
  model.coloured = p.has(PLD_FEATURE_COLOURED);
  model.addsLight = p.light();
  model.refracts = p.has(PLD_FEATURE_REFRACTION);
  model.diffuses = p.has(PLD_FEATURE_DIFFUSION);
  model.disperses = p.has(PLD_FEATURE_DISPERSION);
  model.sorted = p.sorted();
  model.front = p.fronts();
  model.nearestDepths = p.atLowResolution || ((p.outputs() || p.has(PLD_FEATURE_DEPTHS)) && !p.sorted());
  model.solids = p.has(PLD_FEATURE_SOLIDS);
  model.rims = p.rimsApart();
  model.lowResolution = p.low() && !p.atLowResolution;
  model.moves = p.moves() && !p.atLowResolution;
  model.named = p.named() && !p.atLowResolution;
  return model;
}

std::string lostLight() {
  return "found PLD_FEATURE_LIGHT in PLD_TIER_PUBLISHED, which keeps no plane for light that adds: it is lost";
}

std::string refusalOf(const Permutation& p, bool maybeLight) {
  if (p.published() && p.fronts())
    return "found PLD_TIER_PUBLISHED with PLD_METHOD_FRONT_TAIL, whose nearest layer it keeps no plane for: expected "
           "PLD_TIER_FLOAT, PLD_TIER_HALF or PLD_TIER_EXACT";
  if (p.losesLight() && !maybeLight) return lostLight();
  if (p.scatters() && p.method == PLD_METHOD_WEIGHTED)
    return "features: found refraction or diffusion, expected them with PLD_METHOD_PHENOMENOLOGICAL alone";
  if (p.outputs() && p.published())
    return "found PLD_FEATURE_OUTPUTS with PLD_TIER_PUBLISHED, which keeps no depth of a layer";
  if (std::string refusal = refusalOfMarks(p); !refusal.empty()) return refusal;
  const LayerConflict conflict = conflictOf(modelOf(p));
  if (!conflict) return {};
  return std::string("found ") + nameOf(conflict.part) + (conflict.without ? " without " : " with ") +
         nameOf(conflict.other) + (conflict.reason[0] ? ", " : "") + conflict.reason;
}

std::vector<PlaneSpec> planesOf(const Permutation& p) {
  return pellucid::planesOf(modelOf(p));
}

std::vector<std::string> seamDefines(const Permutation& p, pld_stage stage) {
  const bool low = stage == PLD_STAGE_LOW, layers = stage == PLD_STAGE_LAYERS;
  const LayerModel model = low ? atLowResolution(modelOf(p)) : modelOf(p);
  // Of the exact tier a stage lists fragments, and gl/exact_fold.frag has the planes.
  std::vector<std::string> defines = p.exact() ? weightDefines(model) : writeDefines(model, planeStageOf(stage));
  defines.emplace_back(p.rows == PLD_ROWS_DOWN ? "ROWS 1.0f" : "ROWS (-1.0f)");
  defineFixed(p, stage, defines);
  const auto define = [&](const char* name, bool wanted) {
    if (wanted) defines.emplace_back(name);
  };
  define("STAGE_SOLIDS", stage == PLD_STAGE_SOLIDS);
  define("STAGE_FRONT", stage == PLD_STAGE_FRONT);
  define("STAGE_RIMS", stage == PLD_STAGE_RIMS);
  define("RIMS", p.rims());
  define("RIMS_HERE", p.rimsInSeam() && layers);
  define("DEPTH_IN_SHADER", p.depth == PLD_DEPTH_LINEAR || stage == PLD_STAGE_SOLIDS || low);
  define("SOLIDS", stage != PLD_STAGE_SOLIDS && !low && p.has(PLD_FEATURE_SOLIDS));
  define("UNCOUNTED", p.published());
  define("REFRACTS", model.refracts && (layers || low));
  define("DIFFUSES", model.diffuses && (layers || low));
  if (p.marked()) defineMarks(p, stage, defines);
  if (!p.exact()) return defines;
  define("EXACT", true);
  define("LISTS_OFFSETS", listsOffsets(model, planeStageOf(stage)));
  define("SCATTER", model.scatters() && (layers || low));
  define("DISPERSION", model.disperses && (layers || low));
  return defines;
}

std::vector<std::string> foldDefines(const Permutation& p, pld_stage stage) {
  const LayerModel model = modelOf(p);
  std::vector<std::string> defines = writeDefines(model, planeStageOf(stage));
  if (stage == PLD_STAGE_RIMS) defines.emplace_back("STAGE_RIMS");
  if (listsOffsets(model, planeStageOf(stage))) defines.emplace_back("LISTS_OFFSETS");
  if (p.sorted() && p.has(PLD_FEATURE_SOLIDS)) defines.emplace_back("SOLIDS");
  return defines;
}

std::vector<std::string> marksDefines(const Permutation& p) {
  std::vector<std::string> defines;
  if (p.marked()) {
    defines.emplace_back("MARKS");
    defines.push_back(marksPlace(p));
  }
  if (p.reachesOpacity()) defines.emplace_back("DEPTHS");
  if (p.reachesOpacity() && p.has(PLD_FEATURE_SOLIDS)) defines.emplace_back("SOLIDS");
  return defines;
}

int listBlocks(const Permutation& p, pld_stage stage) {
  return pellucid::listBlocks(modelOf(p), planeStageOf(stage));
}

int listBlocks(const Permutation& p) {
  if (!p.exact()) return 0;
  int most = listBlocks(p, PLD_STAGE_LAYERS);
  if (p.rimsApart()) most = std::max(most, listBlocks(p, PLD_STAGE_RIMS));
  return most + (p.marked() ? 1 : 0);
}

const char* listName(const Permutation& p, int block) {
  return p.marked() && block == listBlocks(p) - 1 ? "PldMarks" : pellucid::listBlockName(block);
}

// Behind the blocks that the pass has besides.
std::string marksPlace(const Permutation& p) {
  return "LISTS_MARKS PLD_STORAGE_" + std::to_string(listBlocks(p) - 1);
}

std::vector<std::string> depthDefines(pld_depth depth, pld_clip clip) {
  if (depth == PLD_DEPTH_LINEAR) return {"DEPTH_IS_LINEAR"};
  const bool zeroToOne = clip == PLD_CLIP_ZERO_TO_ONE;
  return {zeroToOne ? "CLIP_SCALE 1.0f" : "CLIP_SCALE 2.0f", zeroToOne ? "CLIP_OFFSET 0.0f" : "CLIP_OFFSET (-1.0f)",
          depth == PLD_DEPTH_REVERSED ? "EMPTY 0.0f" : "EMPTY 1.0f"};
}

std::vector<std::string> resolveDefines(const Permutation& p, bool showsThrough) {
  std::vector<std::string> defines = readDefines(modelOf(p), showsThrough);
  for (const char* name : {"PART_OF_TEXTURE", "NEAREST_SAMPLERS", "NO_SELF_MODULATION"}) defines.emplace_back(name);
  if (!p.planarDepth()) defines.emplace_back("NO_DEPTH");
  if (!showsThrough || !p.has(PLD_FEATURE_DIFFUSION)) defines.emplace_back("NO_PYRAMID");
  return defines;
}

}  // namespace pellucid::c
