#include "engine_bridge/gl/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "engine_bridge/gl/fragment_lists.h"
#include "engine_bridge/gl/solidity.h"
#include "engine_bridge/scene/foliage.h"
#include "gbuffer/errors.h"
#include "gbuffer/view_point.h"
#include "shaders/closed_body_text.h"

namespace pellucid::gl {
namespace {

constexpr const char* kVertexStage = "gl/transparent.vert";
constexpr GLuint kAtlasUnit = 11;  // shaders/gl/environment.glsl
constexpr const char* kFragmentStage = "gl/transparent.frag";

template <class T>
void fillStorage(const Buffer& buffer, const std::vector<T>& values) {
  // A block without a byte cannot be bound.
  const T none{};
  glNamedBufferData(buffer.name(), static_cast<GLsizeiptr>(std::max<std::size_t>(values.size(), 1) * sizeof(T)),
                    values.empty() ? &none : values.data(), GL_STATIC_DRAW);
}

void requireMatch(const GBuffer& gbuffer) {
  if (gbuffer.data.width() <= 0 || gbuffer.data.height() <= 0 || gbuffer.viewZ.width() != gbuffer.data.width() ||
      gbuffer.viewZ.height() != gbuffer.data.height())
    throw std::logic_error("the G-buffer's depth does not have the size of its data window");
}

// Metres to the nearest thing of the picture; 0 where it shows nothing, and layers may be as near as they like.
double nearestOf(const GBuffer& gbuffer) {
  float nearest = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < gbuffer.viewZ.size(); ++i) nearest = std::min(nearest, gbuffer.viewZ[i]);
  return std::isfinite(nearest) ? static_cast<double>(nearest) : 0.0;
}

// Of fragments that know whether they lie behind the eye's plane. An orthographic view's triangles, cut there before,
// would end where the rasteriser rounds the cut to, which for steep ones is far from the plane.
glm::mat4 clipUncut(const Camera& camera, const Window& display, const Window& data, glm::dvec2 sample) {
  glm::mat4 clip(clipFromView(camera, display, data, sample));
  if (camera.orthographic) {
    clip[2][2] = 0.0f;
    clip[3][2] = 0.5f;
  }
  return clip;
}

}  // namespace

Renderer::Renderer(const Scene& scene, const GBuffer& gbuffer, const Camera& camera)
    : scene_(scene),
      gbuffer_(&gbuffer),
      nearest_(nearestOf(gbuffer)),
      camera_(camera),
      textures_(scene),
      stream_(scene) {
  requireMatch(gbuffer);
  frameBuffer_ = Buffer::make();
  materialBuffer_ = Buffer::make();
  lightBuffer_ = Buffer::make();
  place();
}

void Renderer::pose(const Camera& camera) {
  camera_ = camera;
  textures_.upload();
  stream_.forget();
  place();
}

// What depends on where everything stands.
void Renderer::place() {
  placed_ = placeInstances(scene_, camera_);
  const std::vector<PunctualLight> lights = lightBlocks(scene_.lights, camera_);
  lights_ = static_cast<int>(lights.size());
  fillStorage(lightBuffer_, lights);

  GLint alignment = 1;
  glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
  const auto step = static_cast<std::size_t>(alignment);
  materialStride_ = (sizeof(MaterialBlock) + step - 1) / step * step;
  std::vector<std::uint8_t> materials(materialStride_ * scene_.materials.size());
  for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
    const MaterialBlock block = materialBlock(scene_.materials[i]);
    std::memcpy(&materials[i * materialStride_], &block, sizeof(block));
  }
  fillStorage(materialBuffer_, materials);

  classify();
  checkGl("preparing the transparent pass");
}

void Renderer::over(const GBuffer& gbuffer, const Camera& camera) {
  requireMatch(gbuffer);
  if (camera.viewFromWorld != camera_.viewFromWorld || camera.orthographic != camera_.orthographic)
    throw std::logic_error(
        "Renderer::over: another place or kind of camera than the one that everything was placed by");
  gbuffer_ = &gbuffer;
  nearest_ = nearestOf(gbuffer);
  camera_ = camera;
  opaqueZIsOld_ = true;
}

void Renderer::classify() {
  std::vector<float> largestScale(scene_.primitives.size(), -1.0f);
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    float& scale = largestScale[static_cast<std::size_t>(scene_.instances[i].primitive)];
    scale = std::max(scale, placed_[i].thicknessScale);
  }
  const std::vector<ColourRange> drawnColours = coloursDrawn(scene_);
  std::vector<bool> infers;
  for (const Material& material : scene_.materials)
    infers.push_back(material.transparent() && infersOcclusion(material, scene_));
  shaders_.clear();
  needs_[0] = needs_[1] = Needs();
  for (std::size_t i = 0; i < scene_.primitives.size(); ++i) {
    const Primitive& primitive = scene_.primitives[i];
    const Material& material = scene_.materials.at(static_cast<std::size_t>(primitive.material));
    Shader shader{};
    if (material.transparent() && largestScale[i] >= 0.0f) {
      const ColourRange& colours = drawnColours[i];
      shader.vertexColours = colours.least != glm::vec4(1.0f) || colours.most != glm::vec4(1.0f);
      shader.canBeSolid = canBeSolid(material, colours, textures_, largestScale[i]);
      Needs& needs = needs_[material.lowResolution ? 1 : 0];
      needs.solids = needs.solids || shader.canBeSolid;
      needs.adds = needs.adds || canBeAdditive(material);
      needs.addScattering(material);
      needs.coloured = needs.coloured || canTransmitColour(material, shader.vertexColours);
      needs.infers = needs.infers || infers[static_cast<std::size_t>(primitive.material)];
      shader.infers = infers[static_cast<std::size_t>(primitive.material)];
    }
    shaders_.push_back(std::move(shader));
  }
}

Window Renderer::areaOf(const PassSettings& settings) const {
  const Window &data = gbuffer_->data, &area = pellucid::areaOf(settings, data);
  return {area.x0 - data.x0, area.y0 - data.y0, area.x1 - data.x0, area.y1 - data.y0};
}

namespace {

Window common(const Window& a, const Window& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

}  // namespace

std::vector<Window> Renderer::superTiles(const PassSettings& settings) const {
  std::vector<Window> parts;
  const Window area = areaOf(settings);
  const int width = gbuffer_->data.width(), height = gbuffer_->data.height();
  for (int y = 0; y < height; y += kSuperTile)
    for (int x = 0; x < width; x += kSuperTile) {
      const Window part{x, y, std::min(x + kSuperTile, width), std::min(y + kSuperTile, height)};
      const Window met = common(part, area);
      if (met.width() > 0 && met.height() > 0) parts.push_back(part);
    }
  return parts;
}

Window Renderer::drawnPart() const {
  const Window met = common(areaOf(settings_), superTile_);
  return {met.x0 - superTile_.x0, met.y0 - superTile_.y0, met.x1 - superTile_.x0, met.y1 - superTile_.y0};
}

Needs Renderer::needsOf(const PassSettings& settings) const {
  if (settings.layers != LayerChoice::all) return needs_[settings.layers == LayerChoice::lowResolution ? 1 : 0];
  return either(needs_[0], needs_[1]);
}

void Renderer::chooseFeatures(const PassSettings& settings) {
  const Needs needs = needsOf(settings);
  const bool all = !settings.scatter.prune;
  features_.prune = settings.scatter.prune;
  features_.probes = settings.probeCell > 1;
  features_.pieces = settings.pieces;
  features_.mask = settings.mask;
  features_.lights = lights_ > 0;
  features_.shadowRays = features_.lights && settings.shadowRays != nullptr;
  features_.shadows = features_.lights && settings.shadows != nullptr && !features_.shadowRays;
  features_.environment = settings.environment != nullptr;
  features_.surroundings = !features_.environment && settings.surroundings != glm::vec3(0.0f);
  features_.lightVolume = settings.particleLight != nullptr;
  features_.solids = needs.solids || all;
  features_.adds = needs.adds || (settings.fog && settings.fog->emits());
  chooseScattering(needs, settings, features_);
  features_.grey = !needs.coloured && !all;
  // Occluders are planes of the full resolution.
  features_.occludes =
      settings.occlusion.occluders && settings.layers != LayerChoice::lowResolution && wouldOcclude(settings);
  features_.rimForm = settings.occlusion.rims ? settings.occlusion.form : -1;
}

bool Renderer::wouldOcclude(const PassSettings& settings) const {
  return needsOf(settings).infers &&
         (settings.environment || settings.surroundings != glm::vec3(0.0f) || settings.occlusion.directShare > 0.0f);
}

bool Renderer::wouldScatter(const PassSettings& settings) const {
  const Needs needs = needsOf(settings);
  return !settings.scatter.prune || (settings.scatter.refract != shading::PLD_REFRACT_OFF && needs.refracts) ||
         (settings.scatter.k0 > 0.0f && needs.diffuses);
}

void Renderer::begin(const Window& superTile, const PassSettings& settings, std::size_t geometryBytes) {
  prepare(superTile, settings, geometryBytes);
  if (features_.shadowRays) traceShadows(superTile);
  drawSolids();
}

void Renderer::solidDepth(const Window& superTile, const PassSettings& settings, std::size_t geometryBytes,
                          Image<float>& z) {
  prepare(superTile, settings, geometryBytes);
  if (!features_.solids) return;
  targets_->beginSolidDepth();
  draw(Output::solid, tiles());
  glDisable(GL_DEPTH_TEST);
  targets_->readSolidDepth(z, superTile.x0, superTile.y0);
}

void Renderer::uploadOccluders(const Window& superTile) {
  const std::shared_ptr<const OccluderPlanes>& planes = settings_.occlusion.occluders;
  if (uploadedOccluders_ != planes || !(occludersPart_ == superTile)) {
    if (planes->data != gbuffer_->data) throw std::logic_error("occluders of another window than the G-buffer's");
    occluders_ = uploadPlanes(planes->viewZ, planes->occlusion, superTile);
    occludersPart_ = superTile;
    uploadedOccluders_ = planes;
  }
  glBindTextureUnit(7, occluders_.name());
  glBindSampler(7, 0);
}

void Renderer::describeSurfaces() {
  for (std::size_t i = 0; i < shaders_.size(); ++i) {
    const Material& material = scene_.materials[static_cast<std::size_t>(scene_.primitives[i].material)];
    shaders_[i].surface =
        surfaceDefines(material, shaders_[i].vertexColours, features_, shaders_[i].infers, scene_.primitives[i].points);
    for (std::string& define : textures_.defines(material, settings_.filter))
      shaders_[i].surface.push_back(std::move(define));
    std::fill(std::begin(shaders_[i].programs), std::end(shaders_[i].programs), nullptr);
  }
}

namespace {

void setDrawingState(const Window& superTile) {
  glViewport(0, 0, superTile.width(), superTile.height());
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  // Whatever an earlier pass that threw has left.
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_DEPTH_TEST);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);  // as placed: the loader turns the windings of instances that mirror
}

}  // namespace

void Renderer::prepare(const Window& superTile, const PassSettings& settings, std::size_t geometryBytes) {
  settings_ = settings;
  superTile_ = superTile;
  geometryBytes_ = geometryBytes;
  chooseFeatures(settings);
  describeSurfaces();

  if (!targets_ || targets_->width() != superTile.width() || targets_->height() != superTile.height())
    targets_.emplace(superTile.width(), superTile.height());
  targets_->setPart(drawnPart());
  uploadDepth(superTile);

  const Window& data = gbuffer_->data;
  const Window part{data.x0 + superTile.x0, data.y0 + superTile.y0, data.x0 + superTile.x1, data.y0 + superTile.y1};
  frame_ = FrameBlock{};
  frame_.clipFromView = clipUncut(camera_, gbuffer_->display, part, settings.sample);
  frame_.surroundings = glm::vec4(settings.surroundings, 0.0f);
  frame_.weightNear = settings.weight.rangeNear;
  frame_.weightFar = settings.weight.rangeFar;
  frame_.weightExponent = settings.weight.exponent;
  frame_.weightReference = settings.weight.reference;
  frame_.depthFactor = 1.0f + gbuffer_->depthPrecision;
  frame_.lightCount = lights_;
  frame_.orthographic = camera_.orthographic ? 1 : 0;
  const double halfWidth = 0.5 * gbuffer_->display.width(), halfHeight = 0.5 * gbuffer_->display.height();
  frame_.refraction = {static_cast<float>(settings.scatter.refract), settings.scatter.refractDistance,
                       static_cast<float>(camera_.focal.x * halfWidth),
                       static_cast<float>(camera_.focal.y * halfHeight)};
  frame_.diffusion = {settings.scatter.k0, settings.scatter.k1, settings.scatter.netCoverage ? 1.0f : 0.0f,
                      settings.occlusion.directShare};
  frame_.viewport = glm::vec2(superTile.width(), superTile.height());
  frame_.worldFromView = glm::mat4(glm::mat3(glm::transpose(glm::dmat3(camera_.viewFromWorld))));
  frame_.footprint = settings.footprint;
  frame_.toMiddle = glm::vec2(0.5 - settings.sample);
  frame_.probeCell = settings.probeCell;
  frame_.originX = superTile.x0;
  frame_.originY = superTile.y0;
  frame_.atlasEdge = settings.environment ? settings.environment->edge : 0;
  if (settings.particleLight) {
    frame_.volumeFromView = settings.particleLight->texelFromView;
    frame_.volumeTexels = {settings.particleLight->size, 1};
    particleLight_.bind(settings.particleLight);
  }
  uploadSurroundings();
  if (features_.shadows) uploadShadows();
  uploadFrame();

  setDrawingState(superTile);
  glBindTextureUnit(5, opaqueZ_.name());
  glBindSampler(5, 0);
  glBindSampler(6, 0);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frameBuffer_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, lightBuffer_.name());
  if (features_.occludes) uploadOccluders(superTile);
  checkGl("beginning the transparent pass");
}

void Renderer::uploadDepth(const Window& superTile) {
  const bool fits =
      opaqueZ_ && opaqueZPart_.width() == superTile.width() && opaqueZPart_.height() == superTile.height();
  if (!fits)
    opaqueZ_ = uploadPlane(gbuffer_->viewZ, superTile);
  else if (opaqueZIsOld_ || opaqueZPart_ != superTile)
    updatePlane(opaqueZ_, gbuffer_->viewZ, superTile);
  opaqueZPart_ = superTile;
  opaqueZIsOld_ = false;
}

void Renderer::uploadSurroundings() {
  if (!settings_.environment) return;
  if (atlasOf_ != settings_.environment) {
    const Image<glm::vec4>& atlas = settings_.environment->atlas;
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    if (std::max(atlas.width(), atlas.height()) > largest)
      throw ResourceError("environment: its maps are larger than the GL device holds along an edge");
    atlas_ = Texture::make();
    glTextureStorage2D(atlas_.name(), 1, GL_RGBA32F, atlas.width(), atlas.height());
    glTextureSubImage2D(atlas_.name(), 0, 0, 0, atlas.width(), atlas.height(), GL_RGBA, GL_FLOAT, atlas.data());
    checkGl("uploading the environment");
    atlasOf_ = settings_.environment;
  }
  glBindTextureUnit(kAtlasUnit, atlas_.name());
  glBindSampler(kAtlasUnit, 0);
}

void Renderer::uploadShadows() {
  if (shadowsOf_ != settings_.shadows) shadows_.emplace(*settings_.shadows, scene_.lights);
  shadowsOf_ = settings_.shadows;
  shadows_->bind();
}

// Lists what is lit, without light, and has rays say what arrives there.
void Renderer::traceShadows(const Window& superTile) {
  const FrameFeatures whole = features_;
  features_.lights = features_.shadowRays = features_.surroundings = features_.environment = false;
  features_.pieces = false;  // surfaces ask for light by their triangle
  features_.solids = false;  // they are lit as well, and what they hide is not known yet
  scatterNothing(features_);
  features_.occludes = false;
  tracing_ = true;
  describeSurfaces();
  rayTable_.begin(superTile.width(), superTile.height(), lights_);
  const glm::dvec2 origin = glm::dvec2(superTile.x0, superTile.y0) + settings_.sample - 0.5;
  listFragments(*this, settings_.budgetBytes / 4, [&](FragmentLists& lists, const Window& band) {
    rayTable_.add(lists, band, *settings_.shadowRays, [&](int x, int y, float z) {
      return viewPoint(*gbuffer_, camera_, origin + glm::dvec2(x, y), static_cast<double>(z));
    });
  });
  tracing_ = false;
  features_ = whole;
  describeSurfaces();
  rayCounts_ += rayTable_.finish();
}

void Renderer::uploadFrame() {
  glNamedBufferData(frameBuffer_.name(), sizeof(frame_), &frame_, GL_DYNAMIC_DRAW);
}

void Renderer::setBand(const Window& band) {
  frame_.bandX = band.x0;
  frame_.bandY = band.y0;
  frame_.bandWidth = band.width();
  uploadFrame();
}

// Depth first, then the largest radiance at that depth: no order of triangles shows. One program does both, so that
// the depths compared as equal are the same bits.
void Renderer::drawSolids() {
  if (!features_.solids) return;
  targets_->beginSolidDepth();
  draw(Output::solid, tiles());
  targets_->beginSolidTies();
  draw(Output::solid, tiles());
  glDisable(GL_DEPTH_TEST);
  targets_->bindSolid();
}

const Program& Renderer::programFor(int primitive, Output output) {
  Shader& shader = shaders_[static_cast<std::size_t>(primitive)];
  const Program*& program = shader.programs[static_cast<std::size_t>(output)];
  if (!program) {
    std::vector<std::string> defines = outputDefines(output, features_, settings_);
    defines.insert(defines.end(), shader.surface.begin(), shader.surface.end());
    program = &programs().get(kVertexStage, kFragmentStage, defines);
  }
  return *program;
}

void Renderer::setBody(const Program& program, const Primitive& primitive, const Placed& placed) {
  const bool known = primitive.body && glm::determinant(placed.viewFromObject) != 0.0;
  glUniform1i(program.bodyKind, known ? primitive.body->kind : shading::PLD_BODY_NONE);
  if (!known) return;
  const glm::mat4 bodyFromView(primitive.body->fromObject * glm::inverse(placed.viewFromObject));
  glUniformMatrix4fv(program.bodyFromView, 1, GL_FALSE, &bodyFromView[0][0]);
}

void Renderer::drawChunk(const std::vector<ChunkDraw>& draws, Output output) {
  const Program* program = nullptr;
  int boundMaterial = -1;
  float maskResolved = 0.0f;
  for (const ChunkDraw& one : draws) {
    const Instance& instance = scene_.instances[one.instance];
    const Primitive& primitive = scene_.primitives[static_cast<std::size_t>(instance.primitive)];
    if (output == Output::solid && !shaders_[static_cast<std::size_t>(instance.primitive)].canBeSolid) continue;
    if (output == Output::rims && !shaders_[static_cast<std::size_t>(instance.primitive)].infers) continue;
    const Material& material = scene_.materials[static_cast<std::size_t>(primitive.material)];
    if (!takes(settings_.layers, material)) continue;
    if (tracing_ && (material.unlit || material.billboard || primitive.points)) continue;
    const Placed& placed = placed_[one.instance];
    const Program& wanted = programFor(instance.primitive, output);
    if (&wanted != program) glUseProgram(wanted.name.name());
    program = &wanted;
    if (boundMaterial != primitive.material) {
      boundMaterial = primitive.material;
      textures_.bind(material, settings_.filter, settings_.footprint);
      maskResolved = textures_.maskResolved(material);
      glBindBufferRange(GL_UNIFORM_BUFFER, 1, materialBuffer_.name(),
                        static_cast<GLintptr>(static_cast<std::size_t>(boundMaterial) * materialStride_),
                        sizeof(MaterialBlock));
    }
    if (material.bothSides())
      glDisable(GL_CULL_FACE);
    else
      glEnable(GL_CULL_FACE);
    program->placeObject(placed.viewFromObject, nearest_);
    glUniformMatrix3fv(program->normalFromObject, 1, GL_FALSE, &placed.normalFromObject[0][0]);
    glUniform1f(program->thicknessScale, placed.thicknessScale);
    glUniform4fv(program->instanceColour, 1, &instance.colour[0]);
    glUniform1f(program->pointScale, placed.thicknessScale * material.pointScale);
    glUniform1f(program->maskResolved, maskResolved);
    glUniform1ui(program->instanceIdentity, instance.identity);
    if (program->bodyKind >= 0) setBody(*program, primitive, placed);
    const auto corners = static_cast<GLsizei>(one.triangles * 3);
    // The stage pulls its vertices: it needs all three of a triangle, and its number.
    glDrawArrays(GL_TRIANGLES, static_cast<GLint>(one.firstTriangle * 3), corners);
  }
}

void Renderer::draw(Output output, const std::vector<Window>& scissors) {
  glEnable(GL_SCISSOR_TEST);
  stream_.sweep(settings_.order, geometryBytes_, [&](const std::vector<ChunkDraw>& draws) {
    for (const Window& scissor : scissors) {
      glScissor(scissor.x0, scissor.y0, scissor.width(), scissor.height());
      drawChunk(draws, output);
    }
  });
  checkGl("drawing transparent triangles");
}

FogFrame Renderer::fogFrame(const Window& superTile) const {
  const Window& data = gbuffer_->data;
  FogFrame frame;
  frame.defines = outputDefines(Output::sums, features_, settings_);
  frame.rays =
      pixelRays(camera_, gbuffer_->display, {data.x0 + superTile.x0, data.y0 + superTile.y0}, settings_.sample);
  return frame;
}

std::vector<Window> Renderer::tiles() const {
  const int width = targets_->width(), height = targets_->height();
  const int edge = settings_.tile > 0 ? settings_.tile : std::max(width, height);
  const Window drawn = drawnPart();
  std::vector<Window> tiles;
  for (int y = 0; y < height; y += edge)
    for (int x = 0; x < width; x += edge) {
      const Window tile = common({x, y, std::min(x + edge, width), std::min(y + edge, height)}, drawn);
      if (tile.width() > 0 && tile.height() > 0) tiles.push_back(tile);
    }
  return tiles;
}

}  // namespace pellucid::gl
