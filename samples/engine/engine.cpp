// The smallest deferred engine that has transparency: G-buffer, light pass, Pellucid's pass, resolve. Of Pellucid it
// knows the public header alone. Headless by EGL, or in a window.
//
//   engine GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD] [window[:FRAMES]]  METHOD: phenomenological, weighted, front+tail
//
// Draws the glTF's transparent primitives over a room of its own, and writes OUTDIR/opaque.exr (colour and Z, what
// `pellucid composite` takes) and OUTDIR/frame.exr. `window` walks around them until it is closed; with FRAMES it
// stands still for so many, and OUTDIR/window.exr is what the window shows of the last.
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <GLFW/glfw3.h>  // after epoxy: it brings a GL of its own
#include <OpenImageIO/imageio.h>
#include <pellucid/pellucid.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

using nlohmann::json;

constexpr float kNear = 0.01f;
constexpr glm::vec3 kAmbient{0.35f, 0.38f, 0.42f};

[[noreturn]] void stop(const std::string& why) {
  std::fprintf(stderr, "engine: %s\n", why.c_str());
  std::exit(1);
}

void check(pld_status status, pld_pass* pass) {
  if (status != PLD_OK) stop(std::string(pld_status_name(status)) + ": " + pld_message(pass));
}

struct Vertex {
  glm::vec3 position, normal;
};

struct Material {
  glm::vec4 base{1.0f};
  float roughness = 1.0f, transmission = 0.0f, ior = 1.5f, thickness = 0.0f;
  bool unlit = false, blend = false, bothSides = false;
  bool transparent() const { return blend || transmission > 0.0f; }
};

struct Mesh {
  GLuint array = 0;
  GLsizei count = 0;
  glm::mat4 worldFromObject{1.0f};
  Material material;
};

struct Scene {
  std::vector<Mesh> meshes;
  glm::mat4 viewFromWorld{1.0f};
  float yfov = 0.8f;
  glm::vec3 toSun{0.0f, 1.0f, 0.0f}, sun{0.0f};  // world; W/m^2
  glm::vec3 least{1e30f}, most{-1e30f};          // of what is transparent, world
};

Mesh upload(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices) {
  Mesh mesh;
  GLuint buffers[2];
  glCreateBuffers(2, buffers);
  glNamedBufferData(buffers[0], static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
                    GL_STATIC_DRAW);
  glNamedBufferData(buffers[1], static_cast<GLsizeiptr>(indices.size() * 4), indices.data(), GL_STATIC_DRAW);
  glCreateVertexArrays(1, &mesh.array);
  glVertexArrayVertexBuffer(mesh.array, 0, buffers[0], 0, sizeof(Vertex));
  glVertexArrayElementBuffer(mesh.array, buffers[1]);
  for (GLuint i = 0; i < 2; ++i) {
    glEnableVertexArrayAttrib(mesh.array, i);
    glVertexArrayAttribFormat(mesh.array, i, 3, GL_FLOAT, GL_FALSE, i * 12);
    glVertexArrayAttribBinding(mesh.array, i, 0);
  }
  mesh.count = static_cast<GLsizei>(indices.size());
  return mesh;
}

void addBox(Scene& scene, glm::vec3 centre, glm::vec3 half, glm::vec3 colour) {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  for (int face = 0; face < 6; ++face) {
    glm::vec3 normal(0.0f), u(0.0f), v(0.0f);
    normal[face / 2] = face % 2 ? 1.0f : -1.0f;
    u[(face / 2 + 1) % 3] = 1.0f;
    v = glm::cross(normal, u);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const auto& corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)})
      vertices.push_back({centre + half * (normal + corner.x * u + corner.y * v), normal});
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + i);
  }
  Mesh mesh = upload(vertices, indices);
  mesh.material.base = glm::vec4(colour, 1.0f);
  scene.meshes.push_back(mesh);
}

// A floor, a wall and blocks around what is transparent: something to be seen through it.
void addRoom(Scene& scene) {
  const glm::vec3 centre = 0.5f * (scene.least + scene.most), size = scene.most - scene.least;
  const float r = std::max(size.x, std::max(size.y, size.z));
  const glm::vec3 eye = glm::vec3(glm::inverse(scene.viewFromWorld)[3]);
  const glm::vec3 away = glm::normalize((centre - eye) * glm::vec3(1, 0, 1));
  const glm::vec3 side = glm::normalize(glm::cross(away, glm::vec3(0, 1, 0)));
  const float floor = scene.least.y - 1e-3f * r;
  const auto block = [&](float across, float behind, float half, float high, glm::vec3 colour) {
    addBox(scene, glm::vec3(centre.x, floor + high, centre.z) + side * across * r + away * behind * r,
           glm::vec3(half * r, high, half * r), colour);
  };
  addBox(scene, {centre.x, floor - 0.05f * r, centre.z}, {6 * r, 0.05f * r, 6 * r}, {0.6f, 0.55f, 0.45f});
  for (int i = -4; i <= 4; ++i)
    block(0.35f * static_cast<float>(i), 1.6f, 0.1f, (i % 2 ? 0.5f : 0.9f) * size.y,
          {0.15f + 0.08f * static_cast<float>(i + 4), 0.3f, 0.8f - 0.08f * static_cast<float>(i + 4)});
  block(-0.3f, 0.7f, 0.07f, 0.25f * size.y, {0.8f, 0.65f, 0.1f});
  block(0.15f, -0.75f, 0.02f, 0.2f * size.y, {0.75f, 0.1f, 0.1f});  // stands in front
}

struct Gltf {
  json root;
  std::vector<char> bytes;

  const char* at(const json& accessor) const {
    const json& view = root.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    return bytes.data() + view.value("byteOffset", std::size_t{0}) + accessor.value("byteOffset", std::size_t{0});
  }
  std::vector<glm::vec3> vectors(const json& accessor) const {
    if (accessor.at("componentType") != 5126 || accessor.at("type") != "VEC3")
      stop("positions and normals are float here");
    std::vector<glm::vec3> values(accessor.at("count").get<std::size_t>());
    std::memcpy(values.data(), at(accessor), values.size() * sizeof(glm::vec3));
    return values;
  }
  std::vector<std::uint32_t> indices(const json& accessor) const {
    std::vector<std::uint32_t> values(accessor.at("count").get<std::size_t>());
    const int kind = accessor.at("componentType");
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (kind == 5125) std::memcpy(&values[i], at(accessor) + 4 * i, 4);
      std::uint16_t two = 0;
      if (kind == 5123) std::memcpy(&two, at(accessor) + 2 * i, 2), values[i] = two;
      if (kind == 5121) values[i] = static_cast<unsigned char>(at(accessor)[i]);
    }
    return values;
  }
};

Gltf read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> all((std::istreambuf_iterator<char>(file)), {});
  std::uint32_t header[5] = {};
  if (all.size() >= 28) std::memcpy(header, all.data(), sizeof header);
  if (header[0] != 0x46546c67 || all.size() < 28 + std::size_t{header[3]}) stop(path + ": no GLB");
  Gltf gltf;
  gltf.root = json::parse(all.data() + 20, all.data() + 20 + header[3]);
  gltf.bytes.assign(all.begin() + 28 + header[3], all.end());
  return gltf;
}

glm::mat4 transformOf(const json& node) {
  if (node.contains("matrix")) return glm::make_mat4(node["matrix"].get<std::vector<float>>().data());
  const auto t = node.value("translation", std::vector<float>{0, 0, 0}),
             s = node.value("scale", std::vector<float>{1, 1, 1}),
             q = node.value("rotation", std::vector<float>{0, 0, 0, 1});
  return glm::translate(glm::mat4(1.0f), glm::vec3(t[0], t[1], t[2])) *
         glm::mat4_cast(glm::quat(q[3], q[0], q[1], q[2])) * glm::scale(glm::mat4(1.0f), glm::vec3(s[0], s[1], s[2]));
}

Material materialOf(const json& source) {
  Material material;
  const json none = json::object(), pbr = source.value("pbrMetallicRoughness", none),
             more = source.value("extensions", none);
  const auto base = pbr.value("baseColorFactor", std::vector<float>{1, 1, 1, 1});
  material.base = glm::vec4(base[0], base[1], base[2], base[3]);
  material.roughness = pbr.value("roughnessFactor", 1.0f);
  material.blend = source.value("alphaMode", "OPAQUE") == "BLEND";
  material.unlit = more.contains("KHR_materials_unlit");
  material.transmission = more.value("KHR_materials_transmission", none).value("transmissionFactor", 0.0f);
  material.ior = more.value("KHR_materials_ior", none).value("ior", 1.5f);
  material.thickness = more.value("KHR_materials_volume", none).value("thicknessFactor", 0.0f);
  // Light meets a volume's boundary twice, whatever doubleSided says.
  material.bothSides = material.thickness > 0.0f || source.value("doubleSided", false);
  return material;
}

void addNode(Scene& scene, const Gltf& gltf, std::size_t index, const glm::mat4& parent) {
  const json& node = gltf.root.at("nodes").at(index);
  const glm::mat4 world = parent * transformOf(node);
  if (node.contains("camera")) {
    scene.viewFromWorld = glm::inverse(world);
    scene.yfov = gltf.root.at("cameras").at(node["camera"].get<std::size_t>()).at("perspective").at("yfov");
  }
  if (node.contains("extensions") && node["extensions"].contains("KHR_lights_punctual")) {
    const json& lights = gltf.root.at("extensions").at("KHR_lights_punctual").at("lights");
    const json& light = lights.at(node["extensions"]["KHR_lights_punctual"].at("light").get<std::size_t>());
    const auto colour = light.value("color", std::vector<float>{1, 1, 1});
    scene.toSun = glm::normalize(glm::vec3(world[2]));
    scene.sun = glm::vec3(colour[0], colour[1], colour[2]) * (light.value("intensity", 1.0f) / 683.0f);  // lux
  }
  if (node.contains("mesh"))
    for (const json& primitive : gltf.root.at("meshes").at(node["mesh"].get<std::size_t>()).at("primitives")) {
      const json &accessors = gltf.root.at("accessors"), &attributes = primitive.at("attributes");
      const auto positions = gltf.vectors(accessors.at(attributes.at("POSITION").get<std::size_t>()));
      const auto normals = gltf.vectors(accessors.at(attributes.at("NORMAL").get<std::size_t>()));
      std::vector<Vertex> vertices;
      const Material material = materialOf(gltf.root.at("materials").at(primitive.at("material").get<std::size_t>()));
      for (std::size_t i = 0; i < positions.size(); ++i) {
        vertices.push_back({positions[i], normals[i]});
        const glm::vec3 place(world * glm::vec4(positions[i], 1.0f));
        scene.least = glm::min(scene.least, place);
        scene.most = glm::max(scene.most, place);
      }
      Mesh mesh = upload(vertices, gltf.indices(accessors.at(primitive.at("indices").get<std::size_t>())));
      mesh.worldFromObject = world;
      mesh.material = material;
      scene.meshes.push_back(mesh);
    }
  for (const json& child : node.value("children", json::array())) addNode(scene, gltf, child.get<std::size_t>(), world);
}

const char* const kVersion = "#version 450 core\n";

const char* const kMeshVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 viewFromObject, clipFromView;
uniform mat3 normalFromObject;
out vec3 viewPosition, viewNormal;
void main() {
  viewPosition = vec3(viewFromObject * vec4(position, 1.0));
  viewNormal = normalFromObject * normal;
  gl_Position = clipFromView * vec4(viewPosition, 1.0);
}
)";

const char* const kGBuffer = R"(
in vec3 viewPosition, viewNormal;
uniform vec4 base;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;
void main() { albedo = base, normal = vec4(normalize(viewNormal), 0.0); }
)";

const char* const kFullscreen =
    "void main() { gl_Position = vec4(vec2((gl_VertexID & 1) << 2, (gl_VertexID & 2) << 1) - vec2(1.0), 0.5, 1.0); }";

const char* const kLight = R"(
layout(binding = 0) uniform sampler2D albedo;
layout(binding = 1) uniform sampler2D normal;
layout(binding = 2) uniform sampler2D depth;
uniform vec3 toSun, sun, ambient;
out vec4 lit;
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 n = texelFetch(normal, pixel, 0).xyz;
  vec3 light = sun * max(dot(n, toSun), 0.0) / 3.14159265 + ambient;
  lit = texelFetch(depth, pixel, 0).r > 0.0 ? vec4(texelFetch(albedo, pixel, 0).rgb * light, 1.0) : vec4(ambient, 1.0);
}
)";

// glTF: what a dielectric reflects and lets through; then one call.
const char* const kGlass = R"(
in vec3 viewPosition, viewNormal;
uniform vec4 base, surfaceValues;  // roughness, transmission, ior, thickness in metres
uniform ivec2 kinds;         // unlit, volume
uniform vec3 toSun, sun, ambient;

float fresnel(float c, float ior) {
  if (ior <= 1.0) return 0.0;
  float inside = sqrt(max(1.0 - (1.0 - c * c) / (ior * ior), 0.0));
  float p = (ior * c - inside) / (ior * c + inside), s = (c - ior * inside) / (c + ior * inside);
  return 0.5 * (p * p + s * s);
}

// Lambert + GGX, times the cosine.
vec3 reflectSun(vec3 n, vec3 toEye, vec3 albedo, float ior, float roughness) {
  float cosLight = dot(n, toSun);
  if (cosLight <= 0.0) return vec3(0.0);
  float cosEye = max(dot(n, toEye), 1e-4), a2 = pow(max(roughness, 0.03), 4.0);
  vec3 h = normalize(toSun + toEye);
  float cosHalf = clamp(dot(n, h), 0.0, 1.0), spread = cosHalf * cosHalf * (a2 - 1.0) + 1.0;
  float density = a2 / (3.14159265 * spread * spread);
  float visible = 0.5 / (cosLight * sqrt(cosEye * cosEye * (1.0 - a2) + a2) + cosEye * sqrt(cosLight * cosLight * (1.0 - a2) + a2));
  return (albedo / 3.14159265 + vec3(fresnel(clamp(dot(toEye, h), 0.0, 1.0), ior) * density * visible)) * cosLight;
}

void main() {
  vec3 toEye = normalize(-viewPosition);
  vec3 n = normalize(gl_FrontFacing ? viewNormal : -viewNormal);
  float cosEye = clamp(dot(n, toEye), 1e-4, 1.0), ior = surfaceValues.z;
  vec3 reflected = base.rgb, transmission = vec3(0.0);
  if (kinds.x == 0) {
    float f = fresnel(cosEye, ior);
    vec3 albedo = base.rgb * (1.0 - surfaceValues.y) * (1.0 - f);
    reflected = (albedo + vec3(f)) * ambient + reflectSun(n, toEye, albedo, ior, surfaceValues.x) * sun;
    transmission = base.rgb * surfaceValues.y * (1.0 - f);
  }
  PldSurface surface = pldSurface(base.a * reflected, base.a, transmission, viewPosition);
  surface.normal = n;
  if (kinds.y != 0) surface.eta = 1.0 / ior;
  surface.thickness = surfaceValues.w;
  float met = surfaceValues.x * clamp(2.0 * ior - 2.0, 0.0, 1.0);  // of the roughness, by light that passes
  if (surfaceValues.y > 0.0) surface.collimation = 1.0 - met * met;
  pldWriteFragment(surface);
}
)";

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
  Engine(int width, int height, pld_method method, pld_tier tier) : width_(width), height_(height) {
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
    info.method = method, info.tier = tier;
    info.fragments_per_pixel = 4.0f;  // of the exact tier
    info.features = PLD_FEATURE_COLOURED | PLD_FEATURE_LIGHT;
    if (method == PLD_METHOD_PHENOMENOLOGICAL) info.features |= PLD_FEATURE_REFRACTION | PLD_FEATURE_DIFFUSION;
    info.flags = PLD_FLAG_TIMERS | PLD_FLAG_DEBUG_GROUPS;
    info.depth = PLD_DEPTH_REVERSED;
    info.clip = PLD_CLIP_ZERO_TO_ONE;
    info.uniform_binding = 1;
    info.texture_unit = 4;
    if (pld_create(&info, &pass_) != PLD_OK) stop("no pass");
    check(pld_resize(pass_, width, height), pass_);
    if (method == PLD_METHOD_FRONT_TAIL && tier != PLD_TIER_EXACT) addStage(PLD_STAGE_FRONT);
    addStage(PLD_STAGE_LAYERS);
  }
  ~Engine() { pld_destroy(&pass_); }

  void draw(const Scene& scene) {
    const float f = 1.0f / std::tan(0.5f * scene.yfov);
    const float across = f * static_cast<float>(height_) / static_cast<float>(width_);
    clipFromView_ =
        glm::mat4(across, 0, 0, 0, 0, f, 0, 0, 0, 0, 0, -1, 0, 0, kNear, 0);  // reversed depth, nothing is too far
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
    frame.refract = PLD_REFRACT_AT_DEPTH;
    frame.refract_distance = 2.0f;
    frame.diffusion_k0 = 0.3f;
    frame.diffusion_k1 = 0.5f;
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
  // A texture or, 0, what the window shows, with Z; rows top to bottom.
  void write(const std::string& path, GLuint source) const {
    std::vector<float> rows, depth = read(depth_, GL_DEPTH_COMPONENT, 1), colour = read(source, GL_RGBA, 4);
    const auto width = static_cast<std::size_t>(width_);
    for (auto y = static_cast<std::size_t>(height_); y-- > 0;)
      for (std::size_t i = y * width; i < (y + 1) * width; ++i) {
        for (std::size_t c = 0; c < 4; ++c) rows.push_back(colour[4 * i + c]);
        rows.push_back(depth[i] > 0.0f ? kNear / depth[i] : std::numeric_limits<float>::infinity());
      }
    OIIO::ImageSpec spec(width_, height_, 5, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"R", "G", "B", "A", "Z"};
    spec.alpha_channel = 3;
    spec.z_channel = 4;
    const auto file = OIIO::ImageOutput::create(path);
    if (!file || !file->open(path, spec) || !file->write_image(OIIO::TypeDesc::FLOAT, rows.data()) || !file->close())
      stop(path + ": could not be written");
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
    for (const Mesh& mesh : scene.meshes) {
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
  if (count < 3 || count > 6) stop("engine GLASS.glb OUTDIR [WIDTHxHEIGHT] [METHOD[:exact]] [window[:FRAMES]]");
  int width = 640, height = 360;
  if (count > 3 && (std::sscanf(arguments[3], "%dx%d", &width, &height) != 2 || width < 1 || height < 1))
    stop("expected WIDTHxHEIGHT");
  const std::string asked = count > 4 ? arguments[4] : "phenomenological", named = asked.substr(0, asked.find(':')),
                    folder = arguments[2];
  const char* const names[] = {"phenomenological", "weighted", "front+tail"};
  const auto method = std::find(std::begin(names), std::end(names), named) - std::begin(names);
  if (method == 3 || (asked != named && asked != named + ":exact")) stop("no method " + asked);
  const std::string shows = count > 5 ? arguments[5] : "";
  int frames = 0;
  if (!shows.empty() && shows != "window" && (std::sscanf(shows.c_str(), "window:%d", &frames) != 1 || frames < 1))
    stop("expected window or window:FRAMES, found " + shows);
  try {
    GLFWwindow* const window = shows.empty() ? nullptr : makeWindow(width, height);
    if (!window) makeContext();
    Scene scene;
    const Gltf gltf = read(arguments[1]);
    for (const json& root : gltf.root.at("scenes").at(0).at("nodes"))
      addNode(scene, gltf, root.get<std::size_t>(), glm::mat4(1.0f));
    addRoom(scene);
    Engine engine(width, height, static_cast<pld_method>(method), asked == named ? PLD_TIER_FLOAT : PLD_TIER_EXACT);
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
