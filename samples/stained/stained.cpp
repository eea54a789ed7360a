// Coloured shadows through the C library: the sun's map of what is transparent, asked by the light pass. Of Pellucid
// the host includes the public header alone.
//
//   stained OUTDIR [WIDTHxHEIGHT]
//
// Writes OUTDIR/glass.glb and OUTDIR/opaque.exr, what `pellucid composite --shadows exact` takes (the floor without
// shadows, the sun's part in layers of its own), OUTDIR/frame.exr, the same by the library, and OUTDIR/map.exr, what
// its map leaves of the sun.
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <OpenImageIO/imageio.h>
#include <pellucid/pellucid.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <stdexcept>

#include "samples/stained/screen.h"

namespace {

using namespace pellucid::stained;

constexpr float kNear = 0.5f, kFar = 30.0f;
constexpr int kMap = 2048, kKept = kMap / 4;

void check(pld_status status, pld_pass* pass) {
  if (status != PLD_OK) throw std::runtime_error(std::string(pld_status_name(status)) + ": " + pld_message(pass));
}

const char* const kVertex = R"(
layout(location = 0) in vec3 position;
uniform mat4 clipFromView, viewFromWorld;
out vec3 worldPosition, viewPosition;
void main() {
  worldPosition = position;
  viewPosition = vec3(viewFromWorld * vec4(position, 1.0));
  gl_Position = clipFromView * vec4(viewPosition, 1.0);
}
)";

// The light pass, here of one floor: with the sun as panes leave it, and, for the file, without them.
const char* const kFloor = R"(
in vec3 worldPosition, viewPosition;
uniform vec3 toSun, sun, around;
layout(location = 0) out vec4 lit;
layout(location = 1) out vec4 open;
layout(location = 2) out vec4 ofSun;  // and planar depth
void main() {
  ivec2 tile = ivec2(floor(worldPosition.xz * 2.5));
  vec3 albedo = ((tile.x + tile.y) & 1) == 0 ? vec3(0.80, 0.78, 0.74) : vec3(0.68, 0.66, 0.63);
  vec3 direct = albedo * sun * (toSun.y / 3.14159265), rest = albedo * around;
  lit = vec4(rest + direct * pldShadowOnOpaque(0, worldPosition), 1.0);
  open = vec4(rest + direct, 1.0);
  ofSun = vec4(direct, -viewPosition.z);
}
)";

// Thin glass, as its light sees it and as the eye does.
const char* const kFresnel = R"(
float fresnel(float c, float ior) {
  float inside = sqrt(1.0 - (1.0 - c * c) / (ior * ior));
  float p = (ior * c - inside) / (ior * c + inside), s = (c - ior * inside) / (c + ior * inside);
  return 0.5 * (p * p + s * s);
}
)";
const char* const kCaster = R"(
in vec3 viewPosition;
uniform vec3 normal, colour;  // in the light's view
uniform float ior;
uniform uint number;
void main() {
  PldCaster caster;
  caster.coverage = 1.0;
  caster.transmission = colour * (1.0 - fresnel(abs(normal.z), ior));
  caster.position = viewPosition;
  caster.normal = normal;
  caster.eta = 1.0;  // too thin to bend light
  caster.identity = pldCasterIdentity(number, uint(gl_PrimitiveID));
  pldWriteCaster(caster);
}
)";
const char* const kGlass = R"(
in vec3 viewPosition;
uniform vec3 normal, colour, around;
uniform float ior;
void main() {
  float f = fresnel(abs(dot(normal, normalize(-viewPosition))), ior);
  pldWriteFragment(pldSurface(f * around, 1.0, colour * (1.0 - f), viewPosition));
}
)";
GLuint program(const std::string& fragment) {
  const GLuint name = glCreateProgram();
  for (const auto& [kind, text] : {std::pair{GL_VERTEX_SHADER, std::string(kVertex)}, {GL_FRAGMENT_SHADER, fragment}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(kind));
    const std::string whole = "#version 330 core\n" + text;
    const char* source = whole.c_str();
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    char log[500] = {};
    glGetShaderInfoLog(shader, sizeof(log) - 1, nullptr, log);
    if (log[0]) std::fprintf(stderr, "%s\n", log);
    glAttachShader(name, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(name);
  GLint done = 0;
  glGetProgramiv(name, GL_LINK_STATUS, &done);
  if (!done) throw std::runtime_error("a program does not link");
  return name;
}

GLuint texture(GLenum format, int width, int height) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  glTextureStorage2D(name, 1, format, width, height);
  return name;
}

class Host {
 public:
  Host(int width, int height) : width_(width), height_(height), panes_(screen()) {
    viewFromWorld_ = glm::lookAt(view_.eye, view_.target, glm::vec3(0, 1, 0));
    clipFromView_ = glm::perspective(view_.yfov, static_cast<float>(width) / static_cast<float>(height), kNear, kFar);
    for (GLuint* one : {&lit_, &open_, &ofSun_, &frame_}) *one = texture(GL_RGBA32F, width, height);
    depth_ = texture(GL_DEPTH_COMPONENT32F, width, height);
    shown_ = texture(GL_RGBA32F, kKept, kKept);
    glCreateFramebuffers(1, &target_);
    const GLuint colours[] = {lit_, open_, ofSun_};
    GLenum buffers[3];
    for (GLuint i = 0; i < 3; ++i) {
      buffers[i] = GL_COLOR_ATTACHMENT0 + i;
      glNamedFramebufferTexture(target_, buffers[i], colours[i], 0);
    }
    glNamedFramebufferTexture(target_, GL_DEPTH_ATTACHMENT, depth_, 0);
    glNamedFramebufferDrawBuffers(target_, 3, buffers);
    glCreateBuffers(1, &corners_);
    glNamedBufferData(corners_, 4 * sizeof(glm::vec3), nullptr, GL_DYNAMIC_DRAW);
    glCreateVertexArrays(1, &array_);
    glVertexArrayVertexBuffer(array_, 0, corners_, 0, sizeof(glm::vec3));
    glEnableVertexArrayAttrib(array_, 0);
    glVertexArrayAttribFormat(array_, 0, 3, GL_FLOAT, GL_FALSE, 0);
    makePass();
  }
  ~Host() { pld_destroy(&pass_); }

  void draw() {
    drawShadows();
    drawFloor();
    drawLayers();
  }

  void write(const std::string& folder) const {
    writeGlb(panes_, view_, width_, height_, folder + "/glass.glb");
    const std::vector<float> floor = read(ofSun_, width_, height_);
    save(folder + "/opaque.exr", width_, height_, read(open_, width_, height_), floor, 8);
    save(folder + "/frame.exr", width_, height_, read(frame_, width_, height_), floor, 5);
    save(folder + "/map.exr", kKept, kKept, read(shown_, kKept, kKept), {}, 4);
  }

 private:
  void makePass() {
    pld_create_info info{};
    info.struct_size = sizeof(info);
    info.version = PLD_VERSION;
    info.get_proc_address = [](void*, const char* name) { return reinterpret_cast<pld_proc>(eglGetProcAddress(name)); };
    info.log = [](void*, pld_log_level, const char* text) { std::fprintf(stderr, "%s\n", text); };
    info.features = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT;
    info.flags = PLD_FLAG_DEBUG_VIEWS;
    info.uniform_binding = 1;
    info.texture_unit = 4;
    if (pld_create(&info, &pass_) != PLD_OK) throw std::runtime_error("no pass");
    check(pld_resize(pass_, width_, height_), pass_);
    // One sun, one face. Lookups read their own unit and binding.
    pld_shadow_info room{};
    room.struct_size = sizeof(room);
    room.form = PLD_SHADOW_VARIANCE;
    room.size = kMap;
    room.lights = room.faces = room.coloured = 1;
    room.closer_edge = 4;
    room.uniform_binding = 2;
    room.texture_unit = 7;
    check(pld_shadow_resize(pass_, &room), pass_);
    const char *caster = nullptr, *lookup = nullptr, *seam = nullptr;
    check(pld_shadow_glsl(pass_, PLD_SHADOW_TEXT_CASTER, 330, &caster), pass_);
    check(pld_shadow_glsl(pass_, PLD_SHADOW_TEXT_LOOKUP, 330, &lookup), pass_);
    check(pld_glsl(pass_, PLD_STAGE_LAYERS, 330, &seam), pass_);
    casters_ = program(std::string(caster) + kFresnel + kCaster);
    floor_ = program(std::string(lookup) + kFloor);
    glass_ = program(std::string(seam) + kFresnel + kGlass);
    for (const GLuint one : {casters_, floor_, glass_}) check(pld_connect(pass_, one), pass_);
    check(pld_query(pass_, PLD_VALUE_SHADOW_TEXTURE, &mapTexture_), pass_);
    check(pld_query(pass_, PLD_VALUE_SHADOW_BUFFER, &mapTable_), pass_);
  }

  static void set(GLuint name, const char* uniform, glm::vec3 value) {
    glUniform3fv(glGetUniformLocation(name, uniform), 1, &value.x);
  }

  void use(GLuint name, const glm::mat4& clipFromView, const glm::mat4& viewFromWorld) const {
    glUseProgram(name);
    glUniformMatrix4fv(glGetUniformLocation(name, "clipFromView"), 1, GL_FALSE, glm::value_ptr(clipFromView));
    glUniformMatrix4fv(glGetUniformLocation(name, "viewFromWorld"), 1, GL_FALSE, glm::value_ptr(viewFromWorld));
    glUniform1f(glGetUniformLocation(name, "ior"), kIor);
    set(name, "sun", kSun);
    set(name, "toSun", kToSun);
    set(name, "around", kAround);
    // Where pldShadowOnOpaque() looks.
    glBindTextureUnit(7, static_cast<GLuint>(mapTexture_));
    glBindBufferBase(GL_UNIFORM_BUFFER, 2, static_cast<GLuint>(mapTable_));
    glBindVertexArray(array_);
  }

  void quad(const glm::vec3* corners) const {
    const glm::vec3 strip[] = {corners[0], corners[1], corners[3], corners[2]};
    glNamedBufferSubData(corners_, 0, sizeof(strip), strip);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }

  void drawPanes(GLuint name, const glm::mat4& viewFromWorld) const {
    for (std::size_t i = 0; i < panes_.size(); ++i) {
      set(name, "normal", glm::mat3(viewFromWorld) * panes_[i].normal);
      set(name, "colour", panes_[i].colour);
      glUniform1ui(glGetUniformLocation(name, "number"), static_cast<GLuint>(i));
      quad(panes_[i].corners);
    }
  }

  // The map as the sun sees it. Points are in the world, so it would outlive a turn of the camera.
  void drawShadows() {
    constexpr glm::vec3 centre(0.0f, 0.85f, 0.0f);
    constexpr float reach = 1.6f, away = 4.0f;
    const glm::mat4 lightFromWorld = glm::lookAt(centre + away * kToSun, centre, glm::vec3(0, 1, 0)),
                    clipFromLight = glm::ortho(-reach, reach, -reach, reach, away - reach, away + reach);
    pld_shadow_view view{};
    view.struct_size = sizeof(view);
    view.kind = PLD_LIGHT_DIRECTIONAL;
    view.faces = 1;
    std::memcpy(view.light_from_scene, glm::value_ptr(lightFromWorld), sizeof(view.light_from_scene));
    std::memcpy(view.projection, glm::value_ptr(clipFromLight), sizeof(view.projection));
    view.near_depth = away - reach;
    view.far_depth = away + reach;
    check(pld_shadow_begin(pass_, &view), pass_);
    use(casters_, clipFromLight, lightFromWorld);
    drawPanes(casters_, lightFromWorld);
    check(pld_shadow_end(pass_), pass_);
    pld_target shown{};
    shown.struct_size = sizeof(shown);
    shown.name = shown_;
    shown.view = PLD_VIEW_SHADOW_TRANSMISSION;
    check(pld_resolve(pass_, &shown), pass_);
  }

  void drawFloor() const {
    const float sky[] = {kAround.x, kAround.y, kAround.z, 1.0f}, nowhere[] = {0.0f, 0.0f, 0.0f, 0.0f}, far = 1.0f;
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glViewport(0, 0, width_, height_);
    for (GLint i = 0; i < 2; ++i) glClearNamedFramebufferfv(target_, GL_COLOR, i, sky);
    glClearNamedFramebufferfv(target_, GL_COLOR, 2, nowhere);
    glClearNamedFramebufferfv(target_, GL_DEPTH, 0, &far);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    use(floor_, clipFromView_, viewFromWorld_);
    const glm::vec3 floor[] = {{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}};
    quad(floor);
    glDisable(GL_DEPTH_TEST);
  }

  void drawLayers() {
    pld_frame frame{};
    frame.struct_size = sizeof(frame);
    frame.colour_texture = lit_;
    frame.depth_texture = depth_;
    frame.width = width_;
    frame.height = height_;
    std::memcpy(frame.projection, glm::value_ptr(clipFromView_), sizeof(frame.projection));
    frame.metres_per_unit = frame.pre_exposure = 1.0f;
    frame.weight_near = 0.1f;
    frame.weight_far = 100.0f;
    check(pld_begin(pass_, PLD_STAGE_LAYERS, &frame), pass_);
    use(glass_, clipFromView_, viewFromWorld_);
    drawPanes(glass_, viewFromWorld_);
    check(pld_end(pass_), pass_);
    pld_target target{};
    target.struct_size = sizeof(target);
    target.name = frame_;
    check(pld_resolve(pass_, &target), pass_);
  }

  static std::vector<float> read(GLuint name, int width, int height) {
    std::vector<float> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    glGetTextureImage(name, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(texels.size() * 4), texels.data());
    return texels;
  }

  // Rows run up on the device. Of `floor`, colour is the sun's and alpha depth: 5 channels take that, 8 both.
  static void save(const std::string& path, int width, int height, const std::vector<float>& colour,
                   const std::vector<float>& floor, int channels) {
    std::vector<float> rows;
    for (int y = height - 1; y >= 0; --y)
      for (int x = 0; x < width; ++x) {
        const auto at =
            4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
        rows.insert(rows.end(), &colour[at], &colour[at] + 4);
        if (channels > 4) rows.push_back(floor[at + 3] > 0.0f ? floor[at + 3] : INFINITY);
        if (channels > 5) rows.insert(rows.end(), &floor[at], &floor[at] + 3);
      }
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"R", "G", "B", "A", "Z", "light.sun.R", "light.sun.G", "light.sun.B"};
    spec.channelnames.resize(static_cast<std::size_t>(channels));
    spec.alpha_channel = 3;
    const auto file = OIIO::ImageOutput::create(path);
    if (!file || !file->open(path, spec) || !file->write_image(OIIO::TypeDesc::FLOAT, rows.data()) || !file->close())
      throw std::runtime_error(path + ": could not be written");
  }

  int width_, height_;
  View view_;
  std::vector<Pane> panes_;
  glm::mat4 viewFromWorld_{1.0f}, clipFromView_{1.0f};
  GLuint lit_ = 0, open_ = 0, ofSun_ = 0, depth_ = 0, frame_ = 0, shown_ = 0, target_ = 0, corners_ = 0, array_ = 0;
  GLuint casters_ = 0, floor_ = 0, glass_ = 0;
  uint64_t mapTexture_ = 0, mapTable_ = 0;
  pld_pass* pass_ = nullptr;
};

void makeContext() {
  const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) throw std::runtime_error("no EGL");
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) throw std::runtime_error("no OpenGL 4.5");
}

}  // namespace

int main(int count, char** arguments) {
  int width = 640, height = 360;
  if (count < 2 || count > 3 ||
      (count > 2 && (std::sscanf(arguments[2], "%dx%d", &width, &height) != 2 || width < 1 || height < 1))) {
    std::fprintf(stderr, "stained OUTDIR [WIDTHxHEIGHT]\n");
    return 2;
  }
  try {
    makeContext();
    Host host(width, height);
    host.draw();
    host.write(arguments[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stained: %s\n", error.what());
    return 1;
  }
}
