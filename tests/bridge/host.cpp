#include "tests/bridge/host.h"

#include <epoxy/egl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace pellucid::test {

const char* const kFullscreenVertex =
    "#version 330 core\n"
    "void main() {\n"
    "  vec2 corner = vec2((gl_VertexID & 1) << 2, (gl_VertexID & 2) << 1) - vec2(1.0);\n"
    "  gl_Position = vec4(corner, 0.5, 1.0);\n"
    "}\n";

pld_proc procAddress(void*, const char* name) {
  return reinterpret_cast<pld_proc>(eglGetProcAddress(name));
}

void Log::add(void* user, pld_log_level, const char* text) {
  static_cast<Log*>(user)->lines.emplace_back(text);
}

GLuint makeTexture(GLenum format, int width, int height) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  glTextureStorage2D(name, 1, format, width, height);
  return name;
}

void fillTexture(GLuint name, int width, int height, GLenum format, const float* texels) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(name, 0, 0, 0, width, height, format, GL_FLOAT, texels);
}

std::vector<float> readTexture(GLuint name, int width, int height, GLenum format) {
  const std::size_t channels = format == GL_RGBA ? 4 : format == GL_RG ? 2 : 1;
  std::vector<float> texels(channels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureImage(name, 0, format, GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(float)), texels.data());
  return texels;
}

GLuint makeProgram(const std::string& vertex, const std::string& fragment) {
  const GLuint program = glCreateProgram();
  const auto attach = [&](GLenum kind, const std::string& text) {
    const char* source = text.c_str();
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    char log[1000] = {};
    GLint done = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    glGetShaderInfoLog(shader, sizeof(log) - 1, nullptr, log);
    if (!done) std::printf("%s\n", log);
    glAttachShader(program, shader);
    glDeleteShader(shader);
    return done != 0;
  };
  const bool compiled = attach(GL_VERTEX_SHADER, vertex) & attach(GL_FRAGMENT_SHADER, fragment);
  GLint linked = 0;
  if (compiled) {
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    char log[1000] = {};
    glGetProgramInfoLog(program, sizeof(log) - 1, nullptr, log);
    if (!linked) std::printf("%s\n", log);
  }
  if (linked) return program;
  glDeleteProgram(program);
  return 0;
}

Host::Host(int wide, int high)
    : width(wide),
      height(high),
      colour(makeTexture(GL_RGBA32F, wide, high)),
      depth(makeTexture(GL_R32F, wide, high)),
      output(makeTexture(GL_RGBA32F, wide, high)),
      occlusion(makeTexture(GL_R8, wide, high)) {
  const float grey[4] = {0.5f, 0.4f, 0.3f, 1.0f}, far = 10.0f, open = 0.5f;
  glClearTexImage(occlusion, 0, GL_RED, GL_FLOAT, &open);
  glClearTexImage(colour, 0, GL_RGBA, GL_FLOAT, grey);
  glClearTexImage(depth, 0, GL_RED, GL_FLOAT, &far);
}

Host::~Host() {
  const GLuint names[] = {colour, depth, output, occlusion};
  glDeleteTextures(4, names);
}

pld_create_info Host::info() const {
  pld_create_info info{};
  info.struct_size = sizeof(info);
  info.version = PLD_VERSION;
  info.get_proc_address = procAddress;
  info.log = Log::add;
  info.log_user = &log;
  info.depth = PLD_DEPTH_LINEAR;
  info.rows = PLD_ROWS_DOWN;
  info.uniform_binding = 3;
  info.texture_unit = 4;
  return info;
}

pld_frame Host::frame() const {
  pld_frame frame{};
  frame.struct_size = sizeof(frame);
  frame.colour_texture = colour;
  frame.depth_texture = depth;
  frame.occlusion_texture = occlusion;
  frame.low_factor = 2;
  frame.width = width;
  frame.height = height;
  frame.projection[0] = 2.0f * static_cast<float>(height) / static_cast<float>(width);
  frame.projection[5] = 2.0f;
  frame.projection[10] = -1.0f;
  frame.projection[11] = -1.0f;
  frame.projection[14] = -0.2f;
  frame.metres_per_unit = 1.0f;
  frame.pre_exposure = 1.0f;
  frame.weight_near = 0.1f;
  frame.weight_far = 100.0f;
  frame.weight_exponent = 3.0f;
  frame.refract = PLD_REFRACT_AT_DEPTH;
  frame.refract_distance = 2.0f;
  frame.diffusion_k0 = 0.3f;
  frame.diffusion_k1 = 0.5f;
  frame.depth_opacity = opacity;
  return frame;
}

pld_target Host::target() const {
  pld_target target{};
  target.struct_size = sizeof(target);
  target.kind = PLD_TARGET_TEXTURE;
  target.name = output;
  return target;
}

pld_pass* Host::create(const pld_create_info& info) {
  pld_pass* pass = nullptr;
  EXPECT_EQ(pld_create(&info, &pass), PLD_OK) << log.last();
  if (pass) {
    EXPECT_EQ(pld_resize(pass, width, height), PLD_OK) << pld_message(pass);
  }
  return pass;
}

void Host::upload(const GBuffer& gbuffer) {
  fillTexture(colour, width, height, GL_RGBA, &gbuffer.beauty.at(0, 0).x);
  fillTexture(depth, width, height, GL_RED, &gbuffer.viewZ.at(0, 0));
}

std::vector<float> Host::picture() const {
  return readTexture(output, width, height, GL_RGBA);
}

std::vector<float> Host::finish(pld_pass* pass) {
  const pld_target to = target();
  EXPECT_EQ(pld_resolve(pass, &to), PLD_OK) << pld_message(pass);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  EXPECT_EQ(pld_destroy(&pass), PLD_OK);
  return picture();
}

ToldMarks marksOf(std::uint32_t identity) {
  return {{static_cast<float>(identity % 97u) - 40.0f, 0.25f * static_cast<float>(identity % 13u)}, 7u * identity + 1u};
}

void replay(pld_pass* pass, const FragmentLists& lists, const pld_frame& frame, const std::vector<pld_stage>& stages) {
  static const std::string kMain = R"(
struct FragmentRecord {
  vec3 radiance; float coverage; vec3 transmission; float z; vec2 offset; float variance; uint identity;
};
layout(std430, binding = 3) readonly buffer Fragments { FragmentRecord fragments[]; };
layout(std430, binding = 4) readonly buffer Offsets { uint offsets[]; };
layout(std430, binding = 5) readonly buffer Dispersions { vec4 dispersions[]; };
uniform uint turn;
uniform int wide;
uniform bool disperses;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uint place = offsets[at.y * wide + at.x] + turn;
  if (place >= offsets[at.y * wide + at.x + 1]) discard;
  FragmentRecord one = fragments[place];
  vec4 dispersion = disperses ? dispersions[place] : vec4(0.0);
#ifdef PLD_MARKS
  pldMark(vec2(float(one.identity % 97u) - 40.0, 0.25 * float(one.identity % 13u)), 7u * one.identity + 1u);
#endif
  pldWriteLayer(one.radiance, one.coverage, one.transmission, one.z, one.offset, one.variance, dispersion);
}
)";
  std::vector<std::uint32_t> offsets(lists.offsets.begin(), lists.offsets.end());
  std::uint32_t deepest = 0;
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) deepest = std::max(deepest, offsets[i + 1] - offsets[i]);
  GLuint buffers[3], vertexArray = 0;
  glCreateBuffers(3, buffers);
  glCreateVertexArrays(1, &vertexArray);
  const std::vector<glm::vec4> none(1);
  const std::vector<glm::vec4>& dispersion = lists.disperses() ? lists.dispersion : none;
  glNamedBufferData(buffers[0], static_cast<GLsizeiptr>(lists.fragments.size() * sizeof(Fragment)),
                    lists.fragments.data(), GL_STATIC_DRAW);
  glNamedBufferData(buffers[1], static_cast<GLsizeiptr>(offsets.size() * 4), offsets.data(), GL_STATIC_DRAW);
  glNamedBufferData(buffers[2], static_cast<GLsizeiptr>(dispersion.size() * 16), dispersion.data(), GL_STATIC_DRAW);
  for (GLuint i = 0; i < 3; ++i) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3 + i, buffers[i]);
  for (const pld_stage stage : stages) {
    const char* seam = nullptr;
    ASSERT_EQ(pld_glsl(pass, stage, 450, &seam), PLD_OK) << pld_message(pass);
    const GLuint program = makeProgram(kFullscreenVertex, std::string("#version 450 core\n") + seam + kMain);
    ASSERT_NE(program, 0u);
    ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
    glUseProgram(program);
    glBindVertexArray(vertexArray);
    glUniform1i(glGetUniformLocation(program, "wide"), lists.window.width());
    glUniform1i(glGetUniformLocation(program, "disperses"), lists.disperses());
    for (std::uint32_t turn = 0; turn < deepest; ++turn) {
      glUniform1ui(glGetUniformLocation(program, "turn"), turn);
      glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    ASSERT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
    glDeleteProgram(program);
  }
  glDeleteVertexArrays(1, &vertexArray);
  glDeleteBuffers(3, buffers);
}

void drawOverAll(pld_pass* pass, pld_stage stage, const pld_frame& frame, const std::string& main) {
  GLuint array = 0;
  const char* seam = nullptr;
  glCreateVertexArrays(1, &array);
  ASSERT_EQ(pld_glsl(pass, stage, 330, &seam), PLD_OK) << pld_message(pass);
  const GLuint program = makeProgram(kFullscreenVertex, std::string("#version 330 core\n") + seam + main);
  ASSERT_NE(program, 0u);
  ASSERT_EQ(pld_connect(pass, program), PLD_OK);
  ASSERT_EQ(pld_begin(pass, stage, &frame), PLD_OK) << pld_message(pass);
  glUseProgram(program);
  glBindVertexArray(array);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  ASSERT_EQ(pld_end(pass), PLD_OK) << pld_message(pass);
  glDeleteProgram(program);
  glDeleteVertexArrays(1, &array);
}

std::vector<float> seen(const Host& host, pld_pass* pass, pld_view view) {
  pld_target target = host.target();
  target.view = view;
  EXPECT_EQ(pld_resolve(pass, &target), PLD_OK) << pld_message(pass);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  return host.picture();
}

}  // namespace pellucid::test
