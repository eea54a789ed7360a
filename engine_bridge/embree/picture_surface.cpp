#include "engine_bridge/embree/picture_surface.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "gbuffer/view_point.h"

namespace pellucid::rays {
namespace {

constexpr float kApart = 1.1f;       // shaders/gl/picture_mesh.vert
constexpr double kLiftPixels = 2.0;  // as opaque maps move their receivers by texels

}  // namespace

PictureSurface::PictureSurface(const GBuffer& gbuffer, const Camera& camera)
    : scene_(device_),
      orthographic_(camera.orthographic),
      pixel_(2.0 / std::min(camera.focal.x * gbuffer.display.width(), camera.focal.y * gbuffer.display.height())) {
  const Image<float>& z = gbuffer.viewZ;
  const int width = z.width(), height = z.height();
  std::vector<std::uint32_t> quads;
  for (int y = 0; y + 1 < height; ++y)
    for (int x = 0; x + 1 < width; ++x) {
      const float a = z.at(x, y), b = z.at(x + 1, y), c = z.at(x, y + 1), d = z.at(x + 1, y + 1);
      const float least = std::min({a, b, c, d}), most = std::max({a, b, c, d});
      if (!std::isfinite(most) || !(most <= least * kApart)) continue;
      const auto first = static_cast<std::uint32_t>(y * width + x), below = first + static_cast<std::uint32_t>(width);
      quads.insert(quads.end(), {first, below, below + 1, first + 1});
    }
  if (quads.empty()) {
    rtcCommitScene(scene_);
    return;
  }
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_QUAD);
  auto* corners = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, z.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 16, quads.size() / 4));
  if (!corners || !indices) {
    rtcReleaseGeometry(geometry);
    throw ResourceError("Embree: memory ran out while laying out the picture's surface, expected a smaller picture");
  }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec3 p = std::isfinite(z.at(x, y)) ? glm::vec3(viewPoint(gbuffer, camera, x, y)) : glm::vec3(0.0f);
      std::memcpy(
          corners + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)),
          &p, sizeof p);
    }
  std::copy(quads.begin(), quads.end(), indices);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  device_.check("building the picture's surface");
}

double PictureSurface::lift(const glm::dvec3& point) const {
  return kLiftPixels * pixel_ * (orthographic_ ? 1.0 : -point.z);
}

bool PictureSurface::blocked(glm::vec3 origin, glm::vec3 direction, float reach) const {
  return occluded(scene_, origin, direction, reach);
}

}  // namespace pellucid::rays
