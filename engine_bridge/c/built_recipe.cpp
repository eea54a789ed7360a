#include "engine_bridge/c/built_recipe.h"

#include <algorithm>
#include <utility>

#include "engine_bridge/c/caster_table.h"
#include "engine_bridge/c/recipe_numbers.h"
#include "shaders/plane_defines.h"

using namespace pellucid::c;

namespace {

// As FNV-1a, by eight bytes at a time: texts are long.
uint64_t hashOf(const std::string& text, uint64_t hash = 14695981039346656037u) {
  for (std::size_t i = 0; i < text.size(); i += 8) {
    uint64_t word = 0;
    for (std::size_t k = 0; k < 8 && i + k < text.size(); ++k)
      word |= static_cast<uint64_t>(static_cast<unsigned char>(text[i + k])) << (8 * k);
    hash = (hash ^ word) * 1099511628211u;
    hash ^= hash >> 29;
  }
  return hash;
}

GlslTarget targetOf(const pld_recipe_info& info, bool hosts) {
  return {info.dialect, info.glsl, hosts ? static_cast<int>(info.set) : 0};
}

SeamPlaces placesOf(const pld_recipe_info& info) {
  return {static_cast<int>(info.uniform_binding), static_cast<int>(info.texture_binding),
          static_cast<int>(info.storage_binding)};
}

uint32_t usageOf(const PlannedPass& pass, uint32_t image) {
  uint32_t usage = 0;
  if (pass.depthImage == image) usage |= PLD_USAGE_DEPTH;
  for (const PlannedRead& read : pass.reads)
    if (read.image == image) usage |= PLD_USAGE_READ;
  for (const pld_recipe_attachment& one : pass.attachments)
    if (one.image == image) usage |= PLD_USAGE_COLOUR;
  return usage;
}

}  // namespace

pld_recipe::pld_recipe(const Permutation& of, RecipePlan planned, const pld_recipe_info& info)
    : version(info.version), permutation(of), plan(std::move(planned)) {
  addImages();
  if (plan.isOfMaps()) {
    const pld_shadow_info& maps = plan.maps;
    lookup = shadowText({maps.lights, maps.faces, edgeOf(maps), channelsOf(maps)}, targetOf(info, true),
                        {static_cast<int>(maps.uniform_binding), static_cast<int>(maps.texture_unit)});
    lookupHash = hashOf(lookup);
  } else {
    for (int i = 0; i < listBlocks(permutation); ++i) buffers.push_back({listName(permutation, i)});
  }
  kept_.resize(plan.passes.size());
  for (std::size_t i = 0; i < kept_.size(); ++i) addPass(plan.passes[i], kept_[i], info);
  addLives();
}

void pld_recipe::addImages() {
  for (const PlannedImage& planned : plan.images) {
    pld_recipe_image image{};
    image.name = planned.name.c_str();
    image.role = planned.role;
    image.format = planned.format;
    image.layers = planned.layers;
    std::copy(planned.clear.begin(), planned.clear.end(), image.clear);
    images.push_back(image);
  }
}

// What the host's shaders hold.
void pld_recipe::addSeam(const PlannedPass& planned, Kept& kept, const pld_recipe_info& info, pld_recipe_pass& pass) {
  const GlslTarget target = targetOf(info, true);
  pass.constants_binding = info.uniform_binding;
  if (plan.isOfMaps()) {
    pass.constants_size = sizeof(CasterBlock);
    pass.constants_block = "PldShadowFrame";
    kept.fragment = casterText(plan.maps.coloured != 0, target, placesOf(info));
    return;
  }
  pass.constants_size = kSeamFloats * sizeof(float);
  pass.constants_block = "PldFrame";
  kept.fragment = seamText(permutation, planned.stage, target, placesOf(info));
}

void pld_recipe::addPass(const PlannedPass& planned, Kept& kept, const pld_recipe_info& info) {
  const bool draws = planned.kind == PLD_PASS_DRAWS;
  const GlslTarget target = targetOf(info, draws);
  const int units = draws ? static_cast<int>(info.texture_binding) : 0;
  const int storage = draws ? static_cast<int>(info.storage_binding) : kNumbersBinding + 1;
  for (const PlannedRead& read : planned.reads)
    kept.reads.push_back({read.image, read.binding + static_cast<uint32_t>(units), read.layer, read.sampler.c_str()});
  for (int i = 0; i < listBlocks(permutation); ++i)
    if (planned.lists >> i & 1u)
      kept.storage.push_back({static_cast<uint32_t>(i), static_cast<uint32_t>(storage + i),
                              planned.emptiesLists && i == 0 ? 1 : 0, listName(permutation, i)});
  pld_recipe_pass pass{};
  pass.name = planned.name.c_str();
  pass.kind = planned.kind;
  pass.stage = planned.stage;
  pass.attachments = planned.attachments.data();
  pass.attachment_count = static_cast<uint32_t>(planned.attachments.size());
  pass.reads = kept.reads.data();
  pass.read_count = static_cast<uint32_t>(kept.reads.size());
  pass.storage = kept.storage.data();
  pass.storage_count = static_cast<uint32_t>(kept.storage.size());
  pass.depth_image = planned.depthImage;
  pass.depth_compare = planned.compare;
  pass.depth_write = planned.writesDepth ? 1 : 0;
  pass.set = static_cast<uint32_t>(target.set);
  if (draws) {
    addSeam(planned, kept, info, pass);
  } else {
    pass.constants_binding = kNumbersBinding;
    pass.constants_size = static_cast<uint32_t>(sizeOfStageBlock(planned.numbers));
    pass.constants_block = kStageBlock;
    const std::string block = stageBlockText(planned.numbers, layoutText(target, "std140", kNumbersBinding));
    kept.fragment = recipeStageText(planned.file, planned.defines, target, block, storage);
    kept.vertex = recipeStageText("gl/fullscreen.vert", {}, target, "", storage);
    pass.vertex = kept.vertex.c_str();
  }
  pass.fragment = kept.fragment.c_str();
  pass.hash = hashOf(kept.fragment, hashOf(kept.vertex));
  passes.push_back(pass);
}

void pld_recipe::addLives() {
  for (uint32_t i = 0; i < images.size(); ++i) {
    pld_recipe_image& image = images[i];
    for (uint32_t pass = 0; pass < plan.passes.size(); ++pass) {
      const uint32_t usage = usageOf(plan.passes[pass], i);
      if (usage == 0) continue;
      if (image.usage == 0) image.first_pass = pass;
      image.last_pass = pass;
      image.usage |= usage;
    }
    if (plan.images[i].isMaps()) image.usage |= PLD_USAGE_READ;  // by lookups
  }
}
