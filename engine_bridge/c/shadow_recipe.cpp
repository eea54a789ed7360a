// The C boundary of recipes of shadow maps: null pointers, versions and exceptions stop here.
#include <cstring>

#include "engine_bridge/c/built_recipe.h"
#include "engine_bridge/c/caster_judge.h"
#include "engine_bridge/c/caster_plan.h"
#include "engine_bridge/c/caster_table.h"
#include "engine_bridge/c/plan_sizes.h"
#include "engine_bridge/c/recipe_checks.h"

using namespace pellucid::c;

namespace {

constexpr const char* kCreate = "pld_shadow_recipe_create";

bool lies(uint32_t place, uint32_t first, uint32_t count) {
  return place >= first && place - first < count;
}

// What lookups declare stands in one shader with the seam of the layers; in Vulkan all of it in one set.
bool placesMeet(const pld_recipe_info& info, const pld_shadow_info& maps, const Permutation& p) {
  const uint32_t units = static_cast<uint32_t>(p.seamUnits()), blocks = static_cast<uint32_t>(listBlocks(p));
  if (maps.uniform_binding == info.uniform_binding || lies(maps.texture_unit, info.texture_binding, units)) return true;
  if (info.dialect != PLD_DIALECT_VULKAN) return false;
  const auto meets = [&](uint32_t place) {
    return place == info.uniform_binding || lies(place, info.texture_binding, units) ||
           lies(place, info.storage_binding, blocks);
  };
  return maps.uniform_binding == maps.texture_unit || meets(maps.uniform_binding) || meets(maps.texture_unit);
}

pld_status makeRecipe(const pld_recipe_info& info, const pld_shadow_info& maps, pld_recipe** recipe) {
  Permutation p;
  if (const pld_status status = takeInfo(info, p); status != PLD_OK) return status;
  char text[300];
  const CasterJudge judge{kCreate, text, sizeof(text)};
  pld_status status = judgeMaps(judge, maps, {});
  if (status == PLD_OK && (maps.uniform_binding > kMostBinding || maps.texture_unit > kMostBinding))
    status = judge.fail(PLD_ERROR_ARGUMENT, "maps: a binding above %u", kMostBinding);
  if (status == PLD_OK && placesMeet(info, maps, p))
    status = judge.fail(PLD_ERROR_ARGUMENT,
                        "maps: uniform_binding %u, texture_unit %u: expected others than those of the layers' text",
                        maps.uniform_binding, maps.texture_unit);
  if (status != PLD_OK) return refuse(info, status, text);
  *recipe = new pld_recipe(p, casterPlan(maps, info.depth), info);
  return PLD_OK;
}

bool isOfMaps(const pld_recipe* recipe) {
  return recipe && recipe->plan.isOfMaps();
}

bool mayDraw(const pld_recipe& recipe, const pld_shadow_view& view) {
  return judgeView({"", nullptr, 0}, recipe.plan.maps, view) == PLD_OK;
}

}  // namespace

extern "C" {

pld_status pld_shadow_recipe_create(const pld_recipe_info* info, const pld_shadow_info* maps, pld_recipe** recipe) {
  if (!recipe) return PLD_ERROR_ARGUMENT;
  *recipe = nullptr;
  if (!info) return PLD_ERROR_ARGUMENT;
  if (info->struct_size != sizeof(pld_recipe_info)) return PLD_ERROR_VERSION;  // its message may lie elsewhere
  refuse(*info, PLD_OK, "");
  if (!maps) return refuse(*info, PLD_ERROR_ARGUMENT, "pld_shadow_recipe_create: maps is null");
  return guardedMake(*info, "pld_shadow_recipe_create: out of memory",
                     [&] { return makeRecipe(*info, *maps, recipe); });
}

pld_status pld_shadow_recipe_glsl(const pld_recipe* recipe, const char** text, uint64_t* hash) {
  if (!isOfMaps(recipe) || !text) return PLD_ERROR_ARGUMENT;
  *text = recipe->lookup.c_str();
  if (hash) *hash = recipe->lookupHash;
  return PLD_OK;
}

pld_status pld_shadow_recipe_check(const pld_recipe* recipe, const pld_shadow_view* view, char* message,
                                   size_t message_size) {
  if (message && message_size > 0) message[0] = '\0';
  if (!isOfMaps(recipe) || !view) return PLD_ERROR_ARGUMENT;
  const CasterJudge judge{"pld_shadow_recipe_check", message, message ? message_size : 0};
  return judgeView(judge, recipe->plan.maps, *view);
}

pld_status pld_shadow_recipe_fill(const pld_recipe* recipe, uint32_t pass, const pld_shadow_view* view, void* constants,
                                  size_t size, int32_t area[4], int32_t* layer) {
  if (!isOfMaps(recipe) || !view || !area || !layer || pass >= recipe->passes.size() || !mayDraw(*recipe, *view))
    return PLD_ERROR_ARGUMENT;
  const PlannedPass& planned = recipe->plan.passes[pass];
  const PassArea part = areaOf(recipe->plan, planned, 0, {});
  area[0] = part.x;
  area[1] = part.y;
  area[2] = part.width;
  area[3] = part.height;
  *layer = faceLayer(recipe->plan.maps, *view);
  if (!constants || planned.kind != PLD_PASS_DRAWS) return PLD_OK;
  const CasterBlock block = casterBlock(recipe->plan.maps, *view);
  if (size < sizeof(block)) return PLD_ERROR_SIZE;
  std::memcpy(constants, &block, sizeof(block));
  return PLD_OK;
}

pld_status pld_shadow_recipe_table_size(const pld_recipe* recipe, size_t* bytes) {
  if (!isOfMaps(recipe) || !bytes) return PLD_ERROR_ARGUMENT;
  *bytes = tableBytes(recipe->plan.maps);
  return PLD_OK;
}

pld_status pld_shadow_recipe_table(const pld_recipe* recipe, const pld_shadow_view* view, pld_rows rows, void* table,
                                   size_t size) {
  if (!isOfMaps(recipe) || !table || (rows != PLD_ROWS_UP && rows != PLD_ROWS_DOWN)) return PLD_ERROR_ARGUMENT;
  const pld_shadow_info& maps = recipe->plan.maps;
  if (size < tableBytes(maps)) return PLD_ERROR_SIZE;
  if (!view) {
    std::memset(table, 0, tableBytes(maps));
    return PLD_OK;
  }
  if (!mayDraw(*recipe, *view)) return PLD_ERROR_ARGUMENT;
  const auto put = [&](std::size_t at, const auto& row) {
    std::memcpy(static_cast<unsigned char*>(table) + at, &row, sizeof(row));
  };
  put(lightPlace(view->light), lightRow(maps, *view));
  put(facePlace(maps, slotOf(*view)), faceRow(maps, *view, rows == PLD_ROWS_DOWN ? -1.0 : 1.0));
  return PLD_OK;
}

}  // extern "C"
