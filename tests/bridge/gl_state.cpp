#include "tests/bridge/gl_state.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

namespace pellucid::test {
namespace {

struct Named {
  const char* name;
  GLenum value;
  int count = 1;
};
#define PLD_STATE(name) \
  { #name, GL_##name }

constexpr Named kNumbers[] = {PLD_STATE(CURRENT_PROGRAM),
                              PLD_STATE(PROGRAM_PIPELINE_BINDING),
                              PLD_STATE(VERTEX_ARRAY_BINDING),
                              PLD_STATE(ARRAY_BUFFER_BINDING),
                              PLD_STATE(UNIFORM_BUFFER_BINDING),
                              PLD_STATE(SHADER_STORAGE_BUFFER_BINDING),
                              PLD_STATE(ATOMIC_COUNTER_BUFFER_BINDING),
                              PLD_STATE(PIXEL_PACK_BUFFER_BINDING),
                              PLD_STATE(PIXEL_UNPACK_BUFFER_BINDING),
                              PLD_STATE(COPY_READ_BUFFER_BINDING),
                              PLD_STATE(COPY_WRITE_BUFFER_BINDING),
                              PLD_STATE(DRAW_INDIRECT_BUFFER_BINDING),
                              PLD_STATE(TRANSFORM_FEEDBACK_BUFFER_BINDING),
                              PLD_STATE(DRAW_FRAMEBUFFER_BINDING),
                              PLD_STATE(READ_FRAMEBUFFER_BINDING),
                              PLD_STATE(RENDERBUFFER_BINDING),
                              PLD_STATE(ACTIVE_TEXTURE),
                              PLD_STATE(READ_BUFFER),
                              PLD_STATE(DEPTH_FUNC),
                              PLD_STATE(DEPTH_WRITEMASK),
                              PLD_STATE(DEPTH_CLEAR_VALUE),
                              PLD_STATE(STENCIL_FUNC),
                              PLD_STATE(STENCIL_REF),
                              PLD_STATE(STENCIL_VALUE_MASK),
                              PLD_STATE(STENCIL_WRITEMASK),
                              PLD_STATE(STENCIL_FAIL),
                              PLD_STATE(STENCIL_PASS_DEPTH_FAIL),
                              PLD_STATE(STENCIL_PASS_DEPTH_PASS),
                              PLD_STATE(STENCIL_BACK_FUNC),
                              PLD_STATE(STENCIL_BACK_WRITEMASK),
                              PLD_STATE(STENCIL_CLEAR_VALUE),
                              PLD_STATE(CULL_FACE_MODE),
                              PLD_STATE(FRONT_FACE),
                              PLD_STATE(POLYGON_MODE),
                              PLD_STATE(POLYGON_OFFSET_FACTOR),
                              PLD_STATE(POLYGON_OFFSET_UNITS),
                              PLD_STATE(LOGIC_OP_MODE),
                              PLD_STATE(LINE_WIDTH),
                              PLD_STATE(POINT_SIZE),
                              PLD_STATE(SAMPLE_COVERAGE_VALUE),
                              PLD_STATE(SAMPLE_COVERAGE_INVERT),
                              PLD_STATE(CLIP_ORIGIN),
                              PLD_STATE(CLIP_DEPTH_MODE),
                              PLD_STATE(PROVOKING_VERTEX),
                              PLD_STATE(PRIMITIVE_RESTART_INDEX),
                              PLD_STATE(PACK_ALIGNMENT),
                              PLD_STATE(PACK_ROW_LENGTH),
                              PLD_STATE(PACK_SKIP_ROWS),
                              PLD_STATE(PACK_SKIP_PIXELS),
                              PLD_STATE(UNPACK_ALIGNMENT),
                              PLD_STATE(UNPACK_ROW_LENGTH),
                              PLD_STATE(UNPACK_SKIP_ROWS),
                              PLD_STATE(UNPACK_SKIP_PIXELS),
                              PLD_STATE(DEBUG_GROUP_STACK_DEPTH),
                              PLD_STATE(MIN_SAMPLE_SHADING_VALUE),
                              PLD_STATE(CLAMP_READ_COLOR),
                              {"COLOR_CLEAR_VALUE", GL_COLOR_CLEAR_VALUE, 4},
                              {"BLEND_COLOR", GL_BLEND_COLOR, 4}};
constexpr Named kSwitches[] = {PLD_STATE(DEPTH_TEST),
                               PLD_STATE(STENCIL_TEST),
                               PLD_STATE(CULL_FACE),
                               PLD_STATE(COLOR_LOGIC_OP),
                               PLD_STATE(DITHER),
                               PLD_STATE(FRAMEBUFFER_SRGB),
                               PLD_STATE(MULTISAMPLE),
                               PLD_STATE(SAMPLE_ALPHA_TO_COVERAGE),
                               PLD_STATE(SAMPLE_ALPHA_TO_ONE),
                               PLD_STATE(SAMPLE_COVERAGE),
                               PLD_STATE(SAMPLE_MASK),
                               PLD_STATE(SAMPLE_SHADING),
                               PLD_STATE(RASTERIZER_DISCARD),
                               PLD_STATE(PRIMITIVE_RESTART),
                               PLD_STATE(PRIMITIVE_RESTART_FIXED_INDEX),
                               PLD_STATE(POLYGON_OFFSET_FILL),
                               PLD_STATE(DEPTH_CLAMP),
                               PLD_STATE(PROGRAM_POINT_SIZE),
                               PLD_STATE(TEXTURE_CUBE_MAP_SEAMLESS),
                               PLD_STATE(LINE_SMOOTH),
                               PLD_STATE(CLIP_DISTANCE0),
                               PLD_STATE(CLIP_DISTANCE1),
                               PLD_STATE(CLIP_DISTANCE2),
                               PLD_STATE(CLIP_DISTANCE3),
                               PLD_STATE(CLIP_DISTANCE4),
                               PLD_STATE(CLIP_DISTANCE5),
                               PLD_STATE(CLIP_DISTANCE6),
                               PLD_STATE(CLIP_DISTANCE7)};
constexpr Named kPerBuffer[] = {PLD_STATE(BLEND_SRC_RGB),      PLD_STATE(BLEND_DST_RGB),
                                PLD_STATE(BLEND_SRC_ALPHA),    PLD_STATE(BLEND_DST_ALPHA),
                                PLD_STATE(BLEND_EQUATION_RGB), PLD_STATE(BLEND_EQUATION_ALPHA)};
constexpr Named kPerUnit[] = {PLD_STATE(TEXTURE_BINDING_1D),
                              PLD_STATE(TEXTURE_BINDING_2D),
                              PLD_STATE(TEXTURE_BINDING_3D),
                              PLD_STATE(TEXTURE_BINDING_2D_ARRAY),
                              PLD_STATE(TEXTURE_BINDING_CUBE_MAP),
                              PLD_STATE(TEXTURE_BINDING_BUFFER),
                              PLD_STATE(TEXTURE_BINDING_2D_MULTISAMPLE),
                              PLD_STATE(SAMPLER_BINDING)};
#undef PLD_STATE
constexpr int kBuffers = 8, kUnits = 24, kBindings = 12, kViewports = 16;

double number(GLboolean value) {
  return value ? 1 : 0;
}

}  // namespace

GlState glState() {
  GlState state;
  const auto keep = [&](const std::string& name, GLenum what, int count) {
    GLdouble values[16] = {};
    glGetDoublev(what, values);
    state[name] = {values, values + count};
  };
  for (const Named& one : kNumbers) keep(one.name, one.value, one.count);
  for (const Named& one : kSwitches) state[one.name] = {number(glIsEnabled(one.value))};
  for (int i = 0; i < kBuffers; ++i) {
    const auto index = static_cast<GLuint>(i);
    state[fmt::format("BLEND[{}]", i)] = {number(glIsEnabledi(GL_BLEND, index))};
    GLboolean mask[4];
    glGetBooleani_v(GL_COLOR_WRITEMASK, index, mask);
    state[fmt::format("COLOR_WRITEMASK[{}]", i)] = {number(mask[0]), number(mask[1]), number(mask[2]), number(mask[3])};
    keep(fmt::format("DRAW_BUFFER[{}]", i), GL_DRAW_BUFFER0 + index, 1);
    for (const Named& one : kPerBuffer) {
      GLint value = 0;
      glGetIntegeri_v(one.value, index, &value);
      state[fmt::format("{}[{}]", one.name, i)] = {static_cast<double>(value)};
    }
  }
  for (int i = 0; i < kViewports; ++i) {
    const auto index = static_cast<GLuint>(i);
    GLdouble box[4], range[2];
    GLint scissor[4];
    glGetDoublei_v(GL_VIEWPORT, index, box);
    glGetDoublei_v(GL_DEPTH_RANGE, index, range);
    glGetIntegeri_v(GL_SCISSOR_BOX, index, scissor);
    state[fmt::format("VIEWPORT[{}]", i)] = {box, box + 4};
    state[fmt::format("DEPTH_RANGE[{}]", i)] = {range, range + 2};
    state[fmt::format("SCISSOR_BOX[{}]", i)] = {scissor, scissor + 4};
    state[fmt::format("SCISSOR_TEST[{}]", i)] = {number(glIsEnabledi(GL_SCISSOR_TEST, index))};
  }
  GLint active = 0;
  glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
  for (int i = 0; i < kUnits; ++i) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    for (const Named& one : kPerUnit) keep(fmt::format("{}[{}]", one.name, i), one.value, 1);
  }
  glActiveTexture(static_cast<GLenum>(active));
  for (int i = 0; i < kBindings; ++i) {
    const auto index = static_cast<GLuint>(i);
    GLint which = 0;
    GLint64 from = 0, bytes = 0;
    glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, index, &which);
    glGetInteger64i_v(GL_UNIFORM_BUFFER_START, index, &from);
    glGetInteger64i_v(GL_UNIFORM_BUFFER_SIZE, index, &bytes);
    state[fmt::format("UNIFORM_BUFFER[{}]", i)] = {static_cast<double>(which), static_cast<double>(from),
                                                   static_cast<double>(bytes)};
  }
  for (int i = 0; i < kBindings; ++i) {
    const auto index = static_cast<GLuint>(i);
    GLint which = 0;
    GLint64 from = 0, bytes = 0;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, index, &which);
    glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, index, &from);
    glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, index, &bytes);
    state[fmt::format("SHADER_STORAGE_BUFFER[{}]", i)] = {static_cast<double>(which), static_cast<double>(from),
                                                          static_cast<double>(bytes)};
    GLint counter = 0;
    if (i < 1) glGetIntegeri_v(GL_ATOMIC_COUNTER_BUFFER_BINDING, index, &counter);
    state[fmt::format("ATOMIC_COUNTER_BUFFER[{}]", i)] = {static_cast<double>(counter)};
    GLint image = 0;
    if (i < 8) glGetIntegeri_v(GL_IMAGE_BINDING_NAME, index, &image);
    state[fmt::format("IMAGE_BINDING_NAME[{}]", i)] = {static_cast<double>(image)};
  }
  return state;
}

std::vector<std::string> changes(const GlState& before, const GlState& after) {
  std::vector<std::string> found;
  for (const auto& [name, values] : before)
    if (values != after.at(name))
      found.push_back(fmt::format("{}: {} -> {}", name, fmt::join(values, " "), fmt::join(after.at(name), " ")));
  return found;
}

void setUnlikelyState() {
  GLuint textures[kUnits], samplers[kUnits], buffers[8], frames[2], array = 0, target = 0, render = 0;
  glCreateTextures(GL_TEXTURE_2D, kUnits, textures);
  glCreateSamplers(kUnits, samplers);
  glCreateBuffers(8, buffers);
  glCreateFramebuffers(2, frames);
  glCreateVertexArrays(1, &array);
  glCreateRenderbuffers(1, &render);
  glCreateTextures(GL_TEXTURE_2D, 1, &target);
  glTextureStorage2D(target, 1, GL_RGBA8, 32, 32);
  for (const GLuint frame : frames) glNamedFramebufferTexture(frame, GL_COLOR_ATTACHMENT3, target, 0);
  const GLenum order[] = {GL_NONE, GL_COLOR_ATTACHMENT3, GL_NONE, GL_COLOR_ATTACHMENT1};
  for (const GLuint frame : frames) glNamedFramebufferDrawBuffers(frame, 4, order);
  glNamedFramebufferReadBuffer(frames[1], GL_COLOR_ATTACHMENT3);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frames[0]);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frames[1]);
  glBindRenderbuffer(GL_RENDERBUFFER, render);
  glBindVertexArray(array);
  for (const GLuint buffer : buffers) glNamedBufferData(buffer, 4096, nullptr, GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  for (GLuint i = 0; i < kBindings; ++i) glBindBufferRange(GL_UNIFORM_BUFFER, i, buffers[1], 256 * (i % 4), 512);
  glBindBufferBase(GL_UNIFORM_BUFFER, 7, buffers[5]);
  for (GLuint i = 0; i < kBindings; ++i) {
    if (i % 3)
      glBindBufferRange(GL_SHADER_STORAGE_BUFFER, i, buffers[2], 256 * (i % 4), 512);
    else
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, i ? buffers[2] : 0);
  }
  glBindBuffer(GL_UNIFORM_BUFFER, buffers[3]);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[4]);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffers[6]);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers[7]);
  for (GLuint i = 0; i < kUnits; ++i) {
    glBindTextureUnit(i, textures[i]);
    glBindSampler(i, samplers[i]);
  }
  glActiveTexture(GL_TEXTURE0 + 5);
  for (GLuint i = 0; i < kViewports; ++i) {
    const auto edge = static_cast<GLfloat>(i);
    glViewportIndexedf(i, 1.5f + edge, 2.25f, 11.5f + edge, 13.75f);
    glScissorIndexed(i, static_cast<GLint>(i), 2, 3, 4);
    glDepthRangeIndexed(i, 0.125, 0.75);
  }
  glEnable(GL_SCISSOR_TEST);
  for (GLuint i = 0; i < kBuffers; ++i) {
    if (i % 3)
      glEnablei(GL_BLEND, i);
    else
      glDisablei(GL_BLEND, i);
    glColorMaski(i, i % 2, GL_TRUE, i % 3 == 0, GL_FALSE);
    glBlendFuncSeparatei(i, GL_DST_COLOR, GL_CONSTANT_ALPHA, GL_ONE_MINUS_DST_ALPHA, GL_ZERO);
    glBlendEquationSeparatei(i, GL_FUNC_REVERSE_SUBTRACT, GL_MAX);
  }
  glBlendColor(0.25f, 0.5f, 0.75f, 1.0f);
  glClearColor(0.5f, 0.25f, 0.125f, 1.0f);
  glClearDepth(0.25);
  glDepthFunc(GL_NOTEQUAL);
  glDepthMask(GL_TRUE);
  glStencilFunc(GL_GREATER, 3, 0x5a);
  glStencilOp(GL_INCR, GL_DECR, GL_INVERT);
  glStencilMask(0x3c);
  glCullFace(GL_FRONT_AND_BACK);
  glFrontFace(GL_CW);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glLogicOp(GL_XOR);
  glSampleCoverage(0.5f, GL_TRUE);
  glPolygonOffset(3.0f, 5.0f);
  glPrimitiveRestartIndex(77);
  for (const GLenum what : {GL_DEPTH_TEST, GL_STENCIL_TEST, GL_CULL_FACE, GL_COLOR_LOGIC_OP,
                            GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK, GL_RASTERIZER_DISCARD,
                            GL_FRAMEBUFFER_SRGB, GL_POLYGON_OFFSET_FILL, GL_PRIMITIVE_RESTART})
    glEnable(what);
  for (GLenum i = 0; i < 8; ++i) glEnable(GL_CLIP_DISTANCE0 + i);
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  for (const GLenum what : {GL_PACK_ALIGNMENT, GL_UNPACK_ALIGNMENT}) glPixelStorei(what, 2);
  for (const GLenum what : {GL_PACK_ROW_LENGTH, GL_UNPACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_UNPACK_SKIP_ROWS,
                            GL_PACK_SKIP_PIXELS, GL_UNPACK_SKIP_PIXELS})
    glPixelStorei(what, 3);
  glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 1, -1, "host");
}

}  // namespace pellucid::test
