#include "tests/bridge/recipe_host.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace pellucid::test {
namespace {

constexpr uint64_t kFragmentsAPixel = 8;
// In the order of pld_format, pld_factor, pld_blend_op and pld_compare.
constexpr GLenum kFormats[] = {GL_RGBA32F, GL_R16F,    GL_RG16F, GL_RGBA16F,   GL_R32F,
                               GL_RG32F,   GL_RGBA32F, GL_RGBA8, GL_RG8_SNORM, GL_DEPTH_COMPONENT32F};
constexpr GLenum kFactors[] = {GL_ZERO, GL_ONE, GL_ONE_MINUS_SRC_COLOR};
constexpr GLenum kOps[] = {GL_FUNC_ADD, GL_MIN, GL_FUNC_REVERSE_SUBTRACT};
constexpr GLenum kCompares[] = {GL_ALWAYS, GL_LEQUAL, GL_GEQUAL, GL_GREATER};
constexpr GLuint kDrawBuffers = 8;

}  // namespace

std::size_t differingWords(const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  std::size_t differing = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    differing += std::memcmp(&a[i], &b[i], sizeof(float)) != 0;
  return differing;
}

RecipeHost::RecipeHost(const pld_recipe& recipe, const Host& host, const std::function<std::string(pld_stage)>& main)
    : recipe_(recipe), host_(host) {
  for (uint32_t i = 0; i < pld_recipe_image_count(&recipe); ++i) images_.push_back(makeImage(i));
  buffers_.resize(pld_recipe_buffer_count(&recipe));
  glCreateBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  const uint64_t fragments = kFragmentsAPixel * static_cast<uint64_t>(host.width * host.height);
  for (uint32_t i = 0; i < buffers_.size(); ++i) {
    uint64_t bytes = 0;
    EXPECT_EQ(pld_recipe_buffer_size(&recipe, i, host.width, host.height, fragments, &bytes, nullptr), PLD_OK);
    glNamedBufferData(buffers_[i], static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_COPY);
  }
  for (uint32_t i = 0; i < pld_recipe_pass_count(&recipe); ++i) {
    const pld_recipe_pass& pass = *pld_recipe_pass_at(&recipe, i);
    const bool draws = pass.kind == PLD_PASS_DRAWS;
    programs_.push_back(
        makeProgram(draws ? kFullscreenVertex : pass.vertex,
                    draws ? "#version 450 core\n" + std::string(pass.fragment) + main(pass.stage) : pass.fragment));
    EXPECT_NE(programs_.back(), 0u) << pass.name;
  }
  glCreateFramebuffers(1, &frame_);
  glCreateBuffers(1, &constants_);
  glCreateVertexArrays(1, &vertexArray_);
  glCreateSamplers(1, &sampler_);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glSamplerParameteri(sampler_, filter, GL_NEAREST);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glSamplerParameteri(sampler_, wrap, GL_CLAMP_TO_EDGE);
}

RecipeHost::~RecipeHost() {
  for (uint32_t i = 0; i < images_.size(); ++i) {
    glDeleteTextures(static_cast<GLsizei>(images_[i].layers.size()), images_[i].layers.data());
    const pld_role role = pld_recipe_image_at(&recipe_, i)->role;
    if (role == PLD_ROLE_OWN || role > PLD_ROLE_PICTURE) glDeleteTextures(1, &images_[i].texture);
  }
  for (const GLuint program : programs_) glDeleteProgram(program);
  glDeleteBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  glDeleteBuffers(1, &constants_);
  glDeleteFramebuffers(1, &frame_);
  glDeleteVertexArrays(1, &vertexArray_);
  glDeleteSamplers(1, &sampler_);
}

RecipeHost::Image RecipeHost::makeImage(uint32_t index) const {
  const pld_recipe_image& image = *pld_recipe_image_at(&recipe_, index);
  const GLuint hosts[] = {0, host_.colour, host_.depth, host_.occlusion, host_.output};
  if (image.role > PLD_ROLE_OWN && image.role <= PLD_ROLE_PICTURE) return {hosts[image.role], {}};
  if (image.role == PLD_ROLE_SHADOW_DEPTH) return {};
  const bool isArray = image.layers > 1 || image.role == PLD_ROLE_SHADOW_MAPS;
  int32_t size[2];
  EXPECT_EQ(pld_recipe_image_size(&recipe_, index, host_.width, host_.height, size), PLD_OK);
  const GLenum format = kFormats[image.format];
  Image made;
  glCreateTextures(isArray ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D, 1, &made.texture);
  if (!isArray) {
    glTextureStorage2D(made.texture, 1, format, size[0], size[1]);
    return made;
  }
  glTextureStorage3D(made.texture, 1, format, size[0], size[1], static_cast<GLsizei>(image.layers));
  made.layers.resize(image.layers);
  glGenTextures(static_cast<GLsizei>(image.layers), made.layers.data());
  for (GLuint i = 0; i < image.layers; ++i)
    glTextureView(made.layers[i], GL_TEXTURE_2D, made.texture, format, 0, 1, i, 1);
  return made;
}

GLuint RecipeHost::viewOf(const pld_recipe_read& read, uint32_t repeat) const {
  const Image& image = images_[read.image];
  if (image.layers.empty() || read.layer == PLD_LAYERS_ALL) return image.texture;
  return image.layers[read.layer == PLD_LAYER_BEFORE ? (repeat + 1) % image.layers.size()
                                                     : static_cast<std::size_t>(read.layer)];
}

GLuint RecipeHost::layerOf(const pld_recipe_attachment& one, const Turn& turn) const {
  const Image& image = images_[one.image];
  if (image.layers.empty()) return image.texture;
  return one.layer == PLD_LAYER_OF_FACE ? image.layers[static_cast<uint32_t>(turn.faceLayer) + one.location]
                                        : image.layers[turn.repeat % image.layers.size()];
}

// To frame_, cleared where the pass says so.
void RecipeHost::attach(const pld_recipe_pass& pass, const Turn& turn) const {
  GLenum buffers[kDrawBuffers] = {};
  for (GLuint i = 0; i < kDrawBuffers; ++i) glNamedFramebufferTexture(frame_, GL_COLOR_ATTACHMENT0 + i, 0, 0);
  for (uint32_t i = 0; i < pass.attachment_count; ++i) {
    const pld_recipe_attachment& one = pass.attachments[i];
    buffers[one.location] = GL_COLOR_ATTACHMENT0 + one.location;
    glNamedFramebufferTexture(frame_, buffers[one.location], layerOf(one, turn), 0);
  }
  const GLuint depth = pass.depth_image == PLD_NO_IMAGE ? 0
                       : pld_recipe_image_at(&recipe_, pass.depth_image)->role == PLD_ROLE_SHADOW_DEPTH
                           ? turn.faceDepth
                           : images_[pass.depth_image].texture;
  glNamedFramebufferTexture(frame_, GL_DEPTH_ATTACHMENT, depth, 0);
  glNamedFramebufferParameteri(frame_, GL_FRAMEBUFFER_DEFAULT_WIDTH, host_.width);  // of passes without attachments
  glNamedFramebufferParameteri(frame_, GL_FRAMEBUFFER_DEFAULT_HEIGHT, host_.height);
  glNamedFramebufferDrawBuffers(frame_, kDrawBuffers, buffers);
  EXPECT_EQ(glCheckNamedFramebufferStatus(frame_, GL_DRAW_FRAMEBUFFER), static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE));
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(pass.depth_write ? GL_TRUE : GL_FALSE);
  for (uint32_t i = 0; i < pass.attachment_count; ++i)
    if (pass.attachments[i].load == PLD_LOAD_CLEAR)
      glClearNamedFramebufferfv(frame_, GL_COLOR, static_cast<GLint>(pass.attachments[i].location),
                                pld_recipe_image_at(&recipe_, pass.attachments[i].image)->clear);
  if (pass.depth_write) glClearNamedFramebufferfv(frame_, GL_DEPTH, 0, &pass.depth_clear);
}

void RecipeHost::setBlending(const pld_recipe_pass& pass) const {
  glDisable(GL_BLEND);
  for (uint32_t i = 0; i < pass.attachment_count; ++i) {
    const pld_recipe_attachment& one = pass.attachments[i];
    const auto writes = [&](uint32_t bit) { return static_cast<GLboolean>((one.write_mask & bit) != 0); };
    glColorMaski(one.location, writes(1), writes(2), writes(4), writes(8));
    if (!one.blend.enabled) continue;
    glEnablei(GL_BLEND, one.location);
    glBlendFuncSeparatei(one.location, kFactors[one.blend.source], kFactors[one.blend.destination],
                         kFactors[one.blend.alpha_source], kFactors[one.blend.alpha_destination]);
    glBlendEquationSeparatei(one.location, kOps[one.blend.op], kOps[one.blend.alpha_op]);
  }
  pass.depth_compare == PLD_COMPARE_NONE ? glDisable(GL_DEPTH_TEST) : glEnable(GL_DEPTH_TEST);
  glDepthFunc(kCompares[pass.depth_compare]);
}

void RecipeHost::bind(const pld_recipe_pass& pass, uint32_t repeat) const {
  for (uint32_t i = 0; i < pass.read_count; ++i) {
    glBindTextureUnit(pass.reads[i].binding, viewOf(pass.reads[i], repeat));
    glBindSampler(pass.reads[i].binding, sampler_);
  }
  for (uint32_t i = 0; i < pass.storage_count; ++i) {
    const uint32_t buffer = pass.storage[i].buffer;
    uint64_t bytes = 0, zeroed = 0;
    const uint64_t fragments = kFragmentsAPixel * static_cast<uint64_t>(host_.width * host_.height);
    pld_recipe_buffer_size(&recipe_, buffer, host_.width, host_.height, fragments, &bytes, &zeroed);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, pass.storage[i].binding, buffers_[buffer]);
    if (pass.storage[i].empties)
      glClearNamedBufferSubData(buffers_[buffer], GL_R32UI, 0, static_cast<GLsizeiptr>(zeroed), GL_RED_INTEGER,
                                GL_UNSIGNED_INT, nullptr);
  }
  glBindBufferBase(GL_UNIFORM_BUFFER, pass.constants_binding, constants_);
}

// All that a pass needs but its draw.
void RecipeHost::set(uint32_t index, const Turn& turn, const std::vector<char>& constants,
                     const int32_t area[4]) const {
  const pld_recipe_pass& pass = *pld_recipe_pass_at(&recipe_, index);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);  // before lists are emptied, too
  glTextureBarrier();
  glNamedBufferData(constants_, std::max<GLsizeiptr>(pass.constants_size, 16), nullptr, GL_STREAM_DRAW);
  glNamedBufferSubData(constants_, 0, pass.constants_size, constants.data());
  attach(pass, turn);
  setBlending(pass);
  bind(pass, turn.repeat);
  glViewport(area[0], area[1], area[2], area[3]);
  glUseProgram(programs_[index]);
}

void RecipeHost::run(const pld_frame& frame, const std::function<void(pld_stage, GLuint program)>& draw) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame_);
  glBindVertexArray(vertexArray_);
  for (uint32_t i = 0; i < programs_.size(); ++i) {
    const pld_recipe_pass& pass = *pld_recipe_pass_at(&recipe_, i);
    uint32_t repeats = 0;
    ASSERT_EQ(pld_recipe_repeats(&recipe_, i, &frame, &repeats), PLD_OK);
    for (uint32_t repeat = 0; repeat < repeats; ++repeat) {
      std::vector<char> constants(pass.constants_size);
      int32_t area[4];
      ASSERT_EQ(pld_recipe_fill(&recipe_, i, repeat, &frame, host_.width, constants.data(), constants.size(), area),
                PLD_OK);
      set(i, {repeat}, constants, area);
      if (pass.kind == PLD_PASS_DRAWS)
        draw(pass.stage, programs_[i]);
      else
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
  }
  leave();
}

void RecipeHost::runFace(const pld_shadow_view& view, const std::function<void(GLuint program)>& draw) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame_);
  glBindVertexArray(vertexArray_);
  for (uint32_t i = 0; i < programs_.size(); ++i) {
    const pld_recipe_pass& pass = *pld_recipe_pass_at(&recipe_, i);
    std::vector<char> constants(pass.constants_size);
    int32_t area[4], layer = -1;
    ASSERT_EQ(pld_shadow_recipe_fill(&recipe_, i, &view, constants.data(), constants.size(), area, &layer), PLD_OK);
    set(i, {0, layer, view.depth_texture}, constants, area);
    if (pass.kind == PLD_PASS_DRAWS)
      draw(programs_[i]);
    else
      glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  leave();
}

void RecipeHost::leave() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glBindSamplers(0, 16, nullptr);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

GLuint RecipeHost::maps() const {
  for (uint32_t i = 0; i < images_.size(); ++i)
    if (pld_recipe_image_at(&recipe_, i)->role == PLD_ROLE_SHADOW_MAPS) return images_[i].texture;
  return 0;
}

std::vector<float> RecipeHost::output(pld_role role) const {
  for (uint32_t i = 0; i < images_.size(); ++i)
    if (pld_recipe_image_at(&recipe_, i)->role == role)
      return readTexture(images_[i].texture, host_.width, host_.height, GL_RGBA);
  return {};
}

}  // namespace pellucid::test
