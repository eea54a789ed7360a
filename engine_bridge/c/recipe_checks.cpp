#include "engine_bridge/c/recipe_checks.h"

#include "engine_bridge/c/frame_numbers.h"
#include "engine_bridge/c/pass_choices.h"

namespace pellucid::c {
namespace {

bool isVersionOf(pld_dialect dialect, int32_t version) {
  switch (dialect) {
    case PLD_DIALECT_GL:
      return version == 330 || (version >= 400 && version <= 460 && version % 10 == 0);
    case PLD_DIALECT_ES:
      return version == 320;
    default:
      return version == 450 || version == 460;
  }
}

// In Vulkan buffers and textures of a set are told apart by their bindings.
bool placesMeet(const pld_recipe_info& info, const Permutation& p) {
  const uint32_t units = static_cast<uint32_t>(p.seamUnits()), blocks = static_cast<uint32_t>(listBlocks(p));
  const auto lies = [](uint32_t x, uint32_t first, uint32_t count) { return x >= first && x - first < count; };
  const bool lists = blocks > 0 && (lies(info.uniform_binding, info.storage_binding, blocks) ||
                                    lies(info.texture_binding, info.storage_binding, blocks) ||
                                    lies(info.storage_binding, info.texture_binding, units));
  return lists || lies(info.uniform_binding, info.texture_binding, units);
}

// What no permutation may have.
pld_status checkInfo(const pld_recipe_info& info) {
  char text[200];
  if (info.version >> 20 != PLD_VERSION_MAJOR || ((info.version >> 10) & 1023u) > PLD_VERSION_MINOR) {
    std::snprintf(text, sizeof(text), "pld_recipe_create: version: found %u.%u, expected %d.0 to %d.%d",
                  info.version >> 20, (info.version >> 10) & 1023u, PLD_VERSION_MAJOR, PLD_VERSION_MAJOR,
                  PLD_VERSION_MINOR);
    return refuse(info, PLD_ERROR_VERSION, text);
  }
  if (nameUnknownChoice(info, "pld_recipe_create", text)) return refuse(info, PLD_ERROR_ARGUMENT, text);
  if (info.features & ~kEveryFeature)
    return refuse(info, PLD_ERROR_ARGUMENT, "pld_recipe_create: features hold a bit that this version does not have");
  if (info.dialect < PLD_DIALECT_GL || info.dialect > PLD_DIALECT_VULKAN || !isVersionOf(info.dialect, info.glsl)) {
    std::snprintf(text, sizeof(text),
                  "pld_recipe_create: found dialect %d with glsl %d, expected PLD_DIALECT_GL with 330 to 460, "
                  "PLD_DIALECT_ES with 320 or PLD_DIALECT_VULKAN with 450 or 460",
                  static_cast<int>(info.dialect), info.glsl);
    return refuse(info, PLD_ERROR_ARGUMENT, text);
  }
  for (const uint32_t place : {info.set, info.uniform_binding, info.texture_binding, info.storage_binding})
    if (place > kMostBinding)
      return refuse(info, PLD_ERROR_ARGUMENT, "pld_recipe_create: a set or binding above 1048576");
  return PLD_OK;
}

pld_status checkDialect(const pld_recipe_info& info, const Permutation& p) {
  if (p.exact() && (info.dialect == PLD_DIALECT_ES || (info.dialect == PLD_DIALECT_GL && info.glsl < 430)))
    return refuse(info, PLD_ERROR_UNSUPPORTED,
                  "pld_recipe_create: PLD_TIER_EXACT: expected PLD_DIALECT_VULKAN, or PLD_DIALECT_GL from 430 on: it "
                  "writes to storage buffers and sums in double precision");
  if (info.dialect == PLD_DIALECT_VULKAN && placesMeet(info, p))
    return refuse(info, PLD_ERROR_ARGUMENT,
                  "pld_recipe_create: uniform_binding, texture_binding and storage_binding meet: expected places of "
                  "their own for the block, the textures and the lists");
  return PLD_OK;
}

pld_status fix(const pld_recipe_info& info, Permutation& p) {
  if (info.fixed_fields == 0) return PLD_OK;
  if (!info.fixed || (info.fixed_fields & ~kEveryField))
    return refuse(info, PLD_ERROR_ARGUMENT,
                  "pld_recipe_create: fixed is null, or fixed_fields hold a bit that this version does not have");
  pld_frame whole{};
  if (!takeWhole(*info.fixed, whole))
    return refuse(info, PLD_ERROR_VERSION, "pld_recipe_create: fixed.struct_size is that of no version");
  char text[300];
  const FrameJudge judge{p, info.version, text, sizeof(text)};
  if (const pld_status status = judgeNumbers(judge, "pld_recipe_create", whole, info.fixed_fields); status != PLD_OK)
    return refuse(info, status, text);
  p.fixed = whole;
  p.fixedFields = info.fixed_fields;
  return PLD_OK;
}

}  // namespace

pld_status refuse(const pld_recipe_info& info, pld_status status, const char* text) {
  if (info.message && info.message_size > 0) std::snprintf(info.message, info.message_size, "%s", text);
  return status;
}

pld_status takeInfo(const pld_recipe_info& info, Permutation& p) {
  if (const pld_status status = checkInfo(info); status != PLD_OK) return status;
  p = permutationOf(info);
  if (const std::string refusal = refusalOf(p); !refusal.empty())
    return refuse(info, PLD_ERROR_UNSUPPORTED, ("pld_recipe_create: " + refusal).c_str());
  const pld_status status = checkDialect(info, p);
  return status == PLD_OK ? fix(info, p) : status;
}

}  // namespace pellucid::c
