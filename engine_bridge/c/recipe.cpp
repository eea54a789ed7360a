// The C boundary of recipes: null pointers, versions and exceptions stop here.
#include <cstring>

#include "engine_bridge/c/built_recipe.h"
#include "engine_bridge/c/frame_numbers.h"
#include "engine_bridge/c/plan_builder.h"
#include "engine_bridge/c/plan_sizes.h"
#include "engine_bridge/c/recipe_checks.h"
#include "engine_bridge/c/recipe_numbers.h"

using namespace pellucid::c;

namespace {

constexpr int kMostPixels = 65536;  // of a side

bool isSize(int32_t width, int32_t height) {
  return width >= 1 && height >= 1 && width <= kMostPixels && height <= kMostPixels;
}

// Of frames that may be drawn; a recipe of shadow maps has none.
bool takeFrame(const pld_recipe& recipe, const pld_frame* frame, pld_frame& whole) {
  if (recipe.plan.isOfMaps() || !frame || !takeWhole(*frame, whole) || !isSize(whole.width, whole.height)) return false;
  return !recipe.permutation.low() || whole.low_factor == 2 || whole.low_factor == 4 || whole.low_factor == 8;
}

template <class T>
const T* at(const std::vector<T>& all, uint32_t index) {
  return index < all.size() ? &all[index] : nullptr;
}

}  // namespace

extern "C" {

pld_status pld_recipe_create(const pld_recipe_info* info, pld_recipe** recipe) {
  if (!recipe) return PLD_ERROR_ARGUMENT;
  *recipe = nullptr;
  if (!info) return PLD_ERROR_ARGUMENT;
  if (info->struct_size != sizeof(pld_recipe_info)) return PLD_ERROR_VERSION;  // its message may lie elsewhere
  refuse(*info, PLD_OK, "");
  return guardedMake(*info, "pld_recipe_create: out of memory", [&] {
    Permutation p;
    const pld_status status = takeInfo(*info, p);
    if (status == PLD_OK) *recipe = new pld_recipe(p, recipePlan(p, {info->clip}), *info);
    return status;
  });
}

pld_status pld_recipe_destroy(pld_recipe** recipe) {
  if (!recipe || !*recipe) return PLD_ERROR_ARGUMENT;
  delete *recipe;
  *recipe = nullptr;
  return PLD_OK;
}

uint32_t pld_recipe_image_count(const pld_recipe* recipe) {
  return recipe ? static_cast<uint32_t>(recipe->images.size()) : 0;
}

uint32_t pld_recipe_buffer_count(const pld_recipe* recipe) {
  return recipe ? static_cast<uint32_t>(recipe->buffers.size()) : 0;
}

uint32_t pld_recipe_pass_count(const pld_recipe* recipe) {
  return recipe ? static_cast<uint32_t>(recipe->passes.size()) : 0;
}

const pld_recipe_image* pld_recipe_image_at(const pld_recipe* recipe, uint32_t index) {
  return recipe ? at(recipe->images, index) : nullptr;
}

const pld_recipe_buffer* pld_recipe_buffer_at(const pld_recipe* recipe, uint32_t index) {
  return recipe ? at(recipe->buffers, index) : nullptr;
}

const pld_recipe_pass* pld_recipe_pass_at(const pld_recipe* recipe, uint32_t index) {
  return recipe ? at(recipe->passes, index) : nullptr;
}

pld_status pld_recipe_image_size(const pld_recipe* recipe, uint32_t image, int32_t width, int32_t height,
                                 int32_t size[2]) {
  if (!recipe || !size || image >= recipe->images.size()) return PLD_ERROR_ARGUMENT;
  if (!recipe->plan.isOfMaps() && !isSize(width, height)) return PLD_ERROR_SIZE;
  const PixelSize found = sizeOf(recipe->plan, recipe->plan.images[image], width, height);
  size[0] = found.width;
  size[1] = found.height;
  return PLD_OK;
}

pld_status pld_recipe_buffer_size(const pld_recipe* recipe, uint32_t buffer, int32_t width, int32_t height,
                                  uint64_t fragments, uint64_t* bytes, uint64_t* zeroed) {
  if (!recipe || !bytes || buffer >= recipe->buffers.size()) return PLD_ERROR_ARGUMENT;
  if (!isSize(width, height)) return PLD_ERROR_SIZE;
  if (fragments < 1 || fragments > kMostFragments) return PLD_ERROR_MEMORY;
  const ListSizes sizes = listSizes(width, height, fragments);
  *bytes = buffer == 0 ? sizes.links : sizes.record;
  if (zeroed) *zeroed = buffer == 0 ? sizes.heads : 0;
  return PLD_OK;
}

pld_status pld_recipe_check(const pld_recipe* recipe, const pld_frame* frame, int32_t width, int32_t height,
                            char* message, size_t message_size) {
  constexpr const char* call = "pld_recipe_check";
  char nowhere[1] = {};
  if (message && message_size > 0) message[0] = '\0';
  if (!recipe || !frame) return PLD_ERROR_ARGUMENT;
  const FrameJudge judge{recipe->permutation, recipe->version, message ? message : nowhere, message ? message_size : 0};
  pld_frame whole{};
  if (recipe->plan.isOfMaps()) return judge.fail(PLD_ERROR_ARGUMENT, "%s: a recipe of shadow maps has no frames", call);
  if (!takeWhole(*frame, whole))
    return judge.fail(PLD_ERROR_VERSION, "%s: frame.struct_size: found %u, expected %zu", call, frame->struct_size,
                      sizeof(pld_frame));
  if (!isSize(width, height) || whole.width < 1 || whole.height < 1 || whole.width > width || whole.height > height)
    return judge.fail(PLD_ERROR_SIZE, "%s: frame: found %dx%d, expected at most the largest picture's %dx%d", call,
                      whole.width, whole.height, width, height);
  pld_status status = judgeNumbers(judge, call, whole, kEveryField);
  if (status == PLD_OK) status = judgeFixed(judge, call, "pld_recipe_create()", whole);
  if (status == PLD_OK) status = judgeOcclusion(judge, call, whole);
  if (status == PLD_OK) status = judgeOpacity(judge, call, whole);
  return status == PLD_OK ? judgeLow(judge, call, whole) : status;
}

pld_status pld_recipe_repeats(const pld_recipe* recipe, uint32_t pass, const pld_frame* frame, uint32_t* repeats) {
  pld_frame whole{};
  if (!recipe || !repeats || pass >= recipe->passes.size() || !takeFrame(*recipe, frame, whole))
    return PLD_ERROR_ARGUMENT;
  *repeats = repeatsOf(recipe->plan, recipe->plan.passes[pass], whole);
  return PLD_OK;
}

pld_status pld_recipe_fill(const pld_recipe* recipe, uint32_t pass, uint32_t repeat, const pld_frame* frame,
                           int32_t width, void* constants, size_t size, int32_t area[4]) {
  pld_frame whole{};
  if (!recipe || !area || pass >= recipe->passes.size() || !takeFrame(*recipe, frame, whole)) return PLD_ERROR_ARGUMENT;
  if (width < whole.width || width > kMostPixels) return PLD_ERROR_SIZE;
  const PlannedPass& planned = recipe->plan.passes[pass];
  if (repeat >= repeatsOf(recipe->plan, planned, whole)) return PLD_ERROR_ARGUMENT;
  const PassArea part = areaOf(recipe->plan, planned, repeat, whole);
  area[0] = part.x;
  area[1] = part.y;
  area[2] = part.width;
  area[3] = part.height;
  if (!constants) return PLD_OK;
  if (size < recipe->passes[pass].constants_size) return PLD_ERROR_SIZE;
  const FrameNumbers numbers{recipe->permutation, whole, width, recipe->plan.atlasLayers, planned.firstView};
  if (planned.kind == PLD_PASS_DRAWS) {
    float block[kSeamFloats];
    fillSeam(numbers, planned.part == PartOfFrame::low ? whole.low_factor : 1, block);
    std::memcpy(constants, block, sizeof(block));
  } else {
    std::memset(constants, 0, recipe->passes[pass].constants_size);
    fillStage(numbers, placesOf(planned.numbers), repeat, static_cast<std::byte*>(constants));
  }
  return PLD_OK;
}

pld_status pld_recipe_query(const pld_recipe* recipe, pld_value what, uint64_t* value) {
  if (!recipe || !value) return PLD_ERROR_ARGUMENT;
  if (!recipe->plan.isOfMaps()) return queryOf(recipe->permutation, what, *value) ? PLD_OK : PLD_ERROR_ARGUMENT;
  if (what != PLD_VALUE_SHADOW_BYTES) return PLD_ERROR_ARGUMENT;
  *value = bytesOfMaps(recipe->plan);
  return PLD_OK;
}

}  // extern "C"
