// The smallest deferred engine that has transparency: G-buffer, light pass, Pellucid's pass, resolve. Of Pellucid it
// knows the public header alone. Headless by EGL, or in a window.
//
//   engine GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD[:TIER][,rims][,low][,shadows]] [window[:FRAMES]]
//   METHOD: phenomenological, weighted, front+tail; TIER: float, half, published, exact
//   rims: ambient occlusion at rims of leaves; low: smoke at half the resolution; shadows: of what is transparent
//
// Draws the glTF's transparent primitives over a room of its own, and writes OUTDIR/opaque.exr (colour and Z, what
// `pellucid composite` takes) and OUTDIR/frame.exr. `window` walks around them until it is closed; with FRAMES it
// stands still for so many, and OUTDIR/window.exr is what the window shows of the last.
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <GLFW/glfw3.h>  // after epoxy: it brings a GL of its own
#include <pellucid/pellucid.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "samples/engine/engine_scene.h"
#include "samples/engine/engine_shading.h"

namespace {

using namespace engine;

void check(pld_status status, pld_pass* pass) {
  if (status != PLD_OK) stop(std::string(pld_status_name(status)) + ": " + pld_message(pass));
}

const char* const kVersion = "#version 450 core\n";

GLuint bufferOf(const void* data, std::size_t size) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  glNamedBufferData(name, static_cast<GLsizeiptr>(size), data, GL_DYNAMIC_DRAW);
  return name;
}

// One vertex array of all meshes.
GLuint upload(const Scene& scene) {
  GLuint array = 0, offset = 0;
  glCreateVertexArrays(1, &array);
  glVertexArrayVertexBuffer(array, 0, bufferOf(scene.vertices.data(), scene.vertices.size() * sizeof(Vertex)), 0,
                            sizeof(Vertex));
  glVertexArrayElementBuffer(array, bufferOf(scene.indices.data(), scene.indices.size() * 4));
  for (GLuint i = 0; i < 4; ++i) {
    constexpr GLint components[] = {3, 3, 4, 2};  // of Vertex
    glEnableVertexArrayAttrib(array, i);
    glVertexArrayAttribFormat(array, i, components[i], GL_FLOAT, GL_FALSE, offset);
    glVertexArrayAttribBinding(array, i, 0);
    offset += static_cast<GLuint>(components[i]) * 4;
  }
  return array;
}

GLuint uploadTextures(const Scene& scene) {
  GLuint name = 0;
  auto edge = static_cast<GLsizei>(kTextureEdge);
  const auto layers = static_cast<GLsizei>(scene.textureLevels.back().size());
  if (layers == 0) return name;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
  glTextureStorage3D(name, kTextureLevels, GL_RGBA16F, edge, edge, layers);
  for (std::size_t level = 0; level < kTextureLevels; ++level, edge /= 2)
    glTextureSubImage3D(name, static_cast<GLint>(level), 0, 0, 0, edge, edge, layers, GL_RGBA, GL_HALF_FLOAT,
                        scene.textureLevels[level].data());
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return name;
}

GLuint program(const std::string& vertex, const std::string& fragment) {
  const GLuint name = glCreateProgram();
  for (const auto& [kind, text] :
       {std::pair{GL_VERTEX_SHADER, kVersion + vertex}, {GL_FRAGMENT_SHADER, kVersion + fragment}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(kind));
    const char* source = text.c_str();
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    char log[500] = {};
    glGetShaderInfoLog(shader, sizeof(log) - 1, nullptr, log);
    GLint done = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (!done) stop(log);
    glAttachShader(name, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(name);
  GLint done = 0;
  glGetProgramiv(name, GL_LINK_STATUS, &done);
  if (!done) stop("a program does not link");
  return name;
}

class Engine {
 public:
  Engine(const Scene& scene, int width, int height, const Asked& asked)
      : width_(width), height_(height), features_(asked.features) {
    meshes_ = upload(scene);
    textures_ = uploadTextures(scene);
    sceneNumbers_ = bufferOf(nullptr, sizeof(SceneNumbers));
    meshNumbers_ = bufferOf(nullptr, sizeof(MeshNumbers));
    albedo_ = texture(GL_RGBA16F);
    normal_ = texture(GL_RGBA32F);
    lit_ = texture(GL_RGBA32F);
    depth_ = texture(GL_DEPTH_COMPONENT32F);
    occlusion_ = texture(GL_R32F);
    frame_ = texture(GL_RGBA32F);
    glCreateFramebuffers(4, frames_);
    glNamedFramebufferTexture(frames_[0], GL_COLOR_ATTACHMENT0, albedo_, 0);
    glNamedFramebufferTexture(frames_[0], GL_COLOR_ATTACHMENT1, normal_, 0);
    glNamedFramebufferTexture(frames_[0], GL_DEPTH_ATTACHMENT, depth_, 0);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(frames_[0], 2, both);
    glNamedFramebufferTexture(frames_[1], GL_COLOR_ATTACHMENT0, lit_, 0);
    glNamedFramebufferTexture(frames_[2], GL_COLOR_ATTACHMENT0, frame_, 0);
    glNamedFramebufferTexture(frames_[3], GL_COLOR_ATTACHMENT0, occlusion_, 0);
    glCreateVertexArrays(1, &nothing_);
    opaque_ = program(kMeshVertex, kGBuffer);
    hiding_ = program(kFullScreen, kOcclusion);

    pld_create_info info{};
    info.struct_size = sizeof(info);
    info.version = PLD_VERSION;
    info.get_proc_address = [](void*, const char* name) { return reinterpret_cast<pld_proc>(eglGetProcAddress(name)); };
    info.log = [](void*, pld_log_level, const char* text) { std::fprintf(stderr, "%s\n", text); };
    info.method = asked.method, info.tier = asked.tier, info.features = asked.features;
    info.fragments_per_pixel = kFragmentsAPixel;
    info.flags = PLD_FLAG_TIMERS | PLD_FLAG_DEBUG_GROUPS;
    info.depth = PLD_DEPTH_REVERSED;
    info.clip = PLD_CLIP_ZERO_TO_ONE;
    info.uniform_binding = 1;
    info.texture_unit = 4;
    if (pld_create(&info, &pass_) != PLD_OK) stop("no pass");
    check(pld_resize(pass_, width, height), pass_);
    std::string lookups;
    if (asked.shadows) lookups = addShadows();
    light_ = program(kFullScreen, lookups + kLight);
    const bool front = asked.method == PLD_METHOD_FRONT_TAIL, rims = features_ & PLD_FEATURE_RIMS;
    if (front && asked.tier != PLD_TIER_EXACT) addStage(PLD_STAGE_FRONT, lookups);
    addStage(PLD_STAGE_LAYERS, lookups);
    if (rims && !front && asked.tier != PLD_TIER_PUBLISHED) addStage(PLD_STAGE_RIMS, lookups);
    if (features_ & PLD_FEATURE_LOW_RESOLUTION) addStage(PLD_STAGE_LOW, lookups);
  }
  ~Engine() { pld_destroy(&pass_); }

  void draw(const Scene& scene) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glBindBufferBase(GL_UNIFORM_BUFFER, kSceneBinding, sceneNumbers_);
    glBindBufferBase(GL_UNIFORM_BUFFER, kMeshBinding, meshNumbers_);
    glBindTextureUnit(kTexturesBinding, textures_);
    if (casters_) drawShadows(scene);
    const SceneNumbers numbers = sceneNumbers(scene, width_, height_, true);
    glNamedBufferSubData(sceneNumbers_, 0, sizeof(numbers), &numbers);
    for (const auto& [binding, texture] : {std::pair{kDepthBinding, depth_},
                                           {kNormalBinding, normal_},
                                           {kAlbedoBinding, albedo_},
                                           {kOcclusionBinding, occlusion_}})
      glBindTextureUnit(binding, texture);
    glViewport(0, 0, width_, height_);

    glBindFramebuffer(GL_FRAMEBUFFER, frames_[0]);
    const float black[4] = {}, nothing = 0.0f;
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    for (GLint i = 0; i < 2; ++i) glClearNamedFramebufferfv(frames_[0], GL_COLOR, i, black);
    glClearNamedFramebufferfv(frames_[0], GL_DEPTH, 0, &nothing);
    drawMeshes(scene, scene.viewFromWorld, opaque_, std::nullopt);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(nothing_);
    for (const auto& [frame, name] : {std::pair{frames_[3], hiding_}, {frames_[1], light_}}) {
      glBindFramebuffer(GL_FRAMEBUFFER, frame);
      glUseProgram(name);
      glDrawArrays(GL_TRIANGLES, 0, 3);
    }

    pld_frame frame = frameOf(scene, width_, height_);
    frame.colour_texture = lit_;
    frame.depth_texture = depth_;
    frame.occlusion_texture = occlusion_;
    for (const auto& [stage, name] : stages_) {
      check(pld_begin(pass_, stage, &frame), pass_);
      drawMeshes(scene, scene.viewFromWorld, name, stage);
      check(pld_end(pass_), pass_);
    }
    pld_target target{};
    target.struct_size = sizeof(target);
    target.kind = PLD_TARGET_TEXTURE;
    target.name = frame_;
    check(pld_resolve(pass_, &target), pass_);
  }

  // Into the window, as sRGB.
  void show() const {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glBlitNamedFramebuffer(frames_[2], 0, 0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                           GL_NEAREST);
    glDisable(GL_FRAMEBUFFER_SRGB);
  }

  GLuint lit() const { return lit_; }
  GLuint frame() const { return frame_; }
  // A texture or, 0, what the window shows, with Z.
  void write(const std::string& path, GLuint source) const {
    writePicture(path, width_, height_, read(source, GL_RGBA, 4), read(depth_, GL_DEPTH_COMPONENT, 1));
  }

  double milliseconds(pld_value what) {
    uint64_t ns = 0;
    glFinish();
    check(pld_query(pass_, what, &ns), pass_);
    return static_cast<double>(ns) * 1e-6;
  }

 private:
  GLuint texture(GLenum format) const {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    glTextureStorage2D(name, 1, format, width_, height_);
    return name;
  }
  std::vector<float> read(GLuint name, GLenum format, std::size_t channels) const {
    std::vector<float> texels(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * channels);
    if (name)
      glGetTextureImage(name, 0, format, GL_FLOAT, static_cast<GLsizei>(texels.size() * 4), texels.data());
    else
      glReadPixels(0, 0, width_, height_, format, GL_FLOAT, texels.data());
    return texels;
  }
  // Returns what goes before shaders that ask the sun's light.
  std::string addShadows() {
    const pld_shadow_info maps = shadowMaps();
    check(pld_shadow_resize(pass_, &maps), pass_);
    const char *caster = nullptr, *lookup = nullptr;
    check(pld_shadow_glsl(pass_, PLD_SHADOW_TEXT_CASTER, 450, &caster), pass_);
    casters_ = program(kMeshVertex, caster + kCaster);
    check(pld_shadow_glsl(pass_, PLD_SHADOW_TEXT_LOOKUP, 450, &lookup), pass_);
    return "#define SUN_IS_SHADOWED\n" + std::string(lookup);
  }
  void drawShadows(const Scene& scene) {
    const SunView sun = sunViewOf(scene);
    const SceneNumbers numbers = sceneNumbers(sun);
    glNamedBufferSubData(sceneNumbers_, 0, sizeof(numbers), &numbers);
    check(pld_shadow_begin(pass_, &sun.view), pass_);
    drawMeshes(scene, sun.lightFromWorld, casters_, PLD_STAGE_CASTERS);
    check(pld_shadow_end(pass_), pass_);
    uint64_t texture = 0, buffer = 0;
    check(pld_query(pass_, PLD_VALUE_SHADOW_TEXTURE, &texture), pass_);
    check(pld_query(pass_, PLD_VALUE_SHADOW_BUFFER, &buffer), pass_);
    glBindTextureUnit(kShadowMapsBinding, static_cast<GLuint>(texture));
    glBindBufferBase(GL_UNIFORM_BUFFER, kShadowTableBinding, static_cast<GLuint>(buffer));
  }
  void addStage(pld_stage stage, const std::string& lookups) {
    const char* seam = nullptr;
    check(pld_glsl(pass_, stage, 450, &seam), pass_);
    const std::string rims = features_ & PLD_FEATURE_RIMS ? "#define RIMS_OF_LEAVES\n" : "";
    stages_.emplace_back(stage, program(kMeshVertex, seam + rims + lookups + kGlass));
    check(pld_connect(pass_, stages_.back().second), pass_);
  }
  // Of a stage of Pellucid's pass, or of the G-buffer.
  void drawMeshes(const Scene& scene, const glm::mat4& viewFromWorld, GLuint name,
                  std::optional<pld_stage> stage) const {
    glUseProgram(name);
    glBindVertexArray(meshes_);
    for (const Mesh& mesh : scene.meshes) {
      if (stage ? !isDrawnIn(*stage, mesh.material, features_) : !mesh.material.opaque()) continue;
      const MeshNumbers numbers = meshNumbers(viewFromWorld, mesh);
      glNamedBufferSubData(meshNumbers_, 0, sizeof(numbers), &numbers);
      (mesh.material.bothSides ? glDisable : glEnable)(GL_CULL_FACE);
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.indexCount), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(std::uintptr_t{mesh.firstIndex} * 4));
    }
    glDisable(GL_CULL_FACE);
  }

  int width_, height_;
  uint32_t features_;
  GLuint albedo_ = 0, normal_ = 0, lit_ = 0, depth_ = 0, occlusion_ = 0, frame_ = 0, frames_[4] = {}, nothing_ = 0,
         opaque_ = 0, casters_ = 0, hiding_ = 0, light_ = 0, meshes_ = 0, textures_ = 0, sceneNumbers_ = 0,
         meshNumbers_ = 0;
  std::vector<std::pair<pld_stage, GLuint>> stages_;
  pld_pass* pass_ = nullptr;
};

void makeContext() {
  const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) stop("no EGL");
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) stop("no OpenGL 4.5");
}

GLFWwindow* makeWindow(int width, int height) {
  if (!glfwInit()) stop("no window system");
  for (const auto& [hint, value] : {std::pair{GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API},
                                    {GLFW_CONTEXT_VERSION_MAJOR, 4},
                                    {GLFW_CONTEXT_VERSION_MINOR, 5},
                                    {GLFW_RESIZABLE, 0},
                                    {GLFW_SRGB_CAPABLE, 1}})
    glfwWindowHint(hint, value);
  GLFWwindow* window = glfwCreateWindow(width, height, "Pellucid", nullptr, nullptr);
  if (!window) stop("no window with OpenGL 4.5");
  glfwMakeContextCurrent(window);
  return window;
}

}  // namespace

int main(int count, char** arguments) {
  const Arguments asked =
      argumentsOf(count, arguments,
                  "engine GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD[:TIER][,rims][,low][,shadows]] [window[:FRAMES]]");
  const std::string &folder = asked.folder, &shows = asked.last;
  int frames = 0;
  if (!shows.empty() && shows != "window" && (std::sscanf(shows.c_str(), "window:%d", &frames) != 1 || frames < 1))
    stop("expected window or window:FRAMES, found " + shows);
  try {
    GLFWwindow* const window = shows.empty() ? nullptr : makeWindow(asked.width, asked.height);
    if (!window) makeContext();
    Scene scene = readScene(asked.glass);
    Engine engine(scene, asked.width, asked.height, asked.asked);
    engine.draw(scene);
    engine.draw(scene);  // what a first frame compiles is no matter of its time
    engine.write(folder + "/opaque.exr", engine.lit());
    engine.write(folder + "/frame.exr", engine.frame());
    const glm::vec3 centre = 0.5f * (scene.least + scene.most);
    for (int i = 0; window && !glfwWindowShouldClose(window) && (frames == 0 || i < frames); ++i) {
      engine.draw(scene);
      engine.show();
      if (i + 1 == frames) engine.write(folder + "/window.exr", 0);
      glfwSwapBuffers(window);
      glfwPollEvents();
      if (frames > 0) continue;
      const glm::mat4 turned = glm::rotate(glm::translate(glm::mat4(1.0f), centre), 0.01f, glm::vec3(0, 1, 0));
      scene.viewFromWorld = scene.viewFromWorld * turned * glm::translate(glm::mat4(1.0f), -centre);
    }
    std::printf("begin %.2f ms, layers %.2f ms, resolve %.2f ms\n", engine.milliseconds(PLD_VALUE_NS_BEGIN),
                engine.milliseconds(PLD_VALUE_NS_DRAWS), engine.milliseconds(PLD_VALUE_NS_RESOLVE));
  } catch (const std::exception& error) {
    stop(error.what());
  }
}
