// The smallest deferred engine that has transparency: G-buffer, light pass, Pellucid's pass, resolve. Of Pellucid it
// knows the public header alone. Headless by EGL, or in a window.
//
//   engine GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD[:TIER]] [window[:FRAMES]]
//   METHOD: phenomenological, weighted, front+tail; TIER: float, half, published, exact
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
#include <glm/gtc/type_ptr.hpp>
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

struct DrawnMesh {
  GLuint array = 0;
  GLsizei count = 0;
  glm::mat4 worldFromObject{1.0f};
  Material material;
};

DrawnMesh upload(const Mesh& mesh) {
  DrawnMesh drawn;
  GLuint buffers[2];
  glCreateBuffers(2, buffers);
  glNamedBufferData(buffers[0], static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(Vertex)), mesh.vertices.data(),
                    GL_STATIC_DRAW);
  glNamedBufferData(buffers[1], static_cast<GLsizeiptr>(mesh.indices.size() * 4), mesh.indices.data(), GL_STATIC_DRAW);
  glCreateVertexArrays(1, &drawn.array);
  glVertexArrayVertexBuffer(drawn.array, 0, buffers[0], 0, sizeof(Vertex));
  glVertexArrayElementBuffer(drawn.array, buffers[1]);
  for (GLuint i = 0; i < 2; ++i) {
    glEnableVertexArrayAttrib(drawn.array, i);
    glVertexArrayAttribFormat(drawn.array, i, 3, GL_FLOAT, GL_FALSE, i * 12);
    glVertexArrayAttribBinding(drawn.array, i, 0);
  }
  drawn.count = static_cast<GLsizei>(mesh.indices.size());
  drawn.worldFromObject = mesh.worldFromObject;
  drawn.material = mesh.material;
  return drawn;
}

const char* const kVersion = "#version 450 core\n";

const std::string kMeshVertex = std::string(R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 viewFromObject, clipFromView;
uniform mat3 normalFromObject;
out vec3 viewPosition, viewNormal;
)") + kMeshBody;

const std::string kGBuffer = std::string(R"(
in vec3 viewPosition, viewNormal;
uniform vec4 base;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;
)") + kGBufferBody;

const char* const kFullscreen =
    "void main() { gl_Position = vec4(vec2((gl_VertexID & 1) << 2, (gl_VertexID & 2) << 1) - vec2(1.0), 0.5, 1.0); }";

const std::string kLight = std::string(R"(
layout(binding = 0) uniform sampler2D albedo;
layout(binding = 1) uniform sampler2D normal;
layout(binding = 2) uniform sampler2D depth;
uniform vec3 toSun, sun, ambient;
out vec4 lit;
)") + kLightBody;

const std::string kGlass = std::string(R"(
in vec3 viewPosition, viewNormal;
uniform vec4 base, surfaceValues;
uniform ivec2 kinds;
uniform vec3 toSun, sun, ambient;
)") + kGlassBody;

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
  Engine(const Scene& scene, int width, int height, const Asked& asked) : width_(width), height_(height) {
    for (const Mesh& mesh : scene.meshes) meshes_.push_back(upload(mesh));
    albedo_ = texture(GL_RGBA16F);
    normal_ = texture(GL_RGBA32F);
    lit_ = texture(GL_RGBA32F);
    depth_ = texture(GL_DEPTH_COMPONENT32F);
    frame_ = texture(GL_RGBA32F);
    glCreateFramebuffers(3, frames_);
    glNamedFramebufferTexture(frames_[0], GL_COLOR_ATTACHMENT0, albedo_, 0);
    glNamedFramebufferTexture(frames_[0], GL_COLOR_ATTACHMENT1, normal_, 0);
    glNamedFramebufferTexture(frames_[0], GL_DEPTH_ATTACHMENT, depth_, 0);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(frames_[0], 2, both);
    glNamedFramebufferTexture(frames_[1], GL_COLOR_ATTACHMENT0, lit_, 0);
    glNamedFramebufferTexture(frames_[2], GL_COLOR_ATTACHMENT0, frame_, 0);
    glCreateVertexArrays(1, &nothing_);
    opaque_ = program(kMeshVertex, kGBuffer);
    light_ = program(kFullscreen, kLight);

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
    if (asked.method == PLD_METHOD_FRONT_TAIL && asked.tier != PLD_TIER_EXACT) addStage(PLD_STAGE_FRONT);
    addStage(PLD_STAGE_LAYERS);
  }
  ~Engine() { pld_destroy(&pass_); }

  void draw(const Scene& scene) {
    clipFromView_ = clipFromView(scene, width_, height_);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glViewport(0, 0, width_, height_);

    glBindFramebuffer(GL_FRAMEBUFFER, frames_[0]);
    const float black[4] = {}, nothing = 0.0f;
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    for (GLint i = 0; i < 2; ++i) glClearNamedFramebufferfv(frames_[0], GL_COLOR, i, black);
    glClearNamedFramebufferfv(frames_[0], GL_DEPTH, 0, &nothing);
    drawMeshes(scene, opaque_, false);
    glDisable(GL_DEPTH_TEST);

    glBindFramebuffer(GL_FRAMEBUFFER, frames_[1]);
    glUseProgram(light_);
    setLights(scene, light_);
    glBindTextureUnit(0, albedo_);
    glBindTextureUnit(1, normal_);
    glBindTextureUnit(2, depth_);
    glBindVertexArray(nothing_);
    glDrawArrays(GL_TRIANGLES, 0, 3);

    pld_frame frame = frameOf(scene, width_, height_);
    frame.colour_texture = lit_;
    frame.depth_texture = depth_;
    for (const auto& [stage, material] : stages_) {
      check(pld_begin(pass_, stage, &frame), pass_);
      drawMeshes(scene, material, true);
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
  void addStage(pld_stage stage) {
    const char* seam = nullptr;
    check(pld_glsl(pass_, stage, 450, &seam), pass_);
    stages_.emplace_back(stage, program(kMeshVertex, seam + std::string(kGlass)));
    check(pld_connect(pass_, stages_.back().second), pass_);
  }
  void setLights(const Scene& scene, GLuint name) const {
    const glm::vec3 toSun = glm::normalize(glm::mat3(scene.viewFromWorld) * scene.toSun);
    glUniform3fv(glGetUniformLocation(name, "toSun"), 1, &toSun.x);
    glUniform3fv(glGetUniformLocation(name, "sun"), 1, &scene.sun.x);
    glUniform3fv(glGetUniformLocation(name, "ambient"), 1, &kAmbient.x);
  }
  void drawMeshes(const Scene& scene, GLuint name, bool transparent) const {
    glUseProgram(name);
    setLights(scene, name);
    glUniformMatrix4fv(glGetUniformLocation(name, "clipFromView"), 1, GL_FALSE, glm::value_ptr(clipFromView_));
    for (const DrawnMesh& mesh : meshes_) {
      const Material& material = mesh.material;
      if (material.transparent() != transparent) continue;
      const glm::mat4 viewFromObject = scene.viewFromWorld * mesh.worldFromObject;
      const glm::mat3 normals = glm::transpose(glm::inverse(glm::mat3(viewFromObject)));
      glUniformMatrix4fv(glGetUniformLocation(name, "viewFromObject"), 1, GL_FALSE, glm::value_ptr(viewFromObject));
      glUniformMatrix3fv(glGetUniformLocation(name, "normalFromObject"), 1, GL_FALSE, glm::value_ptr(normals));
      glUniform4fv(glGetUniformLocation(name, "base"), 1, &material.base.x);
      if (transparent) {
        glUniform4f(glGetUniformLocation(name, "surfaceValues"), material.roughness, material.transmission,
                    material.ior, material.thickness);
        glUniform2i(glGetUniformLocation(name, "kinds"), material.unlit, material.thickness > 0.0f);
      }
      (material.bothSides ? glDisable : glEnable)(GL_CULL_FACE);
      glBindVertexArray(mesh.array);
      glDrawElements(GL_TRIANGLES, mesh.count, GL_UNSIGNED_INT, nullptr);
    }
    glDisable(GL_CULL_FACE);
  }

  int width_, height_;
  GLuint albedo_ = 0, normal_ = 0, lit_ = 0, depth_ = 0, frame_ = 0, frames_[3] = {}, nothing_ = 0, opaque_ = 0,
         light_ = 0;
  std::vector<DrawnMesh> meshes_;
  std::vector<std::pair<pld_stage, GLuint>> stages_;
  glm::mat4 clipFromView_{1.0f};
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
  if (count < 3 || count > 6) stop("engine GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD[:TIER]] [window[:FRAMES]]");
  int width = 640, height = 360;
  if (count > 3 && (std::sscanf(arguments[3], "%dx%d", &width, &height) != 2 || width < 1 || height < 1))
    stop("expected WIDTHxHEIGHT");
  const Asked asked = askedFor(count > 4 ? arguments[4] : "phenomenological");
  const std::string folder = arguments[2];
  const std::string shows = count > 5 ? arguments[5] : "";
  int frames = 0;
  if (!shows.empty() && shows != "window" && (std::sscanf(shows.c_str(), "window:%d", &frames) != 1 || frames < 1))
    stop("expected window or window:FRAMES, found " + shows);
  try {
    GLFWwindow* const window = shows.empty() ? nullptr : makeWindow(width, height);
    if (!window) makeContext();
    Scene scene = readScene(arguments[1]);
    Engine engine(scene, width, height, asked);
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
