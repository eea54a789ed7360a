// The sample engine's frame on Vulkan: G-buffer, light pass, and Pellucid's recipe. Of Pellucid it knows the public
// headers alone.
//
//   vulkan GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD[:TIER]] [up|down]
//   METHOD: phenomenological, weighted, front+tail; TIER: float, half, published, exact
//
// Writes OUTDIR/opaque.exr and OUTDIR/frame.exr, as samples/engine does. Rows of images run up, as GL's do, or down, as
// on Vulkan they mostly do. Ends with 1 where the validation layers said anything.
#include <array>
#include <cstdio>
#include <cstring>
#include <exception>
#include <glm/glm.hpp>
#include <utility>

#include "samples/engine/engine_scene.h"
#include "samples/engine/engine_shading.h"
#include "samples/vulkan/recipe_runner.h"

namespace {

using namespace engine;

constexpr char kHead[] = "#version 450\n";

// Of set 0, for all that the engine draws.
constexpr char kSet[] = R"(
layout(std140, set = 0, binding = 0) uniform SceneNumbers { mat4 clipFromView; vec3 toSun, sun, ambient; };
layout(push_constant) uniform MeshNumbers { mat4 viewFromObject; vec4 base, surfaceValues; ivec4 kinds; };
)";
constexpr char kVertexHead[] = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 viewPosition;
layout(location = 1) out vec3 viewNormal;
#define normalFromObject transpose(inverse(mat3(viewFromObject)))
)";
constexpr char kFragmentHead[] = R"(
layout(location = 0) in vec3 viewPosition;
layout(location = 1) in vec3 viewNormal;
)";
constexpr char kGBufferHead[] = "layout(location = 0) out vec4 albedo;\nlayout(location = 1) out vec4 normal;\n";
constexpr char kLightHead[] = R"(
layout(set = 0, binding = 1) uniform sampler2D albedo;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(location = 0) out vec4 lit;
)";
constexpr char kFullscreen[] =
    "void main() { gl_Position = vec4(vec2((gl_VertexIndex & 1) << 2, (gl_VertexIndex & 2) << 1) - vec2(1.0), 0.5, "
    "1.0); }";

// As kSet has them.
struct SceneNumbers {
  glm::mat4 clipFromView;
  glm::vec4 toSun, sun, ambient;
};
struct MeshNumbers {
  glm::mat4 viewFromObject;
  glm::vec4 base, surfaceValues;
  glm::ivec4 kinds;
};

class VulkanEngine {
 public:
  VulkanEngine(Gpu& gpu, const Scene& scene, int width, int height, bool down)
      : gpu_(gpu), scene_(scene), width_(width), height_(height), down_(down) {
    using Format = vk::Format;
    albedo_ = gpu.image(Format::eR16G16B16A16Sfloat, width, height);
    normal_ = gpu.image(Format::eR32G32B32A32Sfloat, width, height);
    lit_ = gpu.image(Format::eR32G32B32A32Sfloat, width, height);
    depth_ = gpu.image(Format::eD32Sfloat, width, height);
    frame_ = gpu.image(Format::eR32G32B32A32Sfloat, width, height);
    upload();
    makeSet();
    const auto whole = vk::PipelineColorBlendAttachmentState().setColorWriteMask(vk::ColorComponentFlags(15u));
    opaque_ = gpu.pipeline({meshVertex(),
                            kHead + std::string(kSet) + kFragmentHead + kGBufferHead + kGBufferBody,
                            layout_,
                            true,
                            {albedo_.format, normal_.format},
                            {whole, whole},
                            depth_.format,
                            vk::CompareOp::eGreater,
                            true});
    light_ = gpu.pipeline({kHead + std::string(kFullscreen),
                           kHead + std::string(kSet) + kLightHead + kLightBody,
                           layout_,
                           false,
                           {lit_.format},
                           {whole}});
  }

  void draw(const Asked& asked) {
    pld_recipe_info info = pld_recipe_info_init(PLD_DIALECT_VULKAN, 450);
    char why[300];
    info.method = asked.method, info.tier = asked.tier, info.features = asked.features;
    info.depth = PLD_DEPTH_REVERSED;
    info.rows = down_ ? PLD_ROWS_DOWN : PLD_ROWS_UP;
    info.set = 1;
    info.message = why, info.message_size = sizeof(why);
    pld_recipe* recipe = nullptr;
    if (pld_recipe_create(&info, &recipe) != PLD_OK) stop(why);
    const auto pixels = static_cast<float>(width_) * static_cast<float>(height_);
    RecipeRunner runner(gpu_, recipe, width_, height_,
                        {{PLD_ROLE_COLOUR, lit_}, {PLD_ROLE_DEPTH, depth_}, {PLD_ROLE_PICTURE, frame_}},
                        static_cast<uint64_t>(kFragmentsAPixel * pixels),
                        {meshVertex(), std::string(kSet) + kFragmentHead + kGlassBody, setLayout_});
    const pld_frame frame = frameOf(scene_, width_, height_);
    gpu_.run([&](vk::CommandBuffer commands) {
      drawOpaque(commands);
      runner.record(commands, frame,
                    [&](vk::CommandBuffer to, vk::PipelineLayout layout) { drawMeshes(to, layout, true); });
    });
    if (!runner.hadRoom()) stop("more fragments came than there is room for");
    pld_recipe_destroy(&recipe);
  }

  void write(const std::string& folder) {
    const std::vector<float> depth = gpu_.read(depth_);
    writePicture(folder + "/opaque.exr", width_, height_, gpu_.read(lit_), depth, down_);
    writePicture(folder + "/frame.exr", width_, height_, gpu_.read(frame_), depth, down_);
  }

 private:
  static std::string meshVertex() { return kHead + std::string(kSet) + kVertexHead + kMeshBody; }

  void upload() {
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
    for (const Mesh& mesh : scene_.meshes) {
      const Material& material = mesh.material;
      meshes_.push_back({scene_.viewFromWorld * mesh.worldFromObject,
                         material.base,
                         {material.roughness, material.transmission, material.ior, material.thickness},
                         {material.unlit, material.thickness > 0.0f, 0, 0}});
      starts_.push_back({static_cast<uint32_t>(indices.size()), static_cast<int32_t>(vertices.size())});
      vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
      indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
    }
    const auto filled = [&](const auto& values, vk::BufferUsageFlagBits usage) {
      const GpuBuffer made = gpu_.buffer(values.size() * sizeof(values[0]), usage);
      std::memcpy(made.mapped, values.data(), made.size);
      return made;
    };
    vertices_ = filled(vertices, vk::BufferUsageFlagBits::eVertexBuffer);
    indices_ = filled(indices, vk::BufferUsageFlagBits::eIndexBuffer);
    const glm::vec3 toSun = glm::normalize(glm::mat3(scene_.viewFromWorld) * scene_.toSun);
    numbers_ = filled(std::array{SceneNumbers{clipFromView(scene_, width_, height_), glm::vec4(toSun, 0.0f),
                                              glm::vec4(scene_.sun, 0.0f), glm::vec4(kAmbient, 0.0f)}},
                      vk::BufferUsageFlagBits::eUniformBuffer);
  }

  void makeSet() {
    using Type = vk::DescriptorType;
    std::vector<Binding> bindings = {{0, Type::eUniformBuffer, {}, {numbers_.buffer, 0, VK_WHOLE_SIZE}}};
    for (const GpuImage* image : {&albedo_, &normal_, &depth_})
      bindings.push_back({static_cast<uint32_t>(bindings.size()), Type::eCombinedImageSampler, image->whole, {}});
    setLayout_ = gpu_.setLayout(bindings);
    layout_ = gpu_.pipelineLayout({setLayout_});
    set_ = gpu_.descriptorSet(setLayout_, bindings);
  }

  void drawOpaque(vk::CommandBuffer commands) const {
    const vk::Rect2D area({0, 0}, {albedo_.width, albedo_.height});
    const auto target = [](const GpuImage& image) {
      return vk::RenderingAttachmentInfo(image.whole, vk::ImageLayout::eGeneral, {}, {}, {},
                                         vk::AttachmentLoadOp::eClear, vk::AttachmentStoreOp::eStore);
    };
    const vk::RenderingAttachmentInfo planes[] = {target(albedo_), target(normal_)}, depth = target(depth_),
                                      lit = target(lit_);
    commands.beginRendering(vk::RenderingInfo({}, area, 1, 0, planes, &depth));
    setArea(commands, area);
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, opaque_);
    drawMeshes(commands, layout_, false);
    commands.endRendering();
    waitForWrites(commands);
    commands.beginRendering(vk::RenderingInfo({}, area, 1, 0, lit));
    setArea(commands, area);
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, light_);
    commands.draw(3, 1, 0, 0);
    commands.endRendering();
  }

  void drawMeshes(vk::CommandBuffer commands, vk::PipelineLayout layout, bool transparent) const {
    const auto width = static_cast<float>(width_), height = static_cast<float>(height_);
    if (down_) commands.setViewport(0, vk::Viewport(0.0f, height, width, -height, 0.0f, 1.0f));
    commands.setFrontFace(down_ ? vk::FrontFace::eCounterClockwise : vk::FrontFace::eClockwise);
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout, 0, set_, {});
    commands.bindVertexBuffers(0, vertices_.buffer, {0});
    commands.bindIndexBuffer(indices_.buffer, 0, vk::IndexType::eUint32);
    for (uint32_t i = 0; i < starts_.size(); ++i) {
      const Mesh& mesh = scene_.meshes[i];
      if (mesh.material.transparent() != transparent) continue;
      commands.setCullMode(mesh.material.bothSides ? vk::CullModeFlagBits::eNone : vk::CullModeFlagBits::eBack);
      commands.pushConstants<MeshNumbers>(layout, vk::ShaderStageFlagBits::eAllGraphics, 0, meshes_[i]);
      commands.drawIndexed(static_cast<uint32_t>(mesh.indices.size()), 1, starts_[i].first, starts_[i].second, 0);
    }
  }

  Gpu& gpu_;
  const Scene& scene_;
  int width_, height_;
  bool down_;
  GpuImage albedo_, normal_, lit_, depth_, frame_;
  GpuBuffer vertices_, indices_, numbers_;
  std::vector<MeshNumbers> meshes_;
  std::vector<std::pair<uint32_t, int32_t>> starts_;  // of meshes: in indices and in vertices
  vk::DescriptorSetLayout setLayout_;
  vk::PipelineLayout layout_;
  vk::DescriptorSet set_;
  vk::Pipeline opaque_, light_;
};

}  // namespace

int main(int count, char** arguments) {
  int width = 640, height = 360;
  if (count < 3 || count > 6) stop("vulkan GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD[:TIER]] [up|down]");
  if (count > 3 && (std::sscanf(arguments[3], "%dx%d", &width, &height) != 2 || width < 1 || height < 1))
    stop("expected WIDTHxHEIGHT");
  const std::string rows = count > 5 ? arguments[5] : "down";
  if (rows != "up" && rows != "down") stop("expected up or down, found " + rows);
  try {
    const Scene scene = readScene(arguments[1]);
    Gpu gpu;
    VulkanEngine engine(gpu, scene, width, height, rows == "down");
    engine.draw(askedFor(count > 4 ? arguments[4] : "phenomenological"));
    engine.write(arguments[2]);
  } catch (const std::exception& error) {
    stop(error.what());
  }
  std::printf("validation messages: %d\n", validationMessages());
  return validationMessages() == 0 ? 0 : 1;
}
