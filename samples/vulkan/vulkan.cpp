// The sample engine's frame on Vulkan, with Pellucid's recipe. Of Pellucid it knows the public headers alone.
//
//   vulkan GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD[:TIER][,rims][,low][,shadows]] [up|down]
//
// METHOD and the rest, OUTDIR/opaque.exr and OUTDIR/frame.exr are as in samples/engine. Rows of images run up, as GL's
// do, or down, as on Vulkan they mostly do. Ends with 1 where the validation layers said anything.
#include <cstdio>
#include <exception>
#include <optional>
#include <utility>

#include "samples/engine/engine_scene.h"
#include "samples/engine/engine_shading.h"
#include "samples/vulkan/recipe_runner.h"

namespace engine {

using Format = vk::Format;

const std::string kVersion = "#version 450\n";

class VulkanEngine {
 public:
  VulkanEngine(Gpu& gpu, const Scene& scene, const Arguments& given)
      : gpu_(gpu), scene_(scene), given_(given), up_(given.last == "up") {
    using Usage = vk::BufferUsageFlagBits;
    const int width = given.width, height = given.height;
    albedo_ = gpu.image(Format::eR16G16B16A16Sfloat, width, height);
    normal_ = gpu.image(Format::eR32G32B32A32Sfloat, width, height);
    depth_ = gpu.image(Format::eD32Sfloat, width, height);
    occlusion_ = gpu.image(Format::eR32Sfloat, width, height);
    lit_ = gpu.image(Format::eR32G32B32A32Sfloat, width, height);
    picture_ = gpu.image(Format::eR32G32B32A32Sfloat, width, height);
    vertices_ = gpu.buffer(Usage::eVertexBuffer, scene.vertices.size() * sizeof(Vertex), scene.vertices.data());
    indices_ = gpu.buffer(Usage::eIndexBuffer, scene.indices.size() * sizeof(uint32_t), scene.indices.data());
    const SceneNumbers numbers = sceneNumbers(scene, width, height, up_);
    bindings_ = {uniform(kSceneBinding, &numbers, sizeof(numbers)),
                 {.place = kTexturesBinding, .view = uploadTextures().whole, .smooth = true},
                 {.place = kDepthBinding, .view = depth_.whole},
                 {.place = kNormalBinding, .view = normal_.whole},
                 {.place = kAlbedoBinding, .view = albedo_.whole},
                 {.place = kOcclusionBinding, .view = occlusion_.whole}};
  }

  void draw() {
    pld_recipe_info info = pld_recipe_info_init(PLD_DIALECT_VULKAN, 450);
    char why[300];
    info.method = given_.asked.method, info.tier = given_.asked.tier, info.features = given_.asked.features;
    info.depth = PLD_DEPTH_REVERSED;
    info.rows = up_ ? PLD_ROWS_UP : PLD_ROWS_DOWN;
    info.message = why, info.message_size = sizeof(why);
    pld_recipe *recipe = nullptr, *shadows = nullptr;
    if (pld_recipe_create(&info, &recipe) != PLD_OK) stop(why);
    const pld_shadow_info maps = shadowMaps();
    if (given_.asked.shadows && pld_shadow_recipe_create(&info, &maps, &shadows) != PLD_OK) stop(why);
    if (shadows) drawShadows(shadows);
    drawOpaque();
    drawLayers(recipe);
    pld_recipe_destroy(&recipe);
    if (shadows) pld_recipe_destroy(&shadows);
  }

  void write(const std::string& folder) {
    const std::vector<float> depth = gpu_.read(depth_);
    writePicture(folder + "/opaque.exr", given_.width, given_.height, gpu_.read(lit_), depth, !up_);
    writePicture(folder + "/frame.exr", given_.width, given_.height, gpu_.read(picture_), depth, !up_);
  }

 private:
  Binding uniform(uint32_t place, const void* data, vk::DeviceSize size) {
    const GpuBuffer block = gpu_.buffer(vk::BufferUsageFlagBits::eUniformBuffer, size, data);
    return {.place = place, .type = vk::DescriptorType::eUniformBuffer, .part = {block.buffer, 0, size}};
  }

  // An array, of two empty layers where the scene has no textures.
  GpuImage uploadTextures() {
    const auto layers = static_cast<uint32_t>(scene_.textureLevels.back().size());
    uint32_t edge = kTextureEdge;
    const GpuImage made =
        gpu_.image(Format::eR16G16B16A16Sfloat, kTextureEdge, kTextureEdge, std::max(layers, 2u), kTextureLevels);
    for (uint32_t level = 0; level < kTextureLevels && layers > 0; ++level, edge /= 2) {
      const auto& texels = scene_.textureLevels[level];
      const GpuBuffer staged = gpu_.buffer({}, texels.size() * sizeof(texels[0]), texels.data());
      const vk::ImageSubresourceLayers into(vk::ImageAspectFlagBits::eColor, level, 0, layers);
      gpu_.run([&](const Commands& to) {
        to.copyBufferToImage(staged.buffer, made.image, vk::ImageLayout::eGeneral,
                             vk::BufferImageCopy(0, 0, 0, into, {}, {edge, edge, 1}));
      });
    }
    return made;
  }

  // The sun's map, whose rows always run up, and what shaders need to look it up.
  void drawShadows(pld_recipe* shadows) {
    const SunView sun = sunViewOf(scene_);
    std::vector<Binding> bindings = bindings_;
    const SceneNumbers numbers = sceneNumbers(sun);
    bindings[0] = uniform(kSceneBinding, &numbers, sizeof(numbers));
    RecipeRunner runner(gpu_, {shadows, 1, 1, {}, 0, kVersion + kMeshVertex, kCaster, bindings});
    record(runner, nullptr, &sun.view);
    const char* lookups = nullptr;
    std::size_t bytes = 0;
    pld_shadow_recipe_glsl(shadows, &lookups, nullptr);
    pld_shadow_recipe_table_size(shadows, &bytes);
    std::vector<char> table(bytes);
    for (const pld_shadow_view* view : {static_cast<const pld_shadow_view*>(nullptr), &sun.view})
      pld_shadow_recipe_table(shadows, view, PLD_ROWS_UP, table.data(), bytes);
    lookups_ = "#define SUN_IS_SHADOWED\n" + std::string(lookups);
    bindings_.push_back(uniform(kShadowTableBinding, table.data(), bytes));
    bindings_.push_back({.place = kShadowMapsBinding, .view = runner.image(PLD_ROLE_SHADOW_MAPS).whole});
  }

  void drawOpaque() {
    GpuPass pass = passInto({&albedo_, &normal_});
    pass.depthFormat = depth_.format;
    pass.compare = vk::CompareOp::eGreater;
    pass.writesDepth = true;
    pass.depth = target(depth_.whole, vk::AttachmentLoadOp::eClear);
    const GpuPipeline gBuffer = gpu_.pipeline(pass, kVersion + kMeshVertex, kVersion + kGBuffer, true);
    gpu_.run([&](const Commands& to) { gpu_.draw(to, gBuffer, pass, [&] { drawMeshes(to, gBuffer, std::nullopt); }); });
    for (const auto& [image, text] : {std::pair{&occlusion_, kOcclusion}, {&lit_, lookups_ + kLight}}) {
      pass = passInto({image});
      const GpuPipeline pipeline = gpu_.pipeline(pass, kVersion + kFullScreen, kVersion + text, false);
      gpu_.run([&](const Commands& to) { gpu_.draw(to, pipeline, pass); });
    }
  }

  void drawLayers(pld_recipe* recipe) {
    const int width = given_.width, height = given_.height;
    const std::map<pld_role, GpuImage> images = {{PLD_ROLE_COLOUR, lit_},
                                                 {PLD_ROLE_DEPTH, depth_},
                                                 {PLD_ROLE_OCCLUSION, occlusion_},
                                                 {PLD_ROLE_PICTURE, picture_}};
    const auto room = static_cast<uint64_t>(kFragmentsAPixel * static_cast<float>(width * height));
    const std::string rims = given_.asked.features & PLD_FEATURE_RIMS ? "#define RIMS_OF_LEAVES\n" : "",
                      text = rims + lookups_ + kGlass;
    RecipeRunner runner(gpu_, {recipe, width, height, images, room, kVersion + kMeshVertex, text, bindings_});
    const pld_frame frame = frameOf(scene_, width, height);
    record(runner, &frame, nullptr);
    if (!runner.hadRoom()) stop("more fragments came than there is room for");
  }

  void record(RecipeRunner& runner, const pld_frame* frame, const pld_shadow_view* face) {
    gpu_.run([&](const Commands& to) {
      runner.record(to, frame, face, [&](const GpuPipeline& with, pld_stage stage) { drawMeshes(to, with, stage); });
    });
  }

  GpuPass passInto(const std::vector<const GpuImage*>& images) const {
    GpuPass made{.bindings = bindings_, .area = {{0, 0}, {depth_.width, depth_.height}}};
    for (std::size_t i = 0; i < images.size(); ++i) {
      made.formats[i] = images[i]->format;
      made.blends[i].setColorWriteMask(vk::ColorComponentFlags(15u));
      made.outputs[i] = target(images[i]->whole, vk::AttachmentLoadOp::eClear);
    }
    return made;
  }

  // Of a stage of Pellucid's pass, or of the G-buffer.
  void drawMeshes(const Commands& to, const GpuPipeline& pipeline, std::optional<pld_stage> stage) const {
    const bool casts = stage == PLD_STAGE_CASTERS;
    const glm::mat4 viewFromWorld = casts ? sunViewOf(scene_).lightFromWorld : scene_.viewFromWorld;
    to.setFrontFace(up_ || casts ? vk::FrontFace::eClockwise : vk::FrontFace::eCounterClockwise);
    to.bindVertexBuffers(0, vertices_.buffer, {0});
    to.bindIndexBuffer(indices_.buffer, 0, vk::IndexType::eUint32);
    for (const Mesh& mesh : scene_.meshes) {
      if (stage ? !isDrawnIn(*stage, mesh.material, given_.asked.features) : !mesh.material.opaque()) continue;
      to.setCullMode(mesh.material.bothSides ? vk::CullModeFlagBits::eNone : vk::CullModeFlagBits::eBack);
      to.pushConstants<MeshNumbers>(pipeline.layout, vk::ShaderStageFlagBits::eAllGraphics, 0,
                                    meshNumbers(viewFromWorld, mesh));
      to.drawIndexed(mesh.indexCount, 1, mesh.firstIndex, 0, 0);
    }
  }

  Gpu& gpu_;
  const Scene& scene_;
  const Arguments& given_;
  bool up_;  // how rows run
  GpuImage albedo_, normal_, depth_, occlusion_, lit_, picture_;
  GpuBuffer vertices_, indices_;
  std::vector<Binding> bindings_;  // all that the engine's shaders read, the camera's block first
  std::string lookups_;            // Pellucid's text of shadow maps, or nothing
};

}  // namespace engine

int main(int count, char** arguments) try {
  using namespace engine;
  const Arguments given = argumentsOf(
      count, arguments, "vulkan GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD[:TIER][,rims][,low][,shadows]] [up|down]");
  if (given.last != "" && given.last != "up" && given.last != "down") stop("expected up or down, found " + given.last);
  const Scene scene = readScene(given.glass);
  Gpu gpu;
  VulkanEngine engine(gpu, scene, given);
  engine.draw();
  engine.write(given.folder);
  std::printf("validation messages: %d\n", validationMessages);
  return validationMessages == 0 ? 0 : 1;
} catch (const std::exception& error) {
  engine::stop(error.what());
}
