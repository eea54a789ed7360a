#include "engine_bridge/gl/published_targets.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace pellucid::gl {

PublishedTargets::PublishedTargets(int width, int height) : targets_(width, height), clamped_(Buffer::make()) {
  const GLuint none = 0;
  glNamedBufferData(clamped_.name(), sizeof none, &none, GL_DYNAMIC_READ);
}

void PublishedTargets::begin(const std::vector<PlaneSpec>& planes) {
  scatters_ =
      std::any_of(planes.begin(), planes.end(), [](const PlaneSpec& plane) { return plane.sum == PlaneSum::delta; });
  const GLuint none = 0;
  glNamedBufferSubData(clamped_.name(), 0, sizeof none, &none);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, clamped_.name());
  targets_.begin(planes);
  checkGl("beginning the published tier");
}

void PublishedTargets::read(OitPlanes& planes, int x, int y, PublishedClamps& clamps) const {
  const auto texels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
  std::vector<float> radiance(4 * texels);
  std::vector<std::uint8_t> beta(4 * texels);
  std::vector<std::int8_t> delta(2 * texels, 0);
  targets_.readTexels(PlaneSum::radiance, GL_FLOAT, radiance.data(), radiance.size() * sizeof(float));
  targets_.readTexels(PlaneSum::beta, GL_UNSIGNED_BYTE, beta.data(), beta.size());
  if (scatters_) targets_.readTexels(PlaneSum::delta, GL_BYTE, delta.data(), delta.size());
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  GLuint written = 0;
  glGetNamedBufferSubData(clamped_.name(), 0, sizeof written, &written);
  checkGl("reading the planes of the published tier back");
  clamps.written += written;
  std::size_t i = 0;
  for (int row = 0; row < height(); ++row)
    for (int column = 0; column < width(); ++column, ++i) {
      PublishedPixel pixel;
      for (std::size_t c = 0; c < 4; ++c) {
        pixel.radiance[static_cast<int>(c)] = radiance[4 * i + c];
        pixel.beta[c] = beta[4 * i + c];
      }
      for (std::size_t c = 0; c < 2; ++c) pixel.delta[c] = delta[2 * i + c];
      storePublished(pixel, planes, x + column, y + row, clamps);
    }
}

}  // namespace pellucid::gl
