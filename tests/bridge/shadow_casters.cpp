#include "tests/bridge/shadow_casters.h"

#include <gtest/gtest.h>

#include <cstring>

#include "engine_bridge/gl/frame_blocks.h"
#include "engine_bridge/gl/geometry_stream.h"
#include "engine_bridge/gl/permutation.h"
#include "engine_bridge/scene/placed.h"
#include "shaders/shader_source.h"

namespace pellucid::test {
namespace {

constexpr double kMargin = 16.0;  // texels as drawn; engine_bridge/gl/shadow_pass.cpp

std::vector<LightView> viewsOf(const Scene& scene, std::size_t light, int size, LightViews& all) {
  double farthest = 0.0;
  const Light& one = scene.lights[light];
  const Bounds casters = casterBounds(scene, Casters::transparent, lightFromWorld(one), farthest);
  all = lightViews(one, casters, farthest, casters, (one.kind == LightKind::directional ? 1.0 : 2.0) * kMargin / size);
  return all.faces;
}

glm::mat4 projectionOf(const LightView& view, int edge) {
  const Window window{0, 0, edge, edge};
  return glm::mat4(clipFromView(view.camera, window, window, {0.5, 0.5}));
}

// What a host's shader of casters would hold: its own material, then the seam.
const char* const kMain = R"(
layout(location = 4) flat in uint triangleNumber;
uniform uint instanceIdentity;
void main() {
  Surface surface = surfaceHere();
  if (outsideTriangle()) discard;
  vec3 toLight = orthographic != 0 ? vec3(0.0f, 0.0f, 1.0f) : normalize(-viewPosition);
  PldCaster caster;
  caster.normal = normalTowardsEye(viewNormal, gl_FrontFacing, toLight);
  float cosLight = clamp(abs(dot(caster.normal, toLight)), PLD_GRAZING, 1.0f);
  caster.coverage = surface.coverage;
  caster.transmission = transmissionAt(surface, cosLight);
  caster.position = viewPosition;
  caster.eta = material.scattering.z;
  caster.identity = pldCasterIdentity(instanceIdentity, triangleNumber);
  pldWriteCaster(caster);
}
)";

GLuint casterProgram(pld_pass* pass, const Material& material) {
  const char* seam = nullptr;
  EXPECT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_CASTER, 450, &seam), PLD_OK) << pld_message(pass);
  gl::FrameFeatures features;
  features.mask = MaskEdge::hard;
  std::vector<std::string> defines = gl::surfaceDefines(material, false, features, false, false);
  defines.emplace_back("EXACT_COVERAGE");
  std::string fragment = shaderSource("gl/material.glsl", defines);
  fragment.insert(fragment.find('\n') + 1, seam);
  std::string cut = shaderSource("gl/exact_cut.glsl", {});
  cut.erase(0, cut.find("#define PLD_FN") + std::strlen("#define PLD_FN\n"));
  return makeProgram(shaderSource("gl/transparent.vert", defines), fragment + cut + kMain);
}

}  // namespace

pld_shadow_info shadowInfo(pld_shadow_form form, int size, int lights, int faces, bool coloured) {
  pld_shadow_info info{};
  info.struct_size = sizeof(info);
  info.form = form;
  info.size = size;
  info.lights = lights;
  info.faces = faces;
  info.coloured = coloured;
  info.closer_edge = 4;
  info.uniform_binding = 5;
  info.texture_unit = 9;
  return info;
}

const char* const kPlainCaster = R"(
void main() {
  PldCaster caster;
  caster.coverage = 0.5;
  caster.transmission = vec3(0.25, 0.5, 0.75);
  caster.position = vec3(0.0, 0.0, -2.0);
  caster.normal = vec3(0.0, 0.0, 1.0);
  caster.eta = 1.0;
  caster.identity = pldCasterIdentity(7u, uint(gl_PrimitiveID));
  pldWriteCaster(caster);
}
)";

pld_shadow_view plainShadowView() {
  pld_shadow_view view{};
  view.struct_size = sizeof(view);
  view.kind = PLD_LIGHT_DIRECTIONAL;
  view.faces = 1;
  for (const int i : {0, 5, 10, 15}) view.light_from_scene[i] = view.projection[i] = 1.0f;
  view.near_depth = 1.0f;
  view.far_depth = 3.0f;
  return view;
}

std::vector<pld_shadow_view> sunAndLampViews() {
  std::vector<pld_shadow_view> all{plainShadowView()};
  constexpr int axes[6][3] = {{2, 1, 0}, {2, 1, 0}, {0, 2, 1}, {0, 2, 1}, {0, 1, 2}, {0, 1, 2}};
  for (int face = 0; face < 6; ++face) {
    pld_shadow_view view = plainShadowView();
    view.kind = PLD_LIGHT_LOCAL;
    view.light = 1;
    view.first_face = 1;
    view.faces = 6;
    view.face = face;
    std::memset(view.light_from_scene, 0, sizeof(view.light_from_scene));
    for (int row = 0; row < 3; ++row)
      view.light_from_scene[4 * axes[face][row] + row] = row == 2 && face % 2 == 0 ? -1.0f : 1.0f;
    view.light_from_scene[15] = 1.0f;
    view.projection[0] = view.projection[5] = 0.95f;
    view.projection[10] = view.projection[11] = -1.0f;
    view.projection[14] = -0.2f;
    view.projection[15] = 0.0f;
    view.far_depth = 5.0f;
    all.push_back(view);
  }
  return all;
}

std::vector<pld_shadow_view> shadowViews(const Scene& scene, const Camera& camera, std::size_t light, int firstFace,
                                         int size) {
  LightViews all;
  std::vector<pld_shadow_view> views;
  const std::vector<LightView> faces = viewsOf(scene, light, size, all);
  const int edge = faces.size() > 1 ? size / 2 : size;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    pld_shadow_view view{};
    view.struct_size = sizeof(view);
    view.kind = all.radial ? PLD_LIGHT_LOCAL : PLD_LIGHT_DIRECTIONAL;
    view.light = static_cast<int>(light);
    view.first_face = firstFace;
    view.faces = static_cast<int>(faces.size());
    view.face = static_cast<int>(i);
    const glm::mat4 from(faces[i].camera.viewFromWorld * glm::inverse(camera.viewFromWorld)),
        clip = projectionOf(faces[i], edge);
    std::memcpy(view.light_from_scene, &from[0][0], sizeof(from));
    std::memcpy(view.projection, &clip[0][0], sizeof(clip));
    const double offset = all.radial ? 0.0 : all.offset - all.scale * faces[i].back;
    view.near_depth = static_cast<float>((-1.0 - offset) / all.scale);
    view.far_depth = static_cast<float>((1.0 - offset) / all.scale);
    views.push_back(view);
  }
  return views;
}

void drawCasters(pld_pass* pass, const pld_shadow_view& view, const Scene& scene, std::size_t light, int size) {
  LightViews all;
  const LightView face = viewsOf(scene, light, size, all)[static_cast<std::size_t>(view.face)];
  const int edge = view.faces > 1 ? size / 2 : size;
  gl::GeometryStream stream(scene);
  gl::Buffer frameBuffer = gl::Buffer::make(), materialBuffer = gl::Buffer::make();
  gl::FrameBlock frame;
  frame.clipFromView = projectionOf(face, edge);
  frame.orthographic = face.camera.orthographic ? 1 : 0;
  frame.viewport = glm::vec2(edge, edge);
  glNamedBufferData(frameBuffer.name(), sizeof frame, &frame, GL_STATIC_DRAW);
  const std::vector<Placed> placed = placeInstances(scene, face.camera);
  ASSERT_EQ(pld_shadow_begin(pass, &view), PLD_OK) << pld_message(pass);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frameBuffer.name());
  glDisable(GL_CULL_FACE);
  stream.sweep({}, std::size_t{16} << 20, [&](const std::vector<gl::ChunkDraw>& draws) {
    for (const gl::ChunkDraw& one : draws) {
      const Instance& instance = scene.instances[one.instance];
      const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
      const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
      const MaterialBlock block = materialBlock(material);
      glNamedBufferData(materialBuffer.name(), sizeof block, &block, GL_STATIC_DRAW);
      glBindBufferBase(GL_UNIFORM_BUFFER, 1, materialBuffer.name());
      const GLuint program = casterProgram(pass, material);
      ASSERT_NE(program, 0u);
      glUseProgram(program);
      const glm::mat4 viewFromObject(placed[one.instance].viewFromObject);
      glUniformMatrix4fv(glGetUniformLocation(program, "viewFromOffset"), 1, GL_FALSE, &viewFromObject[0][0]);
      glUniform3f(glGetUniformLocation(program, "objectOrigin"), 0.0f, 0.0f, 0.0f);
      glUniformMatrix3fv(glGetUniformLocation(program, "normalFromObject"), 1, GL_FALSE,
                         &placed[one.instance].normalFromObject[0][0]);
      glUniform1f(glGetUniformLocation(program, "thicknessScale"), placed[one.instance].thicknessScale);
      glUniform1ui(glGetUniformLocation(program, "instanceIdentity"), instance.identity);
      glDrawArrays(GL_TRIANGLES, static_cast<GLint>(one.firstTriangle * 3), static_cast<GLsizei>(one.triangles * 3));
      glDeleteProgram(program);
    }
  });
  ASSERT_EQ(pld_shadow_end(pass), PLD_OK) << pld_message(pass);
  gl::checkGl("drawing casters through the C library");
}

std::vector<float> askShadows(pld_pass* pass, const pld_shadow_info& info, int light, const std::vector<float>& points,
                              bool onOpaque, int version) {
  const char* lookup = nullptr;
  EXPECT_EQ(pld_shadow_glsl(pass, PLD_SHADOW_TEXT_LOOKUP, version, &lookup), PLD_OK) << pld_message(pass);
  const int count = static_cast<int>(points.size() / 4);
  const GLuint places = makeTexture(GL_RGBA32F, count, 1), answers = makeTexture(GL_RGBA32F, count, 1);
  fillTexture(places, count, 1, GL_RGBA, points.data());
  const std::string main = std::string(
                               "uniform sampler2D points;\nuniform int light;\nout vec4 answer;\nvoid main() {\n"
                               "  vec3 point = texelFetch(points, ivec2(gl_FragCoord.xy), 0).xyz;\n  answer = vec4(") +
                           (onOpaque ? "pldShadowOnOpaque" : "pldShadow") + "(light, point), 1.0);\n}\n";
  const GLuint program =
      makeProgram(kFullscreenVertex, "#version " + std::to_string(version) + " core\n" + lookup + main);
  EXPECT_NE(program, 0u);
  EXPECT_EQ(pld_connect(pass, program), PLD_OK) << pld_message(pass);
  uint64_t texture = 0, buffer = 0;
  EXPECT_EQ(pld_query(pass, PLD_VALUE_SHADOW_TEXTURE, &texture), PLD_OK);
  EXPECT_EQ(pld_query(pass, PLD_VALUE_SHADOW_BUFFER, &buffer), PLD_OK);
  GLuint frame = 0, array = 0;
  glCreateFramebuffers(1, &frame);
  glNamedFramebufferTexture(frame, GL_COLOR_ATTACHMENT0, answers, 0);
  glCreateVertexArrays(1, &array);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
  glBindVertexArray(array);
  glViewport(0, 0, count, 1);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glUseProgram(program);
  glBindTextureUnit(info.texture_unit, static_cast<GLuint>(texture));
  glBindBufferBase(GL_UNIFORM_BUFFER, info.uniform_binding, static_cast<GLuint>(buffer));
  glBindTextureUnit(0, places);
  glUniform1i(glGetUniformLocation(program, "light"), light);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<float> found = readTexture(answers, count, 1, GL_RGBA);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glDeleteFramebuffers(1, &frame);
  glDeleteVertexArrays(1, &array);
  glDeleteProgram(program);
  const GLuint names[] = {places, answers};
  glDeleteTextures(2, names);
  return found;
}

std::vector<float> shadowTexels(pld_pass* pass, int edge, int layers) {
  uint64_t texture = 0;
  EXPECT_EQ(pld_query(pass, PLD_VALUE_SHADOW_TEXTURE, &texture), PLD_OK);
  std::vector<float> texels(std::size_t{4} * static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge) *
                            static_cast<std::size_t>(layers));
  glGetTextureImage(static_cast<GLuint>(texture), 0, GL_RGBA, GL_FLOAT,
                    static_cast<GLsizei>(texels.size() * sizeof(float)), texels.data());
  return texels;
}

}  // namespace pellucid::test
