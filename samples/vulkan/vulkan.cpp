// The sample engine's frame on Vulkan: G-buffer, light pass, and Pellucid's recipe. Of Pellucid it knows the public
// headers alone.
//
//   vulkan GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD[:TIER][,rims][,low]] [up|down]
//   METHOD: phenomenological, weighted, front+tail; TIER: float, half, published, exact
//
// Writes OUTDIR/opaque.exr and OUTDIR/frame.exr, as samples/engine does. Rows of images run up, as GL's do, or down, as
// on Vulkan they mostly do. Ends with 1 where the validation layers said anything.
#include <cstdio>
#include <exception>

#include "samples/engine/engine_scene.h"
#include "samples/engine/engine_shading.h"
#include "samples/vulkan/recipe_runner.h"

namespace {

using namespace engine;
using Format = vk::Format;

const std::string kVersion = "#version 450\n";

class VulkanEngine {
 public:
  VulkanEngine(Gpu& gpu, const Scene& scene, vk::Extent2D extent, bool down)
      : gpu_(gpu), scene_(scene), extent_(extent), down_(down) {
    using Usage = vk::BufferUsageFlagBits;
    albedo_ = gpu.image(Format::eR16G16B16A16Sfloat, extent);
    normal_ = gpu.image(Format::eR32G32B32A32Sfloat, extent);
    depth_ = gpu.image(Format::eD32Sfloat, extent);
    occlusion_ = gpu.image(Format::eR32Sfloat, extent);
    lit_ = gpu.image(Format::eR32G32B32A32Sfloat, extent);
    frame_ = gpu.image(Format::eR32G32B32A32Sfloat, extent);
    vertices_ = gpu.buffer(Usage::eVertexBuffer, scene.vertices.size() * sizeof(Vertex), scene.vertices.data());
    indices_ = gpu.buffer(Usage::eIndexBuffer, scene.indices.size() * sizeof(uint32_t), scene.indices.data());
    const SceneNumbers numbers = sceneNumbers(scene, width(), height(), !down);
    const GpuBuffer block = gpu.buffer(Usage::eUniformBuffer, sizeof(numbers), &numbers);
    const Binding scenes{
        .place = kSceneBinding, .type = vk::DescriptorType::eUniformBuffer, .part = {block.buffer, 0, block.size}};
    meshBindings_ = {scenes, {.place = kTexturesBinding, .view = uploadTextures().whole, .smooth = true}};
    occlusionBindings_ = {
        scenes, {.place = kDepthBinding, .view = depth_.whole}, {.place = kNormalBinding, .view = normal_.whole}};
    lightBindings_ = occlusionBindings_;
    lightBindings_.push_back({.place = kAlbedoBinding, .view = albedo_.whole});
    lightBindings_.push_back({.place = kOcclusionBinding, .view = occlusion_.whole});
    const vk::PipelineColorBlendAttachmentState whole{.colorWriteMask = vk::ColorComponentFlags(15u)};
    gBuffer_ = gpu.pipeline({.vertex = kVersion + kMeshVertex,
                             .fragment = kVersion + kGBuffer,
                             .bindings = meshBindings_,
                             .meshes = true,
                             .colours = {albedo_.format, normal_.format},
                             .blends = {whole, whole},
                             .depth = depth_.format,
                             .compare = vk::CompareOp::eGreater,
                             .writesDepth = true});
    hiding_ = gpu.pipeline({.vertex = kVersion + kFullScreen,
                            .fragment = kVersion + kOcclusion,
                            .bindings = occlusionBindings_,
                            .colours = {occlusion_.format},
                            .blends = {whole}});
    light_ = gpu.pipeline({.vertex = kVersion + kFullScreen,
                           .fragment = kVersion + kLight,
                           .bindings = lightBindings_,
                           .colours = {lit_.format},
                           .blends = {whole}});
  }

  void draw(const Asked& asked) {
    pld_recipe_info info = pld_recipe_info_init(PLD_DIALECT_VULKAN, 450);
    char why[300];
    info.method = asked.method, info.tier = asked.tier, info.features = asked.features;
    info.depth = PLD_DEPTH_REVERSED;
    info.rows = down_ ? PLD_ROWS_DOWN : PLD_ROWS_UP;
    info.message = why, info.message_size = sizeof(why);
    pld_recipe* recipe = nullptr;
    if (pld_recipe_create(&info, &recipe) != PLD_OK) stop(why);
    const std::string rims = asked.features & PLD_FEATURE_RIMS ? "#define RIMS_OF_LEAVES\n" : "";
    RecipeRunner runner(gpu_, recipe, extent_,
                        {{PLD_ROLE_COLOUR, lit_},
                         {PLD_ROLE_DEPTH, depth_},
                         {PLD_ROLE_OCCLUSION, occlusion_},
                         {PLD_ROLE_PICTURE, frame_}},
                        static_cast<uint64_t>(kFragmentsAPixel * static_cast<float>(extent_.width * extent_.height)),
                        {kVersion + kMeshVertex, rims + kGlass, meshBindings_});
    const pld_frame frame = frameOf(scene_, width(), height());
    gpu_.run([&](const Commands& to) {
      drawOpaque(to);
      runner.record(to, frame, [&](const Commands&, const GpuPipeline& pipeline, pld_stage stage, vk::Rect2D area) {
        drawMeshes(to, pipeline, area, [&](const Material& one) { return isDrawnIn(stage, one, asked.features); });
      });
    });
    if (!runner.hadRoom()) stop("more fragments came than there is room for");
    pld_recipe_destroy(&recipe);
  }

  void write(const std::string& folder) {
    const std::vector<float> depth = gpu_.read(depth_);
    writePicture(folder + "/opaque.exr", width(), height(), gpu_.read(lit_), depth, down_);
    writePicture(folder + "/frame.exr", width(), height(), gpu_.read(frame_), depth, down_);
  }

 private:
  int width() const { return static_cast<int>(extent_.width); }
  int height() const { return static_cast<int>(extent_.height); }

  // An array, of one black layer where the scene has no textures.
  GpuImage uploadTextures() {
    const auto layers = static_cast<uint32_t>(scene_.textureLevels.back().size());
    uint32_t edge = kTextureEdge;
    const GpuImage made = gpu_.image(Format::eR16G16B16A16Sfloat, {edge, edge}, std::max(layers, 2u), kTextureLevels);
    for (uint32_t level = 0; level < kTextureLevels && layers > 0; ++level, edge /= 2) {
      const auto& texels = scene_.textureLevels[level];
      const GpuBuffer staged = gpu_.buffer({}, texels.size() * sizeof(texels[0]), texels.data());
      gpu_.run([&](const Commands& to) {
        const vk::BufferImageCopy region{.imageSubresource = {vk::ImageAspectFlagBits::eColor, level, 0, layers},
                                         .imageExtent = {edge, edge, 1}};
        to.copyBufferToImage(staged.buffer, made.image, vk::ImageLayout::eGeneral, region);
      });
    }
    return made;
  }

  void drawOpaque(const Commands& to) const {
    const vk::Rect2D area{{0, 0}, extent_};
    const auto cleared = [](const GpuImage& image) { return target(image.whole, vk::AttachmentLoadOp::eClear); };
    gpu_.begin(to, gBuffer_, {area, {cleared(albedo_), cleared(normal_)}, cleared(depth_)}, meshBindings_);
    drawMeshes(to, gBuffer_, area, [](const Material& material) { return material.opaque(); });
    to.endRendering();
    gpu_.begin(to, hiding_, {area, {cleared(occlusion_)}, {}}, occlusionBindings_);
    to.draw(3, 1, 0, 0);
    to.endRendering();
    gpu_.begin(to, light_, {area, {cleared(lit_)}, {}}, lightBindings_);
    to.draw(3, 1, 0, 0);
    to.endRendering();
  }

  template <class Wanted>
  void drawMeshes(const Commands& to, const GpuPipeline& pipeline, vk::Rect2D area, const Wanted& isWanted) const {
    const auto across = static_cast<float>(area.extent.width), high = static_cast<float>(area.extent.height);
    if (down_) to.setViewport(0, vk::Viewport{0.0f, high, across, -high, 0.0f, 1.0f});
    to.setFrontFace(down_ ? vk::FrontFace::eCounterClockwise : vk::FrontFace::eClockwise);
    to.bindVertexBuffers(0, vertices_.buffer, {0});
    to.bindIndexBuffer(indices_.buffer, 0, vk::IndexType::eUint32);
    for (const Mesh& mesh : scene_.meshes) {
      if (!isWanted(mesh.material)) continue;
      to.setCullMode(mesh.material.bothSides ? vk::CullModeFlagBits::eNone : vk::CullModeFlagBits::eBack);
      to.pushConstants<MeshNumbers>(pipeline.layout, vk::ShaderStageFlagBits::eAllGraphics, 0,
                                    meshNumbers(scene_, mesh));
      to.drawIndexed(mesh.indexCount, 1, mesh.firstIndex, 0, 0);
    }
  }

  Gpu& gpu_;
  const Scene& scene_;
  vk::Extent2D extent_;
  bool down_;
  GpuImage albedo_, normal_, depth_, occlusion_, lit_, frame_;
  GpuBuffer vertices_, indices_;
  std::vector<Binding> meshBindings_, occlusionBindings_, lightBindings_;
  GpuPipeline gBuffer_, hiding_, light_;
};

}  // namespace

int main(int count, char** arguments) {
  unsigned width = 640, height = 360;
  if (count < 3 || count > 6) stop("vulkan GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD[:TIER][,rims][,low]] [up|down]");
  if (count > 3 && (std::sscanf(arguments[3], "%ux%u", &width, &height) != 2 || width < 1 || height < 1))
    stop("expected WIDTHxHEIGHT");
  const std::string rows = count > 5 ? arguments[5] : "down";
  if (rows != "up" && rows != "down") stop("expected up or down, found " + rows);
  try {
    const Scene scene = readScene(arguments[1]);
    Gpu gpu;
    VulkanEngine engine(gpu, scene, {width, height}, rows == "down");
    engine.draw(askedFor(count > 4 ? arguments[4] : "phenomenological"));
    engine.write(arguments[2]);
  } catch (const std::exception& error) {
    stop(error.what());
  }
  std::printf("validation messages: %d\n", validationMessages());
  return validationMessages() == 0 ? 0 : 1;
}
