// The C boundary of recipes: null pointers, versions and exceptions stop here.
#include <climits>
#include <cstring>
#include <new>

#include "engine_bridge/c/built_recipe.h"
#include "engine_bridge/c/frame_numbers.h"
#include "engine_bridge/c/pass_choices.h"
#include "engine_bridge/c/plan_sizes.h"
#include "engine_bridge/c/recipe_numbers.h"

using namespace pellucid::c;

namespace {

constexpr int kMostPixels = 65536;           // of a side
constexpr uint32_t kMostBinding = 1u << 20;  // as far as any device goes; sums of them stay numbers

pld_status refuse(const pld_recipe_info& info, pld_status status, const char* text) {
  if (info.message && info.message_size > 0) std::snprintf(info.message, info.message_size, "%s", text);
  return status;
}

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
  const FrameJudge judge{p, true, text, sizeof(text)};
  if (const pld_status status = judgeNumbers(judge, "pld_recipe_create", whole, info.fixed_fields); status != PLD_OK)
    return refuse(info, status, text);
  p.fixed = whole;
  p.fixedFields = info.fixed_fields;
  return PLD_OK;
}

pld_status make(const pld_recipe_info& info, pld_recipe** recipe) {
  if (const pld_status status = checkInfo(info); status != PLD_OK) return status;
  Permutation p = permutationOf(info);
  if (const std::string refusal = refusalOf(p); !refusal.empty())
    return refuse(info, PLD_ERROR_UNSUPPORTED, ("pld_recipe_create: " + refusal).c_str());
  if (const pld_status status = checkDialect(info, p); status != PLD_OK) return status;
  if (const pld_status status = fix(info, p); status != PLD_OK) return status;
  *recipe = new pld_recipe(p, info);
  return PLD_OK;
}

bool isSize(int32_t width, int32_t height) {
  return width >= 1 && height >= 1 && width <= kMostPixels && height <= kMostPixels;
}

// Of frames that may be drawn.
bool takeFrame(const pld_recipe& recipe, const pld_frame* frame, pld_frame& whole) {
  if (!frame || !takeWhole(*frame, whole) || !isSize(whole.width, whole.height)) return false;
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
  try {
    return make(*info, recipe);
  } catch (const std::bad_alloc&) {
    return refuse(*info, PLD_ERROR_MEMORY, "pld_recipe_create: out of memory");
  } catch (const std::exception& mistake) {
    return refuse(*info, PLD_ERROR_INTERNAL, mistake.what());
  } catch (...) {
    return PLD_ERROR_INTERNAL;
  }
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
  if (!isSize(width, height)) return PLD_ERROR_SIZE;
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
  const FrameJudge judge{recipe->permutation, true, message ? message : nowhere, message ? message_size : 0};
  pld_frame whole{};
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
  return queryOf(recipe->permutation, what, *value) ? PLD_OK : PLD_ERROR_ARGUMENT;
}

}  // extern "C"
