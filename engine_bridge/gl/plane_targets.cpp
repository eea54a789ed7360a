#include "engine_bridge/gl/plane_targets.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "engine_bridge/gl/plane_formats.h"
#include "gbuffer/errors.h"

namespace pellucid::gl {
namespace {

void readInto(const Texture& texture, int components, const Window& part, float* first, int rowLength) {
  const std::size_t texels = static_cast<std::size_t>(part.height() - 1) * static_cast<std::size_t>(rowLength) +
                             static_cast<std::size_t>(part.width());
  const std::size_t bytes = texels * static_cast<std::size_t>(components) * sizeof(float);
  constexpr std::size_t most = std::numeric_limits<GLsizei>::max();
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ROW_LENGTH, rowLength);
  glGetTextureSubImage(texture.name(), 0, part.x0, part.y0, 0, part.width(), part.height(), 1, channelsOf(components),
                       GL_FLOAT, static_cast<GLsizei>(std::min(bytes, most)), first);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
}

}  // namespace

PlaneTargets::PlaneTargets(int width, int height)
    : width_(width), height_(height), part_{0, 0, width, height}, frame_(Framebuffer::make()) {}

const Texture& PlaneTargets::textureOf(const PlaneSpec& plane) {
  for (const Target& target : targets_)
    if (target.place == plane.target && target.format == plane.format) return target.texture;
  targets_.push_back({plane.target, plane.format, Texture::make()});
  glTextureStorage2D(targets_.back().texture.name(), 1, formatOf(plane.format), width_, height_);
  return targets_.back().texture;
}

const PlaneSpec& PlaneTargets::specOf(PlaneSum sum) const {
  for (const PlaneSpec& plane : planes_)
    if (plane.sum == sum) return plane;
  throw std::logic_error("a plane is read that no layer was blended into");
}

const Texture& PlaneTargets::textureOf(PlaneSum sum) const {
  const PlaneSpec& plane = specOf(sum);
  for (const Target& target : targets_)
    if (target.place == plane.target && target.format == plane.format) return target.texture;
  throw std::logic_error("a plane without a texture");
}

// Clearing obeys the scissor; draws set theirs.
void PlaneTargets::begin(const std::vector<PlaneSpec>& planes) {
  planes_ = planes;
  const GLuint frame = frame_.name();
  GLenum buffers[kMostTargets];
  std::fill(std::begin(buffers), std::end(buffers), GLenum{GL_NONE});
  for (const PlaneSpec& plane : planes_) {
    const auto place = static_cast<GLuint>(plane.target);
    glNamedFramebufferTexture(frame, GL_COLOR_ATTACHMENT0 + place, textureOf(plane).name(), 0);
    buffers[place] = GL_COLOR_ATTACHMENT0 + place;
  }
  // What an earlier layout had besides does not count: it is not drawn to.
  for (GLuint i = 0; i < kMostTargets; ++i)
    if (buffers[i] == GL_NONE) glNamedFramebufferTexture(frame, GL_COLOR_ATTACHMENT0 + i, 0, 0);
  glNamedFramebufferDrawBuffers(frame, kMostTargets, buffers);
  checkGl("making the targets of the transparent pass");
  if (glCheckNamedFramebufferStatus(frame, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw ResourceError("GL: the device cannot draw to the planes of this --precision at once");
  glEnable(GL_SCISSOR_TEST);
  glScissor(part_.x0, part_.y0, part_.width(), part_.height());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame);
  glEnable(GL_BLEND);
  for (const PlaneSpec& plane : planes_) {
    const auto place = static_cast<GLuint>(plane.target);
    glClearNamedFramebufferfv(frame, GL_COLOR, plane.target, plane.clear.data());
    const BlendWords blend = blendOf(plane.blend);
    glBlendFuncSeparatei(place, blend.source, blend.destination, GL_ONE, GL_ONE);
    glBlendEquationSeparatei(place, blend.equation, blend.alphaEquation);
  }
}

void PlaneTargets::readTexels(PlaneSum sum, GLenum type, void* first, std::size_t bytes) const {
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(textureOf(sum).name(), 0, channelsOf(specOf(sum).components()), type, static_cast<GLsizei>(bytes),
                    first);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
}

// Whole texels where memory has the plane's components side by side, else component by component.
void PlaneTargets::readPlane(const PlaneSpec& plane, const ValuesOf& valuesOf, int x, int y, int rowLength) const {
  const int components = plane.components();
  const std::size_t corner =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(rowLength) + static_cast<std::size_t>(x);
  const PlaneValues whole = valuesOf(plane.sum, 0);
  if (whole.stride == static_cast<std::size_t>(components)) {
    readInto(textureOf(plane.sum), components, part_, whole.first + corner * whole.stride, rowLength);
    return;
  }
  std::vector<float> texels(static_cast<std::size_t>(part_.width()) * static_cast<std::size_t>(part_.height()) *
                            static_cast<std::size_t>(components));
  readInto(textureOf(plane.sum), components, part_, texels.data(), part_.width());
  for (int c = 0; c < components; ++c) {
    const PlaneValues values = valuesOf(plane.sum, c);
    const float* texel = texels.data() + c;
    for (int row = 0; row < part_.height(); ++row) {
      float* value =
          values.first + (corner + static_cast<std::size_t>(row) * static_cast<std::size_t>(rowLength)) * values.stride;
      for (int column = 0; column < part_.width(); ++column, texel += components, value += values.stride)
        *value = *texel;
    }
  }
}

void PlaneTargets::read(OitPlanes& planes, int x, int y) const {
  const auto has = [&](PlaneSum sum) {
    return std::any_of(planes_.begin(), planes_.end(), [sum](const PlaneSpec& plane) { return plane.sum == sum; });
  };
  const bool grey = !has(PlaneSum::weight);
  const auto isPacked = [](PlaneSum sum) {
    return sum == PlaneSum::radiance || sum == PlaneSum::opacity || sum == PlaneSum::depth;
  };
  const ValuesOf values = [&planes](PlaneSum sum, int component) { return valuesOf(planes, sum, component); };
  for (const PlaneSpec& plane : planes_)
    if (!grey || !isPacked(plane.sum)) readPlane(plane, values, x, y, planes.data.width());
  if (grey) readGrey(planes, x, y);  // after light
  checkGl("reading the planes back");
}

void PlaneTargets::readGrey(OitPlanes& planes, int x, int y) const {
  const int width = part_.width(), height = part_.height();
  Image<glm::vec4> radiance(width, height), opacity(width, height);
  Image<glm::vec2> depth(width, height);
  readInto(textureOf(PlaneSum::radiance), 4, part_, &radiance.data()->x, width);
  readInto(textureOf(PlaneSum::opacity), 4, part_, &opacity.data()->x, width);
  readInto(textureOf(PlaneSum::depth), 2, part_, &depth.data()->x, width);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      shading::GreyTargets grey;
      grey.radiance = radiance.at(column, row);
      grey.opacity = opacity.at(column, row);
      grey.depth = depth.at(column, row);
      const int px = x + column, py = y + row;
      const shading::OitTargets sums = shading::unpackGrey(grey, planes.light.at(px, py));
      planes.radiance.at(px, py) = sums.radiance;
      planes.weight.at(px, py) = sums.weight;
      planes.opacity.at(px, py) = sums.opacity;
      planes.depth.at(px, py) = sums.depth;
    }
}

void PlaneTargets::read(RimPlanes& planes, int x, int y) const {
  const ValuesOf values = [&planes](PlaneSum sum, int component) { return valuesOf(planes, sum, component); };
  for (const PlaneSpec& plane : planes_) readPlane(plane, values, x, y, planes.averaged.width());
  checkGl("reading the planes of rims back");
}

}  // namespace pellucid::gl
