#include "samples/vulkan/recipe_runner.h"

#include <algorithm>
#include <cstring>

#include "samples/engine/engine_scene.h"

namespace engine {
namespace {

using Format = vk::Format;
using Type = vk::DescriptorType;

constexpr vk::DeviceSize kSlot = 1024;     // of a pass's constants: a multiple of what any device aligns them by
constexpr vk::DeviceSize kMostSlots = 64;  // of a frame: passes and their repeats

// In the order of pld_format, pld_factor, pld_blend_op, pld_compare and pld_load.
constexpr Format kFormats[] = {Format::eUndefined,          Format::eR16Sfloat,     Format::eR16G16Sfloat,
                               Format::eR16G16B16A16Sfloat, Format::eR32Sfloat,     Format::eR32G32Sfloat,
                               Format::eR32G32B32A32Sfloat, Format::eR8G8B8A8Unorm, Format::eR8G8Snorm,
                               Format::eD32Sfloat};
constexpr vk::BlendFactor kFactors[] = {vk::BlendFactor::eZero, vk::BlendFactor::eOne,
                                        vk::BlendFactor::eOneMinusSrcColor};
constexpr vk::BlendOp kOps[] = {vk::BlendOp::eAdd, vk::BlendOp::eMin, vk::BlendOp::eReverseSubtract};
constexpr vk::CompareOp kCompares[] = {vk::CompareOp::eAlways, vk::CompareOp::eLessOrEqual,
                                       vk::CompareOp::eGreaterOrEqual, vk::CompareOp::eGreater};
constexpr vk::AttachmentLoadOp kLoads[] = {vk::AttachmentLoadOp::eLoad, vk::AttachmentLoadOp::eClear,
                                           vk::AttachmentLoadOp::eDontCare};

void check(pld_status status) {
  if (status != PLD_OK) stop(pld_status_name(status));
}

vk::PipelineColorBlendAttachmentState blendOf(const pld_recipe_attachment& one) {
  const pld_blend& blend = one.blend;
  return {blend.enabled != 0,           kFactors[blend.source],
          kFactors[blend.destination],  kOps[blend.op],
          kFactors[blend.alpha_source], kFactors[blend.alpha_destination],
          kOps[blend.alpha_op],         vk::ColorComponentFlags(one.write_mask)};
}

vk::ImageView viewOf(const GpuImage& image, int32_t layer, uint32_t repeat) {
  const auto count = static_cast<uint32_t>(image.layers.size());
  if (layer == PLD_LAYERS_ALL) return image.whole;
  if (layer == PLD_LAYER_OF_REPEAT) return image.layers[repeat % count];
  if (layer == PLD_LAYER_BEFORE) return image.layers[(repeat + 1) % count];
  return image.layers[static_cast<std::size_t>(layer)];
}

// Outputs of a pass, those between its attachments among them.
uint32_t outputsOf(const pld_recipe_pass& pass) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < pass.attachment_count; ++i) count = std::max(count, pass.attachments[i].location + 1);
  return count;
}

}  // namespace

RecipeRunner::RecipeRunner(Gpu& gpu, const pld_recipe* recipe, int width, int height,
                           std::map<pld_role, GpuImage> images, uint64_t fragments, const Material& material)
    : gpu_(gpu), recipe_(recipe), width_(width), height_(height), fragments_(fragments) {
  for (uint32_t i = 0; i < pld_recipe_image_count(recipe); ++i) {
    const pld_recipe_image& image = *pld_recipe_image_at(recipe, i);
    int32_t size[2];
    check(pld_recipe_image_size(recipe, i, width, height, size));
    images_.push_back(image.role == PLD_ROLE_OWN ? gpu.image(kFormats[image.format], size[0], size[1], image.layers)
                                                 : images.at(image.role));
  }
  for (uint32_t i = 0; i < pld_recipe_buffer_count(recipe); ++i) {
    uint64_t bytes = 0, zeroed = 0;
    check(pld_recipe_buffer_size(recipe, i, width, height, fragments, &bytes, &zeroed));
    buffers_.push_back(gpu.buffer(bytes, vk::BufferUsageFlagBits::eStorageBuffer));
    zeroed_.push_back(zeroed);
  }
  const uint32_t count = pld_recipe_pass_count(recipe);
  for (uint32_t i = 0; i < count; ++i) passes_.push_back(passOf(*pld_recipe_pass_at(recipe, i), material));
  constants_ = gpu.buffer(kSlot * kMostSlots, vk::BufferUsageFlagBits::eUniformBuffer);
  counts_ = gpu.buffer(sizeof(uint32_t) * count, {});
  std::memset(counts_.mapped, 0, counts_.size);
}

std::vector<Binding> RecipeRunner::bindingsOf(const pld_recipe_pass& pass, uint32_t repeat,
                                              vk::DeviceSize constants) const {
  std::vector<Binding> bindings;
  for (uint32_t i = 0; i < pass.read_count; ++i) {
    const pld_recipe_read& read = pass.reads[i];
    bindings.push_back(
        {read.binding, Type::eCombinedImageSampler, viewOf(images_[read.image], read.layer, repeat), {}});
  }
  for (uint32_t i = 0; i < pass.storage_count; ++i)
    bindings.push_back({pass.storage[i].binding,
                        Type::eStorageBuffer,
                        {},
                        {buffers_[pass.storage[i].buffer].buffer, 0, VK_WHOLE_SIZE}});
  if (pass.constants_size)
    bindings.push_back(
        {pass.constants_binding, Type::eUniformBuffer, {}, {constants_.buffer, constants, pass.constants_size}});
  return bindings;
}

RecipeRunner::Pass RecipeRunner::passOf(const pld_recipe_pass& pass, const Material& material) {
  const bool draws = pass.kind == PLD_PASS_DRAWS;
  Pass made{};
  made.setLayout = gpu_.setLayout(bindingsOf(pass, 0, 0));
  made.layout = gpu_.pipelineLayout(draws ? std::vector{material.set, made.setLayout} : std::vector{made.setLayout});
  PipelineShape shape;
  shape.vertex = draws ? material.vertex : pass.vertex;
  shape.fragment = draws ? "#version 450\n" + std::string(pass.fragment) + material.fragment : pass.fragment;
  shape.layout = made.layout;
  shape.meshes = draws;
  shape.colours.resize(outputsOf(pass), Format::eUndefined);
  shape.blends.resize(outputsOf(pass));
  for (uint32_t i = 0; i < pass.attachment_count; ++i) {
    const pld_recipe_attachment& one = pass.attachments[i];
    const vk::Format format = shape.colours[one.location] = images_[one.image].format;
    shape.blends[one.location] = blendOf(one);
    if (one.blend.enabled && !gpu_.blends(format)) stop("this device does not blend into " + vk::to_string(format));
  }
  if (pass.depth_image != PLD_NO_IMAGE) {
    shape.depth = images_[pass.depth_image].format;
    shape.compare = kCompares[pass.depth_compare];
    shape.writesDepth = pass.depth_write != 0;
  }
  made.pipeline = gpu_.pipeline(shape);
  return made;
}

void RecipeRunner::emptyLists(vk::CommandBuffer commands, const pld_recipe_pass& pass) {
  for (uint32_t i = 0; i < pass.storage_count; ++i) {
    const uint32_t buffer = pass.storage[i].buffer;
    if (!pass.storage[i].empties) continue;
    commands.fillBuffer(buffers_[buffer].buffer, 0, zeroed_[buffer], 0);
    waitForWrites(commands);
  }
}

void RecipeRunner::beginRendering(vk::CommandBuffer commands, const pld_recipe_pass& pass, uint32_t repeat,
                                  vk::Rect2D area) {
  std::vector<vk::RenderingAttachmentInfo> colours(outputsOf(pass));
  for (uint32_t i = 0; i < pass.attachment_count; ++i) {
    const pld_recipe_attachment& one = pass.attachments[i];
    vk::ClearColorValue clear;
    std::copy_n(pld_recipe_image_at(recipe_, one.image)->clear, 4, clear.float32.begin());
    colours[one.location] =
        vk::RenderingAttachmentInfo(viewOf(images_[one.image], one.layer, repeat), vk::ImageLayout::eGeneral, {}, {},
                                    {}, kLoads[one.load], vk::AttachmentStoreOp::eStore, clear);
  }
  vk::RenderingInfo info({}, area, 1, 0, colours);
  vk::RenderingAttachmentInfo depth;
  if (pass.depth_image != PLD_NO_IMAGE) {
    depth = vk::RenderingAttachmentInfo(images_[pass.depth_image].whole, vk::ImageLayout::eGeneral, {}, {}, {},
                                        kLoads[pass.depth_write ? PLD_LOAD_CLEAR : PLD_LOAD_KEEP],
                                        vk::AttachmentStoreOp::eStore, vk::ClearDepthStencilValue(pass.depth_clear, 0));
    info.setPDepthAttachment(&depth);
  }
  commands.beginRendering(info);
}

void RecipeRunner::run(vk::CommandBuffer commands, uint32_t index, uint32_t repeat, vk::Rect2D area,
                       vk::DeviceSize constants, const Draw& draw) {
  const pld_recipe_pass& pass = *pld_recipe_pass_at(recipe_, index);
  waitForWrites(commands);
  emptyLists(commands, pass);
  beginRendering(commands, pass, repeat, area);
  setArea(commands, area);
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, passes_[index].pipeline);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, passes_[index].layout, pass.set,
                              gpu_.descriptorSet(passes_[index].setLayout, bindingsOf(pass, repeat, constants)), {});
  if (pass.kind == PLD_PASS_DRAWS)
    draw(commands, passes_[index].layout);
  else
    commands.draw(3, 1, 0, 0);
  commands.endRendering();
  if (pass.storage_count == 0 || !pass.storage[0].empties) return;
  waitForWrites(commands);  // the first word of the lists counts what came
  commands.copyBuffer(buffers_[pass.storage[0].buffer].buffer, counts_.buffer,
                      vk::BufferCopy(0, index * sizeof(uint32_t), sizeof(uint32_t)));
}

void RecipeRunner::record(vk::CommandBuffer commands, const pld_frame& frame, const Draw& draw) {
  char why[300];
  if (pld_recipe_check(recipe_, &frame, width_, height_, why, sizeof(why)) != PLD_OK) stop(why);
  vk::DeviceSize slot = 0;
  for (uint32_t i = 0; i < pld_recipe_pass_count(recipe_); ++i) {
    uint32_t repeats = 0;
    check(pld_recipe_repeats(recipe_, i, &frame, &repeats));
    for (uint32_t repeat = 0; repeat < repeats; ++repeat, slot += kSlot) {
      if (slot == constants_.size) stop("more passes than there is room for");
      int32_t area[4];
      check(pld_recipe_fill(recipe_, i, repeat, &frame, width_, constants_.mapped + slot, kSlot, area));
      const vk::Extent2D extent(static_cast<uint32_t>(area[2]), static_cast<uint32_t>(area[3]));
      run(commands, i, repeat, {{area[0], area[1]}, extent}, slot, draw);
    }
  }
}

bool RecipeRunner::hadRoom() const {
  std::vector<uint32_t> came(counts_.size / sizeof(uint32_t));
  std::memcpy(came.data(), counts_.mapped, counts_.size);
  return std::all_of(came.begin(), came.end(), [&](uint32_t one) { return one <= fragments_; });
}

}  // namespace engine
