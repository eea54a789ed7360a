#include "tests/bridge/recipe_faults.h"

namespace pellucid::test {

int bitsOf(pld_format format) {
  static constexpr int bits[] = {0, 16, 32, 64, 32, 64, 128, 32, 16, 32};
  return bits[format];
}

std::string faultOf(const pld_recipe& recipe, const pld_recipe_pass& pass, std::set<uint32_t>& written) {
  std::set<uint32_t> locations, bindings, now;
  for (uint32_t i = 0; i < pass.read_count; ++i) {
    const pld_recipe_read& read = pass.reads[i];
    if (!written.count(read.image) && read.layer != PLD_LAYER_BEFORE) return std::string("reads ") + read.sampler;
    if (!bindings.insert(read.binding).second) return "two textures at one binding";
  }
  for (uint32_t i = 0; i < pass.storage_count; ++i)
    if (!bindings.insert(pass.storage[i].binding).second) return "a buffer where a texture is";
  if (pass.constants_size && !bindings.insert(pass.constants_binding).second) return "constants where a texture is";
  for (uint32_t i = 0; i < pass.attachment_count; ++i) {
    const pld_recipe_attachment& one = pass.attachments[i];
    const pld_recipe_image& image = *pld_recipe_image_at(&recipe, one.image);
    if (one.location > 7 || !locations.insert(one.location).second) return "two attachments at one location";
    if (one.load == PLD_LOAD_KEEP && !written.count(one.image)) return std::string("keeps nothing of ") + image.name;
    if (one.load == PLD_LOAD_ANY && one.blend.enabled) return std::string("blends over anything in ") + image.name;
    if (image.format == PLD_FORMAT_DEPTH32F) return "draws colour to a depth";
    if (image.format == PLD_FORMAT_HOST && one.blend.enabled) return "blends into a format it does not know";
    // One minus colour is of [0, 1] alone.
    if (one.blend.destination == PLD_FACTOR_ONE_MINUS_SOURCE_COLOUR && image.format != PLD_FORMAT_RGBA8)
      return "a product in a format that is not normalised";
    for (uint32_t k = 0; k < pass.read_count; ++k)
      if (pass.reads[k].image == one.image &&
          !(pass.reads[k].layer == PLD_LAYER_BEFORE && one.layer == PLD_LAYER_OF_REPEAT && image.layers == 2))
        return std::string("reads what it writes: ") + image.name;
    now.insert(one.image);
  }
  if (pass.depth_image != PLD_NO_IMAGE && !pass.depth_write && !written.count(pass.depth_image)) return "tests nothing";
  if (pass.attachment_count == 0 && pass.storage_count == 0) return "writes nothing";
  written.insert(now.begin(), now.end());
  return {};
}

}  // namespace pellucid::test
