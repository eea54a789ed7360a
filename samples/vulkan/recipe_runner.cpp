#include "samples/vulkan/recipe_runner.h"

#include <algorithm>
#include <span>
#include <utility>

#include "samples/engine/engine_scene.h"

namespace engine {
namespace {

using Type = vk::DescriptorType;
using enum vk::Format;
using enum vk::BlendFactor;
using enum vk::BlendOp;
using enum vk::CompareOp;
using enum vk::AttachmentLoadOp;

constexpr vk::DeviceSize kSlot = 1024;     // of a pass's constants: a multiple of what any device aligns them by
constexpr vk::DeviceSize kMostSlots = 64;  // of a frame: passes and their repeats

// In the order of pld_format, pld_factor, pld_blend_op, pld_compare and pld_load.
constexpr vk::Format kFormats[] = {eUndefined,    eR16Sfloat,          eR16G16Sfloat,  eR16G16B16A16Sfloat, eR32Sfloat,
                                   eR32G32Sfloat, eR32G32B32A32Sfloat, eR8G8B8A8Unorm, eR8G8Snorm,          eD32Sfloat};
constexpr vk::BlendFactor kFactors[] = {eZero, eOne, eOneMinusSrcColor};
constexpr vk::BlendOp kOps[] = {eAdd, eMin, eReverseSubtract};
constexpr vk::CompareOp kCompares[] = {eAlways, eLessOrEqual, eGreaterOrEqual, eGreater};
constexpr vk::AttachmentLoadOp kLoads[] = {eLoad, eClear, eDontCare};

void check(pld_status status) {
  if (status != PLD_OK) stop(pld_status_name(status));
}

//   turn  the repeat or, of shadow maps, the face's first layer
vk::ImageView viewOf(const GpuImage& image, int32_t layer, uint32_t turn, uint32_t location = 0) {
  if (layer == PLD_LAYERS_ALL) return image.whole;
  if (layer == PLD_LAYER_OF_FACE) return image.layers[turn + location];
  if (layer == PLD_LAYER_BEFORE) ++turn;
  return image.layers[layer < 0 ? turn % image.layers.size() : static_cast<std::size_t>(layer)];
}

}  // namespace

RecipeRunner::RecipeRunner(Gpu& gpu, Host host) : gpu_(gpu), host_(std::move(host)) {
  const pld_recipe* recipe = host_.recipe;
  for (uint32_t i = 0; i < pld_recipe_image_count(recipe); ++i) {
    const pld_recipe_image& image = *pld_recipe_image_at(recipe, i);
    int32_t size[2];
    check(pld_recipe_image_size(recipe, i, host_.width, host_.height, size));
    if (image.format != PLD_FORMAT_HOST)
      host_.images[image.role] = gpu.image(kFormats[image.format], size[0], size[1], image.layers);
    images_.push_back(host_.images[image.role]);
  }
  for (uint32_t i = 0; i < pld_recipe_buffer_count(recipe); ++i) {
    uint64_t bytes = 0;
    check(
        pld_recipe_buffer_size(recipe, i, host_.width, host_.height, host_.fragments, &bytes, &zeroed_.emplace_back()));
    buffers_.push_back(gpu.buffer(vk::BufferUsageFlagBits::eStorageBuffer, bytes));
  }
  constants_ = gpu.buffer(vk::BufferUsageFlagBits::eUniformBuffer, kSlot * kMostSlots);
  const uint32_t count = pld_recipe_pass_count(recipe);
  counts_ = gpu.buffer({}, sizeof(uint32_t) * count, std::vector<uint32_t>(count).data());
  for (uint32_t i = 0; i < count; ++i) {
    const pld_recipe_pass& pass = *pld_recipe_pass_at(recipe, i);
    const GpuPass with = passOf(pass, 0, 0);
    const std::string whole = "#version 450\n" + std::string(pass.fragment) + host_.fragment;
    pipelines_.push_back(pass.kind == PLD_PASS_DRAWS ? gpu.pipeline(with, host_.vertex, whole, true)
                                                     : gpu.pipeline(with, pass.vertex, pass.fragment, false));
  }
}

GpuPass RecipeRunner::passOf(const pld_recipe_pass& pass, uint32_t turn, vk::DeviceSize constants) const {
  GpuPass made;
  if (pass.kind == PLD_PASS_DRAWS) made.bindings = host_.bindings;
  for (const pld_recipe_read& one : std::span(pass.reads, pass.read_count))
    made.bindings.push_back({.place = one.binding, .view = viewOf(images_[one.image], one.layer, turn)});
  for (const pld_recipe_storage& one : std::span(pass.storage, pass.storage_count)) {
    const vk::DescriptorBufferInfo part(buffers_[one.buffer].buffer, 0, VK_WHOLE_SIZE);
    made.bindings.push_back({.place = one.binding, .type = Type::eStorageBuffer, .part = part});
  }
  const vk::DescriptorBufferInfo part(constants_.buffer, constants, pass.constants_size);
  if (part.range)
    made.bindings.push_back({.place = pass.constants_binding, .type = Type::eUniformBuffer, .part = part});
  for (const pld_recipe_attachment& one : std::span(pass.attachments, pass.attachment_count)) {
    const GpuImage& image = images_[one.image];
    vk::ClearColorValue clear;
    std::copy_n(pld_recipe_image_at(host_.recipe, one.image)->clear, 4, clear.float32.begin());
    made.formats[one.location] = image.format;
    const pld_blend& blend = one.blend;
    made.blends[one.location] = {blend.enabled != 0,           kFactors[blend.source],
                                 kFactors[blend.destination],  kOps[blend.op],
                                 kFactors[blend.alpha_source], kFactors[blend.alpha_destination],
                                 kOps[blend.alpha_op],         vk::ColorComponentFlags(one.write_mask)};
    made.outputs[one.location] = target(viewOf(image, one.layer, turn, one.location), kLoads[one.load], clear);
  }
  if (pass.depth_image == PLD_NO_IMAGE) return made;
  const GpuImage& depth = images_[pass.depth_image];
  made.depthFormat = depth.format;
  made.compare = kCompares[pass.depth_compare];
  made.writesDepth = pass.depth_write != 0;
  made.depth = target(depth.whole, kLoads[pass.depth_write ? PLD_LOAD_CLEAR : PLD_LOAD_KEEP],
                      vk::ClearDepthStencilValue(pass.depth_clear, 0));
  return made;
}

void RecipeRunner::record(const Commands& to, const pld_frame* frame, const pld_shadow_view* face, const Draw& draw) {
  const pld_recipe* recipe = host_.recipe;
  char why[300];
  if ((frame ? pld_recipe_check(recipe, frame, host_.width, host_.height, why, sizeof(why))
             : pld_shadow_recipe_check(recipe, face, why, sizeof(why))) != PLD_OK)
    stop(why);
  vk::DeviceSize slot = 0;
  for (uint32_t i = 0; i < pipelines_.size(); ++i) {
    const pld_recipe_pass& pass = *pld_recipe_pass_at(recipe, i);
    uint32_t repeats = 1;
    if (frame) check(pld_recipe_repeats(recipe, i, frame, &repeats));
    for (uint32_t repeat = 0; repeat < repeats; ++repeat, slot += kSlot) {
      if (slot == kSlot * kMostSlots) stop("more passes than there is room for");
      char* const constants = constants_.mapped + slot;
      int32_t area[4], turn = static_cast<int32_t>(repeat);
      check(frame ? pld_recipe_fill(recipe, i, repeat, frame, host_.width, constants, kSlot, area)
                  : pld_shadow_recipe_fill(recipe, i, face, constants, kSlot, area, &turn));
      GpuPass with = passOf(pass, static_cast<uint32_t>(turn), slot);
      with.area = vk::Rect2D({area[0], area[1]}, {static_cast<uint32_t>(area[2]), static_cast<uint32_t>(area[3])});
      const std::function<void()> meshes = [&] { draw(pipelines_[i], pass.stage); };
      if (pass.storage_count > 0) waitForWrites(to);
      for (const pld_recipe_storage& one : std::span(pass.storage, pass.storage_count))
        if (one.empties) to.fillBuffer(buffers_[one.buffer].buffer, 0, zeroed_[one.buffer], 0);
      gpu_.draw(to, pipelines_[i], with, pass.kind == PLD_PASS_DRAWS ? meshes : nullptr);
      if (pass.storage_count == 0 || !pass.storage[0].empties) continue;
      waitForWrites(to);  // the first word of the lists counts what came
      to.copyBuffer(buffers_[pass.storage[0].buffer].buffer, counts_.buffer,
                    vk::BufferCopy(0, i * sizeof(uint32_t), sizeof(uint32_t)));
    }
  }
}

bool RecipeRunner::hadRoom() const {
  const auto* came = reinterpret_cast<const uint32_t*>(counts_.mapped);
  return std::all_of(came, came + pipelines_.size(), [&](uint32_t one) { return one <= host_.fragments; });
}

}  // namespace engine
