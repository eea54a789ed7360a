#include "samples/vulkan/recipe_runner.h"

#include <algorithm>
#include <utility>

#include "samples/engine/engine_scene.h"

namespace engine {
namespace {

using Format = vk::Format;
using Type = vk::DescriptorType;

constexpr vk::DeviceSize kSlot = 1024;     // of a pass's constants: a multiple of what any device aligns them by
constexpr vk::DeviceSize kMostSlots = 64;  // of a frame: passes and their repeats
constexpr std::size_t kOutputs = 8;        // a recipe has no more; some lie between others and have no image

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
  if (layer == PLD_LAYERS_ALL) return image.whole;
  const uint32_t turn = layer == PLD_LAYER_OF_REPEAT ? repeat : repeat + 1;
  return image.layers[layer < 0 ? turn % image.layers.size() : static_cast<std::size_t>(layer)];
}

}  // namespace

RecipeRunner::RecipeRunner(Gpu& gpu, const pld_recipe* recipe, vk::Extent2D extent, std::map<pld_role, GpuImage> images,
                           uint64_t fragments, Material material)
    : gpu_(gpu), recipe_(recipe), extent_(extent), fragments_(fragments), material_(std::move(material)) {
  const auto width = static_cast<int32_t>(extent.width), height = static_cast<int32_t>(extent.height);
  for (uint32_t i = 0; i < pld_recipe_image_count(recipe); ++i) {
    const pld_recipe_image& image = *pld_recipe_image_at(recipe, i);
    int32_t size[2];
    check(pld_recipe_image_size(recipe, i, width, height, size));
    const vk::Extent2D own{static_cast<uint32_t>(size[0]), static_cast<uint32_t>(size[1])};
    images_.push_back(image.role == PLD_ROLE_OWN ? gpu.image(kFormats[image.format], own, image.layers)
                                                 : images.at(image.role));
  }
  for (uint32_t i = 0; i < pld_recipe_buffer_count(recipe); ++i) {
    uint64_t bytes = 0, zeroed = 0;
    check(pld_recipe_buffer_size(recipe, i, width, height, fragments, &bytes, &zeroed));
    buffers_.push_back(gpu.buffer(vk::BufferUsageFlagBits::eStorageBuffer, bytes));
    zeroed_.push_back(zeroed);
  }
  const uint32_t count = pld_recipe_pass_count(recipe);
  for (uint32_t i = 0; i < count; ++i) pipelines_.push_back(pipelineOf(*pld_recipe_pass_at(recipe, i)));
  constants_ = gpu.buffer(vk::BufferUsageFlagBits::eUniformBuffer, kSlot * kMostSlots);
  counts_ = gpu.buffer({}, sizeof(uint32_t) * count, std::vector<uint32_t>(count).data());
}

std::vector<Binding> RecipeRunner::bindingsOf(const pld_recipe_pass& pass, uint32_t repeat,
                                              vk::DeviceSize constants) const {
  std::vector<Binding> all = pass.kind == PLD_PASS_DRAWS ? material_.bindings : std::vector<Binding>();
  for (uint32_t i = 0; i < pass.read_count; ++i) {
    const pld_recipe_read& read = pass.reads[i];
    all.push_back({.place = read.binding, .view = viewOf(images_[read.image], read.layer, repeat)});
  }
  for (uint32_t i = 0; i < pass.storage_count; ++i)
    all.push_back({.place = pass.storage[i].binding,
                   .type = Type::eStorageBuffer,
                   .part = {buffers_[pass.storage[i].buffer].buffer, 0, VK_WHOLE_SIZE}});
  if (pass.constants_size)
    all.push_back({.place = pass.constants_binding,
                   .type = Type::eUniformBuffer,
                   .part = {constants_.buffer, constants, pass.constants_size}});
  return all;
}

GpuPipeline RecipeRunner::pipelineOf(const pld_recipe_pass& pass) {
  const bool draws = pass.kind == PLD_PASS_DRAWS, depth = pass.depth_image != PLD_NO_IMAGE;
  PipelineShape shape{
      .vertex = draws ? material_.vertex : pass.vertex,
      .fragment = draws ? "#version 450\n" + std::string(pass.fragment) + material_.fragment : pass.fragment,
      .bindings = bindingsOf(pass, 0, 0),
      .meshes = draws,
      .colours{kOutputs, Format::eUndefined},
      .blends = std::vector<vk::PipelineColorBlendAttachmentState>(kOutputs),
      .depth = depth ? images_[pass.depth_image].format : Format::eUndefined,
      .compare = kCompares[pass.depth_compare],
      .writesDepth = pass.depth_write != 0};
  for (uint32_t i = 0; i < pass.attachment_count; ++i) {
    const pld_recipe_attachment& one = pass.attachments[i];
    const Format format = shape.colours[one.location] = images_[one.image].format;
    shape.blends[one.location] = blendOf(one);
    if (one.blend.enabled && !gpu_.blends(format)) stop("this device does not blend into " + vk::to_string(format));
  }
  return gpu_.pipeline(shape);
}

Targets RecipeRunner::targetsOf(const pld_recipe_pass& pass, uint32_t repeat, vk::Rect2D area) const {
  Targets into{.area = area, .colours{kOutputs, vk::RenderingAttachmentInfo{}}};
  for (uint32_t i = 0; i < pass.attachment_count; ++i) {
    const pld_recipe_attachment& one = pass.attachments[i];
    vk::ClearColorValue clear;
    std::copy_n(pld_recipe_image_at(recipe_, one.image)->clear, 4, clear.float32.begin());
    into.colours[one.location] = target(viewOf(images_[one.image], one.layer, repeat), kLoads[one.load], clear);
  }
  if (pass.depth_image != PLD_NO_IMAGE)
    into.depth = target(images_[pass.depth_image].whole, kLoads[pass.depth_write ? PLD_LOAD_CLEAR : PLD_LOAD_KEEP],
                        vk::ClearDepthStencilValue{pass.depth_clear, 0});
  return into;
}

void RecipeRunner::run(const Commands& to, uint32_t index, uint32_t repeat, vk::Rect2D area, vk::DeviceSize constants,
                       const Draw& draw) {
  const pld_recipe_pass& pass = *pld_recipe_pass_at(recipe_, index);
  if (pass.storage_count > 0) waitForWrites(to);
  for (uint32_t i = 0; i < pass.storage_count; ++i)
    if (pass.storage[i].empties)
      to.fillBuffer(buffers_[pass.storage[i].buffer].buffer, 0, zeroed_[pass.storage[i].buffer], 0);
  gpu_.begin(to, pipelines_[index], targetsOf(pass, repeat, area), bindingsOf(pass, repeat, constants));
  if (pass.kind == PLD_PASS_DRAWS)
    draw(to, pipelines_[index], pass.stage, area);
  else
    to.draw(3, 1, 0, 0);
  to.endRendering();
  if (pass.storage_count == 0 || !pass.storage[0].empties) return;
  waitForWrites(to);  // the first word of the lists counts what came
  to.copyBuffer(buffers_[pass.storage[0].buffer].buffer, counts_.buffer,
                vk::BufferCopy{0, index * sizeof(uint32_t), sizeof(uint32_t)});
}

void RecipeRunner::record(const Commands& to, const pld_frame& frame, const Draw& draw) {
  const auto width = static_cast<int32_t>(extent_.width), height = static_cast<int32_t>(extent_.height);
  char why[300];
  if (pld_recipe_check(recipe_, &frame, width, height, why, sizeof(why)) != PLD_OK) stop(why);
  vk::DeviceSize slot = 0;
  for (uint32_t i = 0; i < pld_recipe_pass_count(recipe_); ++i) {
    uint32_t repeats = 0;
    check(pld_recipe_repeats(recipe_, i, &frame, &repeats));
    for (uint32_t repeat = 0; repeat < repeats; ++repeat, slot += kSlot) {
      if (slot == constants_.size) stop("more passes than there is room for");
      int32_t area[4];
      check(pld_recipe_fill(recipe_, i, repeat, &frame, width, constants_.mapped + slot, kSlot, area));
      const vk::Extent2D extent{static_cast<uint32_t>(area[2]), static_cast<uint32_t>(area[3])};
      run(to, i, repeat, {{area[0], area[1]}, extent}, slot, draw);
    }
  }
}

bool RecipeRunner::hadRoom() const {
  const auto* came = reinterpret_cast<const uint32_t*>(counts_.mapped);
  return std::all_of(came, came + pipelines_.size(), [&](uint32_t one) { return one <= fragments_; });
}

}  // namespace engine
