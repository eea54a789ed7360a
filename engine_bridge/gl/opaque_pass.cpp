#include "engine_bridge/gl/opaque_pass.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "engine_bridge/gl/fences.h"
#include "engine_bridge/gl/frame_blocks.h"
#include "engine_bridge/gl/gl_program.h"
#include "engine_bridge/gl/permutation.h"
#include "engine_bridge/gl/scene_textures.h"
#include "engine_bridge/gl/targets.h"
#include "engine_bridge/scene/placed.h"

namespace pellucid {
namespace gl {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kSurfacePlanes = 4;

struct UploadedPrimitive {
  Buffer vertices, indices;
  VertexArray array;
};

UploadedPrimitive upload(const Primitive& primitive) {
  UploadedPrimitive uploaded{Buffer::make(), Buffer::make(), VertexArray::make()};
  const auto fill = [](const Buffer& buffer, const auto& values) {
    glNamedBufferData(buffer.name(), static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(),
                      GL_STATIC_DRAW);
  };
  fill(uploaded.vertices, primitive.vertices);
  fill(uploaded.indices, primitive.indices);
  const GLuint array = uploaded.array.name();
  glVertexArrayVertexBuffer(array, 0, uploaded.vertices.name(), 0, sizeof(Vertex));
  glVertexArrayElementBuffer(array, uploaded.indices.name());
  const std::pair<GLint, std::size_t> attributes[] = {{3, offsetof(Vertex, position)},
                                                      {3, offsetof(Vertex, normal)},
                                                      {4, offsetof(Vertex, uv)},
                                                      {4, offsetof(Vertex, colour)},
                                                      {2, offsetof(Vertex, tangent)}};
  for (GLuint i = 0; i < std::size(attributes); ++i) {
    glEnableVertexArrayAttrib(array, i);
    glVertexArrayAttribFormat(array, i, attributes[i].first, GL_FLOAT, GL_FALSE,
                              static_cast<GLuint>(attributes[i].second));
    glVertexArrayAttribBinding(array, i, 0);
  }
  checkGl("uploading opaque geometry");
  return uploaded;
}

class OpaquePass {
 public:
  OpaquePass(const Scene& scene, const Camera& camera, const Window& display, const OpaquePassSettings& settings);
  // Into `planes`, whose window holds `part`.
  void draw(const Window& part, OpaquePlanes& planes);

 private:
  struct Drawn {  // a primitive and where it stands
    int primitive;
    bool vertexColours;
    std::vector<std::size_t> instances;
    UploadedPrimitive uploaded;  // empty unless everything fits the budget
  };
  void collect();
  void target(int width, int height);
  // Everything nearest to the eye, with `outputs` planes.
  void sweep(const char* output, const PunctualLight* light, GLsizei outputs);
  Image<glm::vec4> read(std::size_t plane) const;

  const Scene& scene_;
  Camera camera_;
  Window display_;
  OpaquePassSettings settings_;
  SceneTextures textures_;
  std::vector<Placed> placed_;
  std::vector<PunctualLight> lights_;
  std::vector<Drawn> drawn_;
  bool resident_ = false;
  Buffer frameBuffer_, materialBuffer_, lightBuffer_;
  FrameBlock frame_;
  int width_ = 0, height_ = 0;
  Texture planes_[kSurfacePlanes], depth_;
  Framebuffer framebuffer_;
};

OpaquePass::OpaquePass(const Scene& scene, const Camera& camera, const Window& display,
                       const OpaquePassSettings& settings)
    : scene_(scene),
      camera_(camera),
      display_(display),
      settings_(settings),
      textures_(scene, true),
      placed_(placeInstances(scene, camera)),
      lights_(lightBlocks(scene.lights, camera)),
      frameBuffer_(Buffer::make()),
      materialBuffer_(Buffer::make()),
      lightBuffer_(Buffer::make()) {
  frame_.surroundings = glm::vec4(settings.surroundings, 0.0f);
  frame_.orthographic = camera.orthographic ? 1 : 0;
  collect();
}

void OpaquePass::collect() {
  std::vector<int> place(scene_.primitives.size(), -1);
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
    const auto number = static_cast<std::size_t>(scene_.instances[i].primitive);
    const Primitive& primitive = scene_.primitives.at(number);
    if (scene_.materials.at(static_cast<std::size_t>(primitive.material)).transparent()) continue;
    if (place[number] < 0) {
      place[number] = static_cast<int>(drawn_.size());
      const bool coloured = std::any_of(primitive.vertices.begin(), primitive.vertices.end(),
                                        [](const Vertex& vertex) { return vertex.colour != glm::vec4(1.0f); });
      drawn_.push_back({static_cast<int>(number), coloured, {}, {}});
      bytes += primitive.vertices.size() * sizeof(Vertex) + primitive.indices.size() * sizeof(std::uint32_t);
    }
    Drawn& drawn = drawn_[static_cast<std::size_t>(place[number])];
    drawn.vertexColours = drawn.vertexColours || scene_.instances[i].colour != glm::vec4(1.0f);
    drawn.instances.push_back(i);
  }
  resident_ = bytes <= settings_.budgetBytes;
  if (resident_)
    for (Drawn& drawn : drawn_) drawn.uploaded = upload(scene_.primitives[static_cast<std::size_t>(drawn.primitive)]);
}

void OpaquePass::target(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  framebuffer_ = Framebuffer::make();
  const auto make = [&](Texture& texture, GLenum format, GLenum attachment) {
    texture = Texture::make();
    glTextureStorage2D(texture.name(), 1, format, width, height);
    glNamedFramebufferTexture(framebuffer_.name(), attachment, texture.name(), 0);
  };
  for (GLuint i = 0; i < kSurfacePlanes; ++i) make(planes_[i], GL_RGBA32F, GL_COLOR_ATTACHMENT0 + i);
  make(depth_, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
  checkGl("making the targets of the opaque pass");
  if (glCheckNamedFramebufferStatus(framebuffer_.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::logic_error("the framebuffer of the opaque pass is incomplete");
}

void OpaquePass::sweep(const char* output, const PunctualLight* light, GLsizei outputs) {
  const GLenum attachments[kSurfacePlanes] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2,
                                              GL_COLOR_ATTACHMENT3};
  const GLuint name = framebuffer_.name();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name);
  glNamedFramebufferDrawBuffers(name, outputs, attachments);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);  // reversed
  const float none[4] = {0, 0, 0, kInfinity}, black[4] = {0, 0, 0, 0}, infinitelyFar = 0;
  for (GLint i = 0; i < outputs; ++i) glClearNamedFramebufferfv(name, GL_COLOR, i, light || i > 0 ? black : none);
  glClearNamedFramebufferfv(name, GL_DEPTH, 0, &infinitelyFar);

  frame_.lightCount = light ? 1 : 0;
  glNamedBufferData(frameBuffer_.name(), sizeof frame_, &frame_, GL_DYNAMIC_DRAW);
  const PunctualLight dark{};
  glNamedBufferData(lightBuffer_.name(), sizeof dark, light ? light : &dark, GL_DYNAMIC_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frameBuffer_.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, materialBuffer_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, lightBuffer_.name());

  FrameFeatures features;
  features.lights = light != nullptr;
  features.surroundings = settings_.surroundings != glm::vec3(0.0f);
  // Windings are counter-clockwise as seen in view space: the loader turns those of instances that mirror.
  glFrontFace(GL_CCW);
  glCullFace(GL_BACK);
  for (const Drawn& drawn : drawn_) {
    const Primitive& primitive = scene_.primitives[static_cast<std::size_t>(drawn.primitive)];
    const Material& material = scene_.materials[static_cast<std::size_t>(primitive.material)];
    std::vector<std::string> defines = surfaceDefines(material, drawn.vertexColours, features);
    defines.emplace_back(output);
    const Program& program = programs().get("gl/transparent.vert", "gl/opaque.frag", defines);
    glUseProgram(program.name.name());
    textures_.bind(material, settings_.filter);
    const MaterialBlock block = materialBlock(material);
    glNamedBufferData(materialBuffer_.name(), sizeof block, &block, GL_DYNAMIC_DRAW);
    const UploadedPrimitive passing = resident_ ? UploadedPrimitive{} : upload(primitive);
    glBindVertexArray(resident_ ? drawn.uploaded.array.name() : passing.array.name());
    if (material.bothSides())
      glDisable(GL_CULL_FACE);
    else
      glEnable(GL_CULL_FACE);
    for (const std::size_t instance : drawn.instances) {
      const Placed& placed = placed_[instance];
      program.placeObject(placed.viewFromObject, 0.0);
      glUniformMatrix3fv(program.normalFromObject, 1, GL_FALSE, &placed.normalFromObject[0][0]);
      glUniform1f(program.thicknessScale, placed.thicknessScale);
      glUniform4fv(program.instanceColour, 1, &scene_.instances[instance].colour[0]);
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(primitive.indices.size() / 3 * 3), GL_UNSIGNED_INT, nullptr);
    }
  }
  fences().mark();
  glDisable(GL_DEPTH_TEST);
  checkGl("drawing opaque triangles");
}

Image<glm::vec4> OpaquePass::read(std::size_t plane) const {
  Image<glm::vec4> image(width_, height_);
  constexpr std::size_t most = std::numeric_limits<GLsizei>::max();
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureImage(planes_[plane].name(), 0, GL_RGBA, GL_FLOAT,
                    static_cast<GLsizei>(std::min(image.size() * sizeof(glm::vec4), most)), image.data());
  checkGl("reading the opaque planes back");
  return image;
}

void OpaquePass::draw(const Window& part, OpaquePlanes& planes) {
  target(part.width(), part.height());
  frame_.clipFromView = glm::mat4(clipFromView(camera_, display_, part, {0.5, 0.5}));
  glViewport(0, 0, width_, height_);
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  const glm::mat3 worldFromView(glm::transpose(glm::dmat3(camera_.viewFromWorld)));
  const auto each = [&](auto&& store) {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const int column = part.x0 - planes.window.x0 + x, row = part.y0 - planes.window.y0 + y;
        store(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x),
              static_cast<std::size_t>(row) * static_cast<std::size_t>(planes.window.width()) +
                  static_cast<std::size_t>(column));
      }
  };
  sweep("OUTPUT_SURFACE", nullptr, kSurfacePlanes);
  const Image<glm::vec4> normalZ = read(0), albedo = read(1), emission = read(2), indirect = read(3);
  each([&](std::size_t from, std::size_t to) {
    planes.viewZ[to] = normalZ[from].a;
    const bool hit = normalZ[from].a < kInfinity;
    planes.normal[to] = hit ? glm::normalize(worldFromView * glm::vec3(normalZ[from])) : glm::vec3(0.0f);
    planes.albedo[to] = glm::vec3(albedo[from]);
    if (!planes.emission.empty()) planes.emission[to] = glm::vec3(emission[from]);
    if (!planes.indirect.empty()) planes.indirect[to] = glm::vec3(indirect[from]);
  });
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    sweep("OUTPUT_LIGHT", &lights_[i], 1);
    const Image<glm::vec4> radiance = read(0);
    each([&](std::size_t from, std::size_t to) { planes.lights[i].radiance[to] = glm::vec3(radiance[from]); });
  }
  each([&](std::size_t from, std::size_t to) {
    const bool hit = normalZ[from].a < kInfinity, seen = settings_.surroundings != glm::vec3(0.0f);
    sumBeauty(planes, to, hit ? glm::vec3(0.0f) : settings_.surroundings, hit || seen ? 1.0f : 0.0f);
  });
}

}  // namespace
}  // namespace gl

OpaquePlanes rasteriseOpaque(GlContext&, const Scene& scene, const Camera& camera, const Window& display,
                             const Window& data, const OpaquePassSettings& settings) {
  OpaquePlanes planes = emptyOpaquePlanes(data, lightLayerNames(scene.lights), false,
                                          settings.surroundings != glm::vec3(0.0f), opaqueEmits(scene));
  gl::OpaquePass pass(scene, camera, display, settings);
  using gl::kSuperTile;
  for (int y = data.y0; y < data.y1; y += kSuperTile)
    for (int x = data.x0; x < data.x1; x += kSuperTile)
      pass.draw({x, y, std::min(x + kSuperTile, data.x1), std::min(y + kSuperTile, data.y1)}, planes);
  return planes;
}

}  // namespace pellucid
