#include "engine_bridge/c/permutation.h"

#include <charconv>
#include <cmath>
#include <limits>

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

}  // namespace

bool isPerspective(const float* p) {
  return p[3] == 0.0f && p[7] == 0.0f && p[11] == -1.0f && p[15] == 0.0f;
}
bool isOrthographic(const float* p) {
  return p[3] == 0.0f && p[7] == 0.0f && p[11] == 0.0f && p[15] == 1.0f;
}

Focal focalOf(const pld_frame& frame, int pixelsATexel) {
  // Offsets are in pixels a metre where nothing converges.
  const float scale =
      (isOrthographic(frame.projection) ? 1.0f / frame.metres_per_unit : 1.0f) / static_cast<float>(pixelsATexel);
  return {std::fabs(frame.projection[0]) * (0.5f * static_cast<float>(frame.width)) * scale,
          std::fabs(frame.projection[5]) * (0.5f * static_cast<float>(frame.height)) * scale};
}

std::string conflictOf(const Permutation& p) {
  if (p.published() && p.fronts())
    return "tier: found PLD_TIER_PUBLISHED with PLD_METHOD_FRONT_TAIL, expected float or half";
  if (p.published() && p.has(PLD_FEATURE_DISPERSION))
    return "features: found PLD_FEATURE_DISPERSION in PLD_TIER_PUBLISHED, which holds one offset for all channels";
  if (p.has(PLD_FEATURE_DISPERSION) && !p.has(PLD_FEATURE_REFRACTION))
    return "features: found PLD_FEATURE_DISPERSION without PLD_FEATURE_REFRACTION";
  if (p.scatters() && p.method != PLD_METHOD_PHENOMENOLOGICAL)
    return "features: found refraction or diffusion, expected them with PLD_METHOD_PHENOMENOLOGICAL alone";
  if (p.low() && p.published())
    return "features: found PLD_FEATURE_LOW_RESOLUTION in PLD_TIER_PUBLISHED, which keeps no depths to upsample by";
  if (p.lowOver() && p.exact())
    return "features: found PLD_FEATURE_LOW_RESOLUTION with PLD_METHOD_FRONT_TAIL in PLD_TIER_EXACT, which keeps no "
           "nearest depth for it";
  return {};
}

std::vector<std::string> scatterPlaces(const Permutation& p) {
  if (!p.scatters() || p.published() || p.atLowResolution) return {};
  return {p.diffuseInAlpha() ? "DIFFUSE_IN_ALPHA" : "NO_DIFFUSE"};
}

PlaneSpec nearestPlane() {
  constexpr float far = std::numeric_limits<float>::infinity();
  return {5, GL_R32F, 32, 9, BlendKind::minimum, {far, 0, 0, 0}};
}

std::vector<PlaneSpec> planesOf(const Permutation& p) {
  constexpr float far = std::numeric_limits<float>::infinity();
  if (p.published()) {
    std::vector<PlaneSpec> planes{{0, GL_RGBA16F, 64, 1, BlendKind::add, {0, 0, 0, 0}},
                                  {1, GL_RGBA8, 32, 2, BlendKind::product, {1, 1, 1, 0}}};
    if (p.scatters()) planes.push_back({2, GL_RG8_SNORM, 16, 8, BlendKind::add, {0, 0, 0, 0}});
    return planes;
  }
  const bool half = p.tier == PLD_TIER_HALF;
  const GLenum four = half ? GL_RGBA16F : GL_RGBA32F, two = half ? GL_RG16F : GL_RG32F;
  const int bits = half ? 64 : 128;
  std::vector<PlaneSpec> planes;
  const auto sum = [&](GLuint attachment, GLuint unit) {
    planes.push_back({attachment, four, bits, unit, BlendKind::add, {0, 0, 0, 0}});
  };
  // With the nearest layer that diffuses, where there is one.
  const auto sumAndNearest = [&](GLuint attachment, GLuint unit) {
    if (p.diffuseInAlpha())
      planes.push_back({attachment, four, bits, unit, BlendKind::alphaMinimum, {0, 0, 0, far}});
    else
      sum(attachment, unit);
  };
  sum(0, 1);
  if (p.lean() && p.grey() && !p.scatters()) {
    planes.push_back({1, two, bits / 2, 4, BlendKind::add, {0, 0, 0, 0}});
  } else if (p.lean() && p.grey()) {
    sumAndNearest(1, 4);
  } else if (p.lean()) {
    sum(1, 2);
    sumAndNearest(2, 4);
  } else if (p.grey()) {
    sumAndNearest(1, 3);
    planes.push_back({2, two, bits / 2, 4, BlendKind::add, {0, 0, 0, 0}});
  } else {
    sum(1, 2);
    sumAndNearest(2, 3);
    sum(3, 4);
  }
  if (p.light()) sum(4, 7);
  if (p.scatters()) {
    if (p.atLowResolution) planes.push_back({5, GL_RG32F, 64, 9, BlendKind::minimum, {far, far, 0, 0}});
    sum(6, 8);
  }
  if (p.has(PLD_FEATURE_DISPERSION)) sum(7, 10);
  if (p.fronts()) {
    sum(6, 8);
    if (p.grey())
      planes.push_back({7, half ? GLenum{GL_R16F} : GLenum{GL_R32F}, bits / 4, 10, BlendKind::add, {0, 0, 0, 0}});
    else
      sum(7, 10);
  }
  return planes;
}

std::vector<std::string> seamDefines(const Permutation& p, pld_stage stage) {
  std::vector<std::string> defines{"WEIGHT " + std::to_string(static_cast<int>(p.weight)), "NORMALISATION 0",
                                   p.rows == PLD_ROWS_DOWN ? "ROWS 1.0f" : "ROWS (-1.0f)"};
  defineFixed(p, stage, defines);
  const auto define = [&](const char* name, bool wanted) {
    if (wanted) defines.emplace_back(name);
  };
  const bool low = stage == PLD_STAGE_LOW, layers = stage == PLD_STAGE_LAYERS;
  define("STAGE_SOLIDS", stage == PLD_STAGE_SOLIDS);
  define("STAGE_FRONT", stage == PLD_STAGE_FRONT);
  define("STAGE_RIMS", stage == PLD_STAGE_RIMS);
  define("RIMS", p.rims());
  define("RIMS_HERE", p.rimsInSeam() && layers);
  define("DEPTH_IN_SHADER", p.depth == PLD_DEPTH_LINEAR || stage == PLD_STAGE_SOLIDS || low);
  define("SOLIDS", stage != PLD_STAGE_SOLIDS && !low && p.has(PLD_FEATURE_SOLIDS));
  define("EXACT", p.exact());
  define("LISTS_OFFSETS", p.exact() && listsOffsets(p, stage));
  define("PUBLISHED", p.published());
  define("UNCOUNTED", p.published());
  define("GREY", p.grey());
  define("LEAN", p.lean());
  define("HALF", p.tier == PLD_TIER_HALF && (layers || low));
  define("FRONT_TAIL", p.frontStage() && layers);
  define("SCATTER", p.scatters() && (layers || low));
  if (layers)
    for (const std::string& place : scatterPlaces(p)) defines.push_back(place);
  define("REFRACTS", p.has(PLD_FEATURE_REFRACTION) && (layers || low));
  define("DIFFUSES", p.has(PLD_FEATURE_DIFFUSION) && (layers || low));
  define("DISPERSION", p.has(PLD_FEATURE_DISPERSION) && (layers || low));
  return defines;
}

bool listsOffsets(const Permutation& p, pld_stage stage) {
  return stage == PLD_STAGE_RIMS || (stage != PLD_STAGE_SOLIDS && p.scatters());
}

std::vector<std::string> foldDefines(const Permutation& p, pld_stage stage) {
  std::vector<std::string> defines{"WEIGHT " + std::to_string(static_cast<int>(p.weight)), "NORMALISATION 0"};
  const auto define = [&](const char* name, bool wanted) {
    if (wanted) defines.emplace_back(name);
  };
  const bool layers = stage == PLD_STAGE_LAYERS || stage == PLD_STAGE_LOW;
  define("STAGE_RIMS", stage == PLD_STAGE_RIMS);
  define("LISTS_OFFSETS", listsOffsets(p, stage));
  define("GREY", p.grey());
  define("LEAN", p.lean());
  define("FRONT_TAIL", p.fronts() && layers);
  define("SCATTER", p.scatters() && layers);
  if (layers)
    for (const std::string& place : scatterPlaces(p)) defines.push_back(place);
  define("DISPERSION", p.has(PLD_FEATURE_DISPERSION) && layers);
  return defines;
}

std::vector<std::string> emptyDefines(const std::vector<PlaneSpec>& planes) {
  std::vector<std::string> defines;
  for (const PlaneSpec& plane : planes) {
    std::string value;
    for (const GLfloat x : plane.clear)
      value += std::string(value.empty() ? "" : ", ") + (std::isinf(x) ? "intBitsToFloat(0x7f800000)"
                                                         : x == 0.0f   ? "0.0f"
                                                                       : "1.0f");
    defines.push_back("PLANE_" + std::to_string(plane.attachment) + " vec4(" + value + ")");
  }
  return defines;
}

std::vector<std::string> depthDefines(pld_depth depth, pld_clip clip) {
  if (depth == PLD_DEPTH_LINEAR) return {"DEPTH_IS_LINEAR"};
  const bool zeroToOne = clip == PLD_CLIP_ZERO_TO_ONE;
  return {zeroToOne ? "CLIP_SCALE 1.0f" : "CLIP_SCALE 2.0f", zeroToOne ? "CLIP_OFFSET 0.0f" : "CLIP_OFFSET (-1.0f)",
          depth == PLD_DEPTH_REVERSED ? "EMPTY 0.0f" : "EMPTY 1.0f"};
}

std::vector<std::string> resolveDefines(const Permutation& p) {
  std::vector<std::string> defines{"PART_OF_TEXTURE", "NEAREST_SAMPLERS", "NO_SELF_MODULATION"};
  const auto define = [&](const char* name, bool wanted) {
    if (wanted) defines.emplace_back(name);
  };
  define("NO_DEPTH", !p.planarDepth());
  define("NO_SOLIDS", !p.has(PLD_FEATURE_SOLIDS));
  define("NO_LIGHT", !p.light());
  define("PUBLISHED", p.published());
  define("GREY", p.grey());
  define("LEAN", p.lean());
  define("HALF_SUMS", !p.inFloats());
  define("FRONT_TAIL", p.fronts());
  define("LOW_OVER", p.lowOver());
  define("SCATTER", p.scatters());
  for (const std::string& place : scatterPlaces(p)) defines.push_back(place);
  define("DISPERSION", p.has(PLD_FEATURE_DISPERSION));
  return defines;
}

}  // namespace pellucid::c
