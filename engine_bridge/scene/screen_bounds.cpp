#include "engine_bridge/scene/screen_bounds.h"

#include <algorithm>
#include <cmath>

#include "engine_bridge/scene/placed.h"
#include "engine_bridge/scene/triangle_source.h"

namespace pellucid {
namespace {

constexpr std::size_t kMostTriangles = std::size_t{1} << 20, kBatch = 1024;
constexpr double kSlack = 2.0;  // pixels: a sample's place in its pixel, and rounding

// What has been met, pixels of the display's coordinates.
class Bounds {
 public:
  Bounds(const Camera& camera, const Window& display) : camera_(camera), display_(display) {}
  //   reach  metres about the point that it may cover, across the view
  // False where that cannot be told.
  bool add(const glm::dvec3& pView, double reach) {
    const double z = -pView.z;
    if (!camera_.orthographic && !(z > kClipNear)) return false;
    const glm::dvec2 scale = camera_.focal / (camera_.orthographic ? 1.0 : z);
    const glm::dvec2 ndc = scale * glm::dvec2(pView) + camera_.centre, around = glm::abs(scale) * reach;
    const glm::dvec2 half(0.5 * display_.width(), 0.5 * display_.height());
    const glm::dvec2 place(display_.x0 + (ndc.x + 1.0) * half.x, display_.y0 + (1.0 - ndc.y) * half.y);
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) return false;
    least_ = glm::min(least_, place - around * half);
    most_ = glm::max(most_, place + around * half);
    return true;
  }
  // Whether all of a triangle lies behind the eye. Points are turned about theirs, which leaves their depth.
  bool unseen(const glm::dvec3 (&corners)[3]) const {
    return !camera_.orthographic && -corners[0].z < kClipNear && -corners[1].z < kClipNear && -corners[2].z < kClipNear;
  }
  Window within(const Window& data) const {
    const auto clamped = [](double value, int low, int high) {
      return static_cast<int>(std::clamp(value, static_cast<double>(low), static_cast<double>(high)));
    };
    Window part;
    part.x0 = clamped(std::floor(least_.x - kSlack), data.x0, data.x1 - 1);
    part.y0 = clamped(std::floor(least_.y - kSlack), data.y0, data.y1 - 1);
    part.x1 = clamped(std::ceil(most_.x + kSlack), part.x0 + 1, data.x1);
    part.y1 = clamped(std::ceil(most_.y + kSlack), part.y0 + 1, data.y1);
    return part;
  }

 private:
  const Camera& camera_;
  const Window& display_;
  glm::dvec2 least_{1e300}, most_{-1e300};
};

}  // namespace

Window screenBounds(const Scene& scene, const Camera& camera, const GBuffer& gbuffer) {
  const auto transparent = [&](const Instance& instance) {
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(instance.primitive)];
    return scene.materials[static_cast<std::size_t>(primitive.material)].transparent();
  };
  std::size_t triangles = 0;
  for (const Instance& instance : scene.instances)
    if (transparent(instance)) triangles += scene.primitives[static_cast<std::size_t>(instance.primitive)].triangles();
  if (triangles > kMostTriangles) return gbuffer.data;
  const std::vector<Placed> placed = placeInstances(scene, camera);
  Bounds bounds(camera, gbuffer.display);
  VertexPlaces places;
  TriangleBatch batch;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (!transparent(scene.instances[i])) continue;
    const Primitive& primitive = scene.primitives[static_cast<std::size_t>(scene.instances[i].primitive)];
    const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
    const double scale = static_cast<double>(placed[i].thicknessScale) * static_cast<double>(material.pointScale);
    for (std::size_t first = 0; first < primitive.triangles(); first += kBatch) {
      readTriangles(primitive, first, std::min(kBatch, primitive.triangles() - first), places, batch);
      for (std::size_t k = 0; k < batch.indices.size(); k += 3) {
        glm::dvec3 corners[3];
        double reach[3];
        for (std::size_t c = 0; c < 3; ++c) {
          const Vertex& vertex = batch.vertices[batch.indices[k + c]];
          corners[c] = glm::dvec3(placed[i].viewFromObject * glm::dvec4(glm::dvec3(vertex.position), 1.0));
          reach[c] = primitive.points
                         ? scale * static_cast<double>(vertex.uv[1].x) * glm::length(glm::dvec2(vertex.uv[0]))
                         : 0.0;
        }
        if (bounds.unseen(corners)) continue;
        for (int c = 0; c < 3; ++c)
          if (!bounds.add(corners[c], reach[c])) return gbuffer.data;
      }
    }
  }
  return bounds.within(gbuffer.data);
}

}  // namespace pellucid
