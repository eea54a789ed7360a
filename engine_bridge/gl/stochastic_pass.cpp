#include "engine_bridge/gl/stochastic_pass.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine_bridge/gl/renderer.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

using namespace gl;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kDepthSteps = 65536.0f;          // shaders/gl/stochastic_cover.glsl
constexpr std::size_t kSampleBytes = 64u << 20;  // of a band's samples; GL 4.5 promises storage blocks of 16 MiB
constexpr GLuint kRankUnit = 16, kReachUnit = 14, kDepthsUnit = 15;

// Mirrors shaders/gl/stochastic_frame.glsl.
struct StochasticFrameBlock {
  glm::uvec4 samples, choice;
  glm::ivec4 origin;
};
static_assert(sizeof(StochasticFrameBlock) == 48);

struct PixelTargets {
  int width, height;
  gl::Texture reach, depths, light, unit, added;
  Framebuffer coverFrame, addFrame, noFrame;

  PixelTargets(int widthGiven, int heightGiven) : width(widthGiven), height(heightGiven) {
    const auto make = [&](Framebuffer& frame, GLuint attachment, gl::Texture& texture) {
      texture = gl::Texture::make();
      glTextureStorage2D(texture.name(), 1, GL_RGBA32F, width, height);
      glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
      glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
      glNamedFramebufferTexture(frame.name(), GL_COLOR_ATTACHMENT0 + attachment, texture.name(), 0);
    };
    coverFrame = Framebuffer::make();
    addFrame = Framebuffer::make();
    make(coverFrame, 0, reach);
    make(coverFrame, 1, depths);
    make(addFrame, 0, light);
    make(addFrame, 1, unit);
    make(addFrame, 2, added);
    const GLenum attachments[3] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
    glNamedFramebufferDrawBuffers(coverFrame.name(), 2, attachments);
    glNamedFramebufferDrawBuffers(addFrame.name(), 3, attachments);
    checkGl("making the targets of stochastic transparency");
    for (const Framebuffer* frame : {&coverFrame, &addFrame})
      if (glCheckNamedFramebufferStatus(frame->name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw std::logic_error("a framebuffer of stochastic transparency is incomplete");
  }
};

Image<glm::vec4> readBack(const gl::Texture& texture, int width, int height) {
  Image<glm::vec4> image(width, height);
  constexpr std::size_t most = std::numeric_limits<GLsizei>::max();
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureImage(texture.name(), 0, GL_RGBA, GL_FLOAT,
                    static_cast<GLsizei>(std::min(image.size() * sizeof(glm::vec4), most)), image.data());
  checkGl("reading stochastic sums back");
  return image;
}

}  // namespace

struct StochasticPass::Impl {
  const GBuffer* gbuffer;
  Renderer renderer;
  StochasticPassStatistics statistics;
  std::unique_ptr<PixelTargets> targets;
  Buffer frame = Buffer::make(), depths = Buffer::make(), owners = Buffer::make(), rankStorage = Buffer::make();
  BufferTexture ranks = BufferTexture::make();
  int ranksOf = 0;  // samples of the table on the device

  Impl(const Scene& scene, const GBuffer& gbufferGiven, const Camera& camera)
      : gbuffer(&gbufferGiven), renderer(scene, gbufferGiven, camera) {}
  void uploadRanks(int samples);
  void drawBand(const Window& band, int channels, std::uint32_t count, bool winners, Image<glm::vec3>& empty, int y);
  void read(const Window& part, StochasticPlanes& planes);
};

void StochasticPass::Impl::uploadRanks(int samples) {
  if (ranksOf == samples) return;
  const MaskTable table(samples);
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (table.ranks().size() > static_cast<std::size_t>(most))
    throw ResourceError(
        "GL: the table of sample masks is larger than the device's texture buffers; --masks naive needs none");
  glNamedBufferData(rankStorage.name(), static_cast<GLsizeiptr>(table.ranks().size() * sizeof(std::uint16_t)),
                    table.ranks().data(), GL_STATIC_DRAW);
  glTextureBuffer(ranks.name(), GL_R16UI, rankStorage.name());
  checkGl("uploading sample masks");
  ranksOf = samples;
}

// Leaves the band's share of empty samples in rows from y.
void StochasticPass::Impl::drawBand(const Window& band, int channels, std::uint32_t count, bool winners,
                                    Image<glm::vec3>& empty, int y) {
  const std::size_t pixels = static_cast<std::size_t>(band.width()) * static_cast<std::size_t>(band.height());
  const std::size_t samples = pixels * static_cast<std::size_t>(channels) * count;
  const auto bytes = static_cast<GLsizeiptr>(samples * sizeof(std::uint32_t));
  const std::uint32_t none = std::bit_cast<std::uint32_t>(kInfinity), nobody = 0xffffffffu;
  const auto fill = [&](const Buffer& buffer, GLuint block, std::uint32_t value) {
    glNamedBufferData(buffer.name(), bytes, nullptr, GL_DYNAMIC_COPY);
    glClearNamedBufferData(buffer.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, block, buffer.name());
  };
  fill(depths, 3, none);
  if (winners) fill(owners, 4, nobody);
  checkGl("making room for samples");
  renderer.setBand(band);

  glEnable(GL_BLEND);
  for (GLuint i = 0; i < 3; ++i) {
    glBlendFunci(i, GL_ONE, GL_ONE);
    glBlendEquationi(i, GL_FUNC_ADD);
  }
  glBlendEquationi(0, GL_MAX);
  const auto start = std::chrono::steady_clock::now();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, targets->coverFrame.name());
  renderer.draw(winners ? Output::coverToWin : Output::cover, {band});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  if (winners) {
    renderer.targets().beginNothing();
    renderer.draw(Output::claim, {band});
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    glEnable(GL_BLEND);
  }
  glFinish();
  const auto covered = std::chrono::steady_clock::now();
  glBlendEquationi(0, GL_FUNC_ADD);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, targets->addFrame.name());
  glBindTextureUnit(kReachUnit, targets->reach.name());
  glBindTextureUnit(kDepthsUnit, targets->depths.name());
  glBindSampler(kReachUnit, 0);
  glBindSampler(kDepthsUnit, 0);
  renderer.draw(winners ? Output::addWon : Output::add, {band});
  glFinish();
  statistics.coverSeconds += std::chrono::duration<double>(covered - start).count();
  statistics.addSeconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - covered).count();

  std::vector<std::uint32_t> found(samples);
  glGetNamedBufferSubData(depths.name(), 0, bytes, found.data());
  checkGl("reading samples back");
  for (std::size_t i = 0; i < pixels; ++i)
    for (int c = 0; c < 3; ++c) {
      const std::size_t first =
          (i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(std::min(c, channels - 1))) * count;
      const auto begin = found.begin() + static_cast<std::ptrdiff_t>(first);
      const auto open = std::count(begin, begin + static_cast<std::ptrdiff_t>(count), none);
      const auto width = static_cast<std::size_t>(band.width());
      empty.at(band.x0 + static_cast<int>(i % width), y + static_cast<int>(i / width))[c] =
          static_cast<float>(open) / static_cast<float>(count);
    }
}

void StochasticPass::Impl::read(const Window& part, StochasticPlanes& planes) {
  const int width = part.width(), height = part.height();
  const Image<glm::vec4> reach = readBack(targets->reach, width, height),
                         depth = readBack(targets->depths, width, height),
                         light = readBack(targets->light, width, height), unit = readBack(targets->unit, width, height),
                         added = readBack(targets->added, width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float count = depth.at(x, y).a;
      if (!(count > 0.0f)) continue;
      statistics.fragments += static_cast<std::size_t>(count);
      const int u = part.x0 + x, v = part.y0 + y;
      const float lightStep = shading::sumStep(reach.at(x, y).r, count), unitStep = shading::sumStep(1.0f, count);
      planes.light.at(u, v) = lightStep * glm::vec3(light.at(x, y));
      planes.unit.at(u, v) = unitStep * glm::vec3(unit.at(x, y));
      planes.added.at(u, v) = lightStep * glm::vec3(added.at(x, y));
      planes.beta.at(u, v) = shading::transmittanceOf(glm::vec3(depth.at(x, y)) / kDepthSteps);
      planes.frontZ.at(u, v) = -reach.at(x, y).g;
    }
}

StochasticPass::StochasticPass(GlContext&, const Scene& scene, const GBuffer& gbuffer, const Camera& camera)
    : impl_(new Impl(scene, gbuffer, camera)) {}

void StochasticPass::pose(const Camera& camera) {
  impl_->renderer.pose(camera);
}

void StochasticPass::over(const GBuffer& gbuffer, const Camera& camera) {
  impl_->renderer.over(gbuffer, camera);
  impl_->gbuffer = &gbuffer;
}
StochasticPass::~StochasticPass() = default;

bool StochasticPass::scatters(const PassSettings& settings) const {
  return impl_->renderer.wouldScatter(settings);
}

const StochasticPassStatistics& StochasticPass::statistics() const {
  return impl_->statistics;
}

namespace {

// Planes in which nothing was drawn.
StochasticPlanes emptySamples(const Window& data) {
  const Image<glm::vec3> black(data.width(), data.height(), glm::vec3(0.0f)),
      white(data.width(), data.height(), glm::vec3(1.0f));
  return {data,
          black,
          black,
          black,
          white,
          white,
          Image<glm::vec4>(data.width(), data.height(), glm::vec4(0, 0, 0, kInfinity)),
          Image<float>(data.width(), data.height(), kInfinity)};
}

// How many rows of samples a storage block takes at once.
//   row  bytes of one. Throws ResourceError when the device cannot hold it.
int rowsAtOnce(std::size_t row) {
  GLint64 limit = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &limit);
  const std::size_t most = static_cast<std::size_t>(std::max<GLint64>(limit, 0));
  if (row > most)
    throw ResourceError(
        "GL: a row of samples is larger than the device's storage blocks; more --aa passes make it smaller");
  return static_cast<int>(std::max<std::size_t>(std::min(kSampleBytes, most) / row, 1));
}

}  // namespace

StochasticPlanes StochasticPass::sample(const PassSettings& settings, const StochasticPassSettings& samples) {
  Impl& self = *impl_;
  self.statistics = {};
  self.statistics.passes = samples.winnersOnly ? 3 : 2;
  const Window& data = self.gbuffer->data;
  StochasticPlanes planes = emptySamples(data);
  PassSettings plain = settings;
  plain.scatter.refract = shading::PLD_REFRACT_OFF;
  plain.scatter.k0 = 0.0f;
  if (samples.stratified) self.uploadRanks(samples.samples);
  const auto count = static_cast<std::uint32_t>((samples.samples - samples.first + samples.step - 1) / samples.step);
  for (const Window& part : self.renderer.superTiles(settings)) {
    self.renderer.begin(part, plain, settings.chunkBytes ? settings.chunkBytes : settings.budgetBytes);
    if (!self.targets || self.targets->width != part.width() || self.targets->height != part.height())
      self.targets = std::make_unique<PixelTargets>(part.width(), part.height());
    const float none[4] = {0.0f, -kInfinity, 0.0f, 0.0f}, zero[4] = {0, 0, 0, 0};
    glDisable(GL_SCISSOR_TEST);
    glClearNamedFramebufferfv(self.targets->coverFrame.name(), GL_COLOR, 0, none);
    glClearNamedFramebufferfv(self.targets->coverFrame.name(), GL_COLOR, 1, zero);
    for (GLint i = 0; i < 3; ++i) glClearNamedFramebufferfv(self.targets->addFrame.name(), GL_COLOR, i, zero);
    const StochasticFrameBlock frame{
        {static_cast<std::uint32_t>(samples.samples), static_cast<std::uint32_t>(samples.first),
         static_cast<std::uint32_t>(samples.step), count},
        {samples.seed, samples.stratified ? 1u : 0u, samples.winnersOnly ? 1u : 0u, settings.pieces ? 1u : 0u},
        {data.x0 + part.x0, data.y0 + part.y0, 0, 0}};
    glNamedBufferData(self.frame.name(), sizeof frame, &frame, GL_DYNAMIC_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, 3, self.frame.name());
    if (samples.stratified) glBindTextureUnit(kRankUnit, self.ranks.name());
    glBindSampler(kRankUnit, 0);

    const int channels = self.renderer.layers().coloured ? 3 : 1;
    const std::size_t row =
        static_cast<std::size_t>(part.width()) * static_cast<std::size_t>(channels) * count * sizeof(std::uint32_t);
    const int rows = rowsAtOnce(row);
    Image<glm::vec3> empty(part.width(), part.height(), glm::vec3(1.0f));
    for (int top = 0; top < part.height(); top += rows) {
      const Window band{0, top, part.width(), std::min(top + rows, part.height())};
      self.drawBand(band, channels, count, samples.winnersOnly, empty, top);
      ++self.statistics.bands;
    }
    self.read(part, planes);
    for (int y = 0; y < part.height(); ++y)
      for (int x = 0; x < part.width(); ++x) planes.empty.at(part.x0 + x, part.y0 + y) = empty.at(x, y);
    if (self.renderer.hasSolids()) self.renderer.targets().readSolid(planes.solid, part.x0, part.y0);
  }
  const gl::ShadowRayTable::Counts rays = self.renderer.takeShadowRayCounts();
  self.statistics.shadowRays = rays.rays;
  self.statistics.shadowSeconds = rays.seconds;
  return planes;
}

}  // namespace pellucid
