#include "composite/pipeline/understood_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine_bridge/scene/scene_extent.h"
#include "gbuffer/camera_match.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

constexpr double kSamePixels = 2.0;  // as far as positions of the file may be from where a camera sees them

struct DepthRange {
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
};

DepthRange rangeOf(const GBuffer& gbuffer) {
  DepthRange range;
  for (std::size_t i = 0; i < gbuffer.viewZ.size(); ++i) {
    const auto z = static_cast<double>(gbuffer.viewZ[i]);
    if (!std::isfinite(z)) continue;
    range.nearest = std::min(range.nearest, z);
    range.farthest = std::max(range.farthest, z);
  }
  return range;
}

// Scene and picture that lie a power of ten apart, and do not meet, are likely to be in different units.
std::string unitDoubt(const SceneExtent& extent, const DepthRange& picture, double unit) {
  if (!(extent.farthest > 0.0) || !(picture.farthest > 0.0)) return "";
  if (extent.farthest >= picture.nearest && extent.nearest <= picture.farthest) return "";
  const double times = std::sqrt(picture.nearest * picture.farthest / (extent.nearest * extent.farthest));
  const double power = std::round(std::log10(times));
  if (std::abs(power) < 1.0 || std::abs(power) > 3.0 || std::abs(std::log10(times) - power) > 0.25) return "";
  return fmt::format(
      "the picture shows things about {:g} times as far away as the scene's: if it is in another unit, "
      "give --unit {:g}, or --scene-unit {:g} for the scene",
      std::pow(10.0, power), unit * std::pow(10.0, -power), std::pow(10.0, power));
}

// How far the other camera sees five points of the picture from where they are.
double pixelsApart(const Camera& own, const Camera& other, const GBuffer& gbuffer, double z) {
  const glm::dmat4 worldFromView = glm::inverse(own.viewFromWorld);
  double worst = 0;
  for (const glm::dvec2& ndc : {glm::dvec2(0, 0), {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}) {
    const glm::dvec2 across = (ndc - own.centre) / own.focal * (own.orthographic ? 1.0 : z);
    const glm::dvec3 world(worldFromView * glm::dvec4(across, -z, 1.0));
    const Projected here = project(own, gbuffer.display, world), there = project(other, gbuffer.display, world);
    const double off = glm::length(here.pixel - there.pixel);
    worst = std::max(worst, there.z > 0.0 && std::isfinite(off) ? off : std::numeric_limits<double>::infinity());
  }
  return worst;
}

}  // namespace

std::vector<std::string> sceneLines(const Shot& shot) {
  const GBuffer& gbuffer = shot.opaque.gbuffer;
  const std::optional<SceneExtent> extent = extentOf(shot.scene, shot.camera, gbuffer);
  if (!extent) return {};
  std::string line = fmt::format("scene: ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m", extent->least.x,
                                 extent->least.y, extent->least.z, extent->most.x, extent->most.y, extent->most.z);
  if (extent->farthest > 0.0) line += fmt::format(", {:.4g} to {:.4g} m away", extent->nearest, extent->farthest);
  const double share = 100.0 * static_cast<double>(extent->beforeDepth) /
                       static_cast<double>(std::max<std::size_t>(1, extent->inPicture));
  line += extent->farthest <= 0.0  ? ", all of it behind the eye"
          : extent->inPicture == 0 ? ", no corner of it in the picture"
                                   : fmt::format(", {:.3g}% of it before what the picture shows", share);
  std::vector<std::string> lines{line};
  if (std::string doubt = unitDoubt(*extent, rangeOf(gbuffer), shot.opaque.metresPerUnit); !doubt.empty())
    lines.push_back(std::move(doubt));
  return lines;
}

std::string compositedBefore(const OpaqueFile& picture) {
  const ExrPart& part = picture.document.parts[static_cast<std::size_t>(picture.choice.beautyPart)];
  const std::optional<std::string> method = part.text("pellucid:method");
  if (!method) return "";
  return fmt::format(
      "the picture was composited before (attribute pellucid:method is {}): what is in it already is shown twice if it "
      "is among the layers",
      *method);
}

void expectOneCamera(const Shot& shot, const std::string& path) {
  const GBuffer& gbuffer = shot.opaque.gbuffer;
  if (!gbuffer.camera || shot.scene.cameras.empty()) return;
  if (shot.files && shot.files->moves() && !shot.moment) return;  // it moves, and nobody knows when
  const DepthRange range = rangeOf(gbuffer);
  const double z = range.farthest > 0.0 ? std::sqrt(range.nearest * range.farthest) : 1.0;
  std::string others;
  for (const SceneCamera& each : shot.scene.cameras) {
    Camera camera = cameraOf(each, gbuffer.display, gbuffer.pixelAspect);
    // A perspective camera of a glTF cannot say that its lens is shifted, so that only the file knows.
    if (!camera.orthographic && !gbuffer.camera->orthographic) camera.centre = gbuffer.camera->centre;
    // The eyes of a stereo picture stand to the left and right of the one camera that was exported.
    if (shot.opaque.document.views.size() > 1) camera.viewFromWorld[3].x = gbuffer.camera->viewFromWorld[3].x;
    if (pixelsApart(*gbuffer.camera, camera, gbuffer, z) <= kSamePixels) return;
    others += fmt::format("{}{} as {}", others.empty() ? "" : ", ", viewText(camera), camera.origin);
  }
  throw MeaningError(
      fmt::format("{}: camera: found {} as {}, and {}: expected one camera, or --camera picture for the file's, or "
                  "--camera NAME for the glTF's",
                  path, viewText(*gbuffer.camera), gbuffer.camera->origin, others));
}

}  // namespace pellucid
