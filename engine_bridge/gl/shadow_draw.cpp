#include "engine_bridge/gl/shadow_draw.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "engine_bridge/gl/fences.h"
#include "engine_bridge/gl/permutation.h"
#include "engine_bridge/gl/solidity.h"
#include "engine_bridge/gl/targets.h"
#include "engine_bridge/scene/closed.h"
#include "engine_bridge/scene/triangle_source.h"

namespace pellucid::gl {
namespace {

// Maps tell nothing apart that floats about the object's origin do not.
constexpr double kCoarse = std::numeric_limits<double>::infinity();

constexpr const char* kVertexStage = "gl/transparent.vert";
constexpr double kCullTexels = 2.0;  // that a caster may lie behind the opaque: both are rasterised

// Mirrors shaders/gl/shadow_frame.glsl.
struct ShadowFrameBlock {
  glm::vec4 metric;
  glm::uvec4 texels;
  glm::mat4 lightFromEye;
  glm::vec4 lens;
  glm::ivec4 picture, plane;
};
static_assert(sizeof(ShadowFrameBlock) == 144);

Texture target(GLenum format, int width, int height) {
  Texture texture = Texture::make();
  glTextureStorage2D(texture.name(), 1, format, width, height);
  return texture;
}

void requireComplete(const Framebuffer& frame) {
  checkGl("making the targets of shadow maps");
  if (glCheckNamedFramebufferStatus(frame.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::logic_error("a framebuffer of the shadow maps is incomplete");
}

template <class T>
Image<T> readBack(const Texture& texture, GLenum format, int width, int height) {
  Image<T> image(width, height);
  constexpr std::size_t most = std::numeric_limits<GLsizei>::max();
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureImage(texture.name(), 0, format, GL_FLOAT, static_cast<GLsizei>(std::min(image.size() * sizeof(T), most)),
                    image.data());
  checkGl("reading shadow maps back");
  return image;
}

}  // namespace

ShadowDrawer::ShadowDrawer(const Scene& scene, const Camera& camera, const GBuffer* gbuffer,
                           const ShadowMapSettings& settings)
    : scene_(scene),
      camera_(camera),
      gbuffer_(gbuffer),
      settings_(settings),
      textures_(scene),
      stream_(scene),
      opaqueStream_(scene, true),
      frameBuffer_(Buffer::make()),
      shadowBuffer_(Buffer::make()),
      materialBuffer_(Buffer::make()),
      opaqueFrame_(Framebuffer::make()),
      casterFrame_(Framebuffer::make()),
      noVertices_(VertexArray::make()) {
  FrameFeatures features;
  features.mask = MaskEdge::hard;
  std::vector<bool> used(scene.primitives.size(), false);
  for (const Instance& instance : scene.instances) used[static_cast<std::size_t>(instance.primitive)] = true;
  const std::vector<ColourRange> drawnColours = coloursDrawn(scene);
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const Primitive& primitive = scene.primitives[i];
    const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
    Look look;
    if (used[i] && castsInto(Casters::opaque, material)) sceneIsOpaque_ = true;
    if (used[i] && castsInto(Casters::transparent, material)) {
      const ColourRange& colours = drawnColours[i];
      const bool vertexColours = colours.least != glm::vec4(1.0f) || colours.most != glm::vec4(1.0f);
      look.casts = true;
      look.bothSides = primitive.points || material.bothSides() || !isClosed(primitive);
      look.defines = surfaceDefines(material, vertexColours, features, false, primitive.points);
      for (std::string& define : textures_.defines(material, TextureFilter::bilinear))
        look.defines.push_back(std::move(define));
      std::erase(look.defines, "NORMAL_TEXTURE");  // a caster is as dense as its mesh says
      look.defines.emplace_back("EXACT_COVERAGE");
      if (canTransmitColour(material, vertexColours)) grey_ = false;
    }
    looks_.push_back(std::move(look));
  }
  if (grey_)
    for (Look& look : looks_) look.defines.emplace_back("GREY");
  if (sceneIsOpaque_) gbuffer_ = nullptr;
  if (gbuffer_ && (gbuffer_->viewZ.width() < 2 || gbuffer_->viewZ.height() < 2)) gbuffer_ = nullptr;
  if (gbuffer_) pictureZ_ = uploadPlane(gbuffer_->viewZ, {0, 0, gbuffer_->viewZ.width(), gbuffer_->viewZ.height()});

  GLint alignment = 1;
  glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
  const auto step = static_cast<std::size_t>(alignment);
  materialStride_ = (sizeof(MaterialBlock) + step - 1) / step * step;
  std::vector<std::uint8_t> materials(std::max<std::size_t>(materialStride_ * scene.materials.size(), 1));
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const MaterialBlock block = materialBlock(scene.materials[i]);
    std::memcpy(&materials[i * materialStride_], &block, sizeof(block));
  }
  glNamedBufferData(materialBuffer_.name(), static_cast<GLsizeiptr>(materials.size()), materials.data(),
                    GL_STATIC_DRAW);
  checkGl("preparing shadow maps");
}

void ShadowDrawer::begin(const ShadowFaceJob& job) {
  job_ = job;
  placed_ = placeInstances(scene_, job.view.camera);
}

void ShadowDrawer::beginPart(int first, int count) {
  if (width_ != job_.edge || height_ != count) {
    width_ = job_.edge;
    height_ = count;
    opaque_ = target(GL_R32F, width_, height_);
    glNamedFramebufferTexture(opaqueFrame_.name(), GL_COLOR_ATTACHMENT0, opaque_.name(), 0);
    requireComplete(opaqueFrame_);
    nearest_.reset();
  }
  const Window face{0, 0, job_.edge, job_.edge}, part{0, first, job_.edge, first + count};
  FrameBlock frame;
  frame.clipFromView = glm::mat4(clipFromView(job_.view.camera, face, part, {0.5, 0.5}));
  frame.orthographic = job_.view.camera.orthographic ? 1 : 0;
  frame.viewport = glm::vec2(width_, height_);
  glNamedBufferData(frameBuffer_.name(), sizeof frame, &frame, GL_DYNAMIC_DRAW);

  ShadowFrameBlock shadow{};
  // The depth that texels span on a surface of 45 degrees.
  const double texel =
      job_.radial ? 2.0 / (job_.view.camera.focal.x * job_.edge)
                  : 2.0 * job_.scale / (std::min(job_.view.camera.focal.x, job_.view.camera.focal.y) * job_.edge);
  shadow.metric =
      glm::vec4(glm::dvec4(job_.scale, job_.radial ? job_.offset : job_.offset - job_.scale * job_.view.back,
                           job_.radial ? 1.0 : 0.0, kCullTexels * texel));
  shadow.texels = {
      0u, static_cast<std::uint32_t>(first),
      settings_.form == ShadowMapSettings::Form::naive || settings_.form == ShadowMapSettings::Form::published ? 1u
                                                                                                               : 0u,
      job_.seed};
  if (gbuffer_) {
    shadow.lightFromEye = glm::mat4(job_.view.camera.viewFromWorld * glm::inverse(camera_.viewFromWorld));
    shadow.lens = glm::vec4(glm::dvec4(camera_.focal, camera_.centre));
    shadow.picture = {gbuffer_->display.width(), gbuffer_->display.height(), gbuffer_->data.x0 - gbuffer_->display.x0,
                      gbuffer_->data.y0 - gbuffer_->display.y0};
    shadow.plane = {gbuffer_->viewZ.width(), gbuffer_->viewZ.height(), camera_.orthographic ? 1 : 0, 0};
  }
  glNamedBufferData(shadowBuffer_.name(), sizeof shadow, &shadow, GL_DYNAMIC_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frameBuffer_.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, 2, shadowBuffer_.name());
  glViewport(0, 0, width_, height_);
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_DEPTH_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  glFrontFace(GL_CCW);
  glCullFace(GL_BACK);
}

void ShadowDrawer::drawOpaque() {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, opaqueFrame_.name());
  const float nothing[4] = {shading::PLD_SHADOW_NOTHING, 0, 0, 0};
  glClearNamedFramebufferfv(opaqueFrame_.name(), GL_COLOR, 0, nothing);
  glBlendFunc(GL_ONE, GL_ONE);
  glBlendEquation(GL_MIN);
  glDisable(GL_CULL_FACE);
  if (gbuffer_) {
    const Program& program = programs().get("gl/picture_mesh.vert", "gl/shadow_opaque.frag", {});
    glUseProgram(program.name.name());
    glBindTextureUnit(7, pictureZ_.name());
    glBindSampler(7, 0);
    glBindVertexArray(noVertices_.name());
    const int quads = (gbuffer_->viewZ.width() - 1) * (gbuffer_->viewZ.height() - 1);
    glDrawArrays(GL_TRIANGLES, 0, quads * 6);
    fences().mark();
  } else if (sceneIsOpaque_) {
    const Program& program = programs().get(kVertexStage, "gl/shadow_opaque.frag", {"EXACT_COVERAGE"});
    glUseProgram(program.name.name());
    opaqueStream_.sweep(settings_.order, settings_.budgetBytes / 4, [&](const std::vector<ChunkDraw>& draws) {
      for (const ChunkDraw& one : draws) {
        const Primitive& primitive =
            scene_.primitives[static_cast<std::size_t>(scene_.instances[one.instance].primitive)];
        if (!castsInto(Casters::opaque, scene_.materials[static_cast<std::size_t>(primitive.material)])) continue;
        program.placeObject(placed_[one.instance].viewFromObject, kCoarse);
        glUniformMatrix3fv(program.normalFromObject, 1, GL_FALSE, &placed_[one.instance].normalFromObject[0][0]);
        glDrawArrays(GL_TRIANGLES, static_cast<GLint>(one.firstTriangle * 3), static_cast<GLsizei>(one.triangles * 3));
      }
    });
  }
  checkGl("drawing opaque casters");
}

void ShadowDrawer::drawCasters() {
  if (!nearest_) {
    nearest_ = target(GL_RGBA32F, width_, height_);
    glNamedFramebufferTexture(casterFrame_.name(), GL_COLOR_ATTACHMENT0, nearest_.name(), 0);
    if (!grey_) {
      steps_ = target(GL_RGBA32F, width_, height_);
      glNamedFramebufferTexture(casterFrame_.name(), GL_COLOR_ATTACHMENT1, steps_.name(), 0);
    }
    const GLenum both[2] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(casterFrame_.name(), grey_ ? 1 : 2, both);
    requireComplete(casterFrame_);
  }
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, casterFrame_.name());
  const float far = shading::PLD_SHADOW_NOTHING;
  const float nothing[4] = {far, far, far, 0}, none[4] = {0, 0, 0, 0};
  glClearNamedFramebufferfv(casterFrame_.name(), GL_COLOR, 0, nothing);
  if (!grey_) glClearNamedFramebufferfv(casterFrame_.name(), GL_COLOR, 1, none);
  for (GLuint i = 0; i < 2; ++i) {
    glBlendFunci(i, GL_ONE, GL_ONE);
    glBlendEquationSeparatei(i, i == 0 ? GL_MIN : GL_FUNC_ADD, GL_FUNC_ADD);
  }
  glBindTextureUnit(5, opaque_.name());
  glBindSampler(5, 0);
  const Program* program = nullptr;
  int boundMaterial = -1;
  stream_.sweep(settings_.order, settings_.budgetBytes / 2, [&](const std::vector<ChunkDraw>& draws) {
    for (const ChunkDraw& one : draws) {
      const Instance& instance = scene_.instances[one.instance];
      Look& look = looks_[static_cast<std::size_t>(instance.primitive)];
      if (!look.casts) continue;
      const Primitive& primitive = scene_.primitives[static_cast<std::size_t>(instance.primitive)];
      if (!look.program) look.program = &programs().get(kVertexStage, "gl/shadow_caster.frag", look.defines);
      if (look.program != program) glUseProgram(look.program->name.name());
      program = look.program;
      if (boundMaterial != primitive.material) {
        boundMaterial = primitive.material;
        textures_.bind(scene_.materials[static_cast<std::size_t>(boundMaterial)], TextureFilter::bilinear);
        glBindBufferRange(GL_UNIFORM_BUFFER, 1, materialBuffer_.name(),
                          static_cast<GLintptr>(static_cast<std::size_t>(boundMaterial) * materialStride_),
                          sizeof(MaterialBlock));
      }
      if (look.bothSides)
        glDisable(GL_CULL_FACE);
      else
        glEnable(GL_CULL_FACE);
      const Placed& placed = placed_[one.instance];
      program->placeObject(placed.viewFromObject, kCoarse);
      glUniformMatrix3fv(program->normalFromObject, 1, GL_FALSE, &placed.normalFromObject[0][0]);
      glUniform1f(program->thicknessScale, placed.thicknessScale);
      glUniform4fv(program->instanceColour, 1, &instance.colour[0]);
      glUniform1f(program->pointScale,
                  placed.thicknessScale * scene_.materials[static_cast<std::size_t>(boundMaterial)].pointScale);
      glUniform1ui(program->instanceIdentity, instance.identity);
      glDrawArrays(GL_TRIANGLES, static_cast<GLint>(one.firstTriangle * 3), static_cast<GLsizei>(one.triangles * 3));
    }
  });
  checkGl("drawing transparent casters");
}

DrawnBand ShadowDrawer::casters(int first, int count) {
  beginPart(first, count);
  drawOpaque();
  drawCasters();
  DrawnBand band;
  band.nearest = readBack<glm::vec4>(nearest_, GL_RGBA, width_, height_);
  if (!grey_) band.steps = readBack<glm::vec4>(steps_, GL_RGBA, width_, height_);
  return band;
}

Image<float> ShadowDrawer::opaque(int first, int count) {
  beginPart(first, count);
  drawOpaque();
  return readBack<float>(opaque_, GL_RED, width_, height_);
}

}  // namespace pellucid::gl
