#include "engine_bridge/gl/resolve_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine_bridge/gl/fences.h"
#include "engine_bridge/gl/gl_program.h"
#include "engine_bridge/gl/plane_formats.h"
#include "gbuffer/errors.h"
#include "gbuffer/plane_values.h"
#include "shaders/plane_defines.h"
#include "shaders/spread_pyramid_text.h"

namespace pellucid {
namespace {

constexpr int kOutputs = 3;

gl::Texture upload(const void* texels, int width, int height, GLenum stored, GLenum format) {
  gl::Texture texture = gl::Texture::make();
  glTextureStorage2D(texture.name(), 1, stored, width, height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTextureSubImage2D(texture.name(), 0, 0, 0, width, height, format, GL_FLOAT, texels);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

template <class T>
gl::Texture upload(const Image<T>& plane, GLenum stored, GLenum format) {
  return upload(plane.data(), plane.width(), plane.height(), stored, format);
}

// Its components side by side, as memory may not have them.
gl::Texture uploadPlane(const OitPlanes& planes, const PlaneSpec& plane) {
  const auto components = static_cast<std::size_t>(plane.components());
  Image<float> texels(planes.data.width() * plane.components(), planes.data.height());
  for (std::size_t c = 0; c < components; ++c) {
    const ConstPlaneValues values = valuesOf(planes, plane.sum, static_cast<int>(c));
    for (std::size_t i = 0; i < planes.radiance.size(); ++i) texels[components * i + c] = values[i];
  }
  return upload(texels.data(), planes.data.width(), planes.data.height(), gl::formatOf(plane.format),
                gl::channelsOf(plane.components()));
}

gl::Texture target(int width, int height) {
  gl::Texture texture = gl::Texture::make();
  glTextureStorage2D(texture.name(), 1, GL_RGBA32F, width, height);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

void drawBuffers(GLuint framebuffer, GLsizei count) {
  const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2, GL_COLOR_ATTACHMENT3,
                                GL_COLOR_ATTACHMENT4};
  glNamedFramebufferDrawBuffers(framebuffer, count, attachments);
  if (glCheckNamedFramebufferStatus(framebuffer, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::logic_error("a framebuffer of the resolve pass is incomplete");
}

}  // namespace

struct ResolvePass::Impl {
  gl::VertexArray noVertices = gl::VertexArray::make();
  gl::Framebuffer spreadFrame = gl::Framebuffer::make();
  gl::Texture spread[kSpreadPlanes];
  int atlasWidth = 0, atlasHeight = 0;
  std::vector<glm::ivec4> levels;  // as spreadLevels of shaders/gl/spread_texels.glsl

  // Rooms of the levels in the atlas, and the atlas where it is too small.
  void layOut(int width, int height, int count) {
    constexpr int margins = 2 * shading::PLD_SPREAD_MARGIN;
    levels.assign(25, glm::ivec4(1, 1, 0, 0));
    int wide = 1, rows = 0;
    for (int k = 1; k <= count; ++k) {
      const int w = ((width + (1 << k) - 1) >> k) + margins, h = ((height + (1 << k) - 1) >> k) + margins;
      levels[static_cast<std::size_t>(k)] = {w, h, rows, 0};
      wide = std::max(wide, w);
      rows += h;
    }
    rows = std::max(rows, 1);
    if (spread[0] && wide <= atlasWidth && rows <= atlasHeight) return;
    atlasWidth = wide;
    atlasHeight = rows;
    for (int i = 0; i < kSpreadPlanes; ++i) {
      spread[i] = target(wide, rows);
      glNamedFramebufferTexture(spreadFrame.name(), GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i), spread[i].name(), 0);
    }
    gl::checkGl("making the spread pyramid");
    drawBuffers(spreadFrame.name(), kSpreadPlanes);
  }

  const gl::Program& use(const char* stage, const std::vector<std::string>& defines) {
    const gl::Program& program = gl::programs().get("gl/fullscreen.vert", stage, defines);
    glUseProgram(program.name.name());
    const GLint place = glGetUniformLocation(program.name.name(), "spreadLevels");
    if (place >= 0) glUniform4iv(place, static_cast<GLsizei>(levels.size()), &levels[0].x);
    return program;
  }

  // A texel of one level reads those of the one below it, of the same textures: a barrier lies between the draws.
  void drawSpread(int count, const std::vector<std::string>& defines) {
    if (count == 0) return;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, spreadFrame.name());
    const gl::Program& program = use("gl/spread_level.frag", defines);
    const GLint level = glGetUniformLocation(program.name.name(), "level");
    glEnable(GL_SCISSOR_TEST);
    glViewport(0, 0, atlasWidth, atlasHeight);
    for (int k = 1; k <= count; ++k) {
      const glm::ivec4& part = levels[static_cast<std::size_t>(k)];
      glScissor(0, part.z, part.x, part.y);
      glUniform1i(level, k);
      glDrawArrays(GL_TRIANGLES, 0, 3);
      gl::fences().mark();
      glTextureBarrier();
    }
    glDisable(GL_SCISSOR_TEST);
    gl::checkGl("drawing the spread pyramid");
  }
};

ResolvePass::ResolvePass(GlContext&) : impl_(new Impl) {}
ResolvePass::~ResolvePass() = default;

void ResolvePass::draw(const ResolveTextures& textures, int width, int height, float largestVariance,
                       const DeviceResolveSettings& settings, std::uint32_t framebuffer) {
  const float largestSpread = std::hypot(static_cast<float>(width), static_cast<float>(height));
  const LayerModel& layers = textures.layers;
  const bool pyramid = layers.scatters() && !settings.exact && settings.kernel == shading::PLD_DIFFUSE_GAUSSIAN;
  const int levels = pyramid ? shading::spreadLevel(shading::kernelSpread(largestVariance, largestSpread)) : 0;
  impl_->layOut(width, height, levels);
  const auto bind = [](int unit, GLuint texture) {
    glBindTextureUnit(static_cast<GLuint>(unit), texture);
    glBindSampler(static_cast<GLuint>(unit), 0);
  };
  bind(kBackgroundUnit, textures.background);
  bind(kOpaqueZUnit, textures.opaqueZ);
  bind(kSolidUnit, textures.solid);
  for (const PlaneSpec& plane : planesOf(layers))
    bind(plane.unit, textures.planes.at(static_cast<std::size_t>(plane.sum)));
  for (int i = 0; i < kSpreadPlanes; ++i) bind(kSpreadUnit + i, impl_->spread[i].name());
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  glBindVertexArray(impl_->noVertices.name());
  std::vector<std::string> defines = readDefines(layers);
  impl_->drawSpread(levels, defines);
  if (settings.published) defines.emplace_back("DECODED_PUBLISHED");

  const GLuint program = impl_->use("gl/resolve.frag", defines).name.name();
  glUniform1i(glGetUniformLocation(program, "modulateSelf"), settings.selfModulation ? 1 : 0);
  glUniform3i(glGetUniformLocation(program, "lookup"), settings.kernel, settings.exact ? 1 : 0, levels);
  glUniform1f(glGetUniformLocation(program, "largestSpread"), largestSpread);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  gl::fences().mark();
  glUseProgram(0);
  gl::checkGl("resolving");
}

DeviceVeil ResolvePass::resolve(const OitPlanes& planes, const GBuffer& background,
                                const DeviceResolveSettings& settings) {
  const int width = planes.data.width(), height = planes.data.height();
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (std::max(width, height) > most)
    throw ResourceError(
        fmt::format("GL: a picture of {}x{}: the device resolves at most {} pixels across", width, height, most));
  std::vector<gl::Texture> kept;
  const auto keep = [&kept](gl::Texture texture) {
    kept.push_back(std::move(texture));
    return kept.back().name();
  };
  ResolveTextures textures;
  textures.layers = modelOf(planes);
  for (const PlaneSpec& plane : planesOf(textures.layers))
    textures.planes.at(static_cast<std::size_t>(plane.sum)) = keep(uploadPlane(planes, plane));
  textures.solid = keep(upload(planes.solid, GL_RGBA32F, GL_RGBA));
  textures.background = keep(upload(background.beauty, GL_RGBA32F, GL_RGBA));
  textures.opaqueZ = keep(upload(background.viewZ, GL_R32F, GL_RED));
  float largestVariance = 0.0f;
  for (std::size_t i = 0; i < planes.refraction.size(); ++i)
    largestVariance = std::max(largestVariance, planes.refraction[i].w);

  const gl::Framebuffer frame = gl::Framebuffer::make();
  GLuint outputs[kOutputs];
  for (GLuint i = 0; i < kOutputs; ++i) {
    outputs[i] = keep(target(width, height));
    glNamedFramebufferTexture(frame.name(), GL_COLOR_ATTACHMENT0 + i, outputs[i], 0);
  }
  gl::checkGl("uploading planes to resolve");
  drawBuffers(frame.name(), kOutputs);
  draw(textures, width, height, largestVariance, settings, frame.name());

  DeviceVeil veil;
  Image<glm::vec4>* images[] = {&veil.light, &veil.transmission, &veil.applied};
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  for (std::size_t i = 0; i < kOutputs; ++i) {
    *images[i] = Image<glm::vec4>(width, height);
    const std::size_t bytes = images[i]->size() * sizeof(glm::vec4);
    constexpr std::size_t limit = std::numeric_limits<GLsizei>::max();
    glGetTextureImage(outputs[i], 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(std::min(bytes, limit)),
                      images[i]->data());
  }
  gl::checkGl("reading the resolved planes back");
  return veil;
}

}  // namespace pellucid
