#include "composite/pipeline/pass_motion.h"

#include <algorithm>

#include "composite/pipeline/foliage_step.h"
#include "engine_bridge/scene/working_space.h"
#include "gbuffer/camera_match.h"

namespace pellucid {
namespace {

// Positions in a pixel at which one pass asks for the shadows on the picture: the passes are many.
constexpr int kShadowSamples = 4;

}  // namespace

PassMotion::PassMotion(const Request& request, const Plan& plan, const Lens& lens, Shot& shot,
                       TransparentPass* triangles, Device& device)
    : request_(request),
      lens_(lens),
      shot_(shot),
      triangles_(triangles),
      device_(device),
      shutter_(plan.shutter.value_or(Shutter())),
      poses_(shutter_.opens() && shot.moment && shot.files && shot.files->moves()),
      taken_(shot.camera),
      posed_(shot.camera),
      points_(passPoints(plan.passes)) {}

PassMotion::~PassMotion() {
  if (!moves()) return;
  try {
    shot_.camera = taken_;
    if (poses_) pose(shot_.moment->seconds);
    if (triangles_) triangles_->pose(taken_);
  } catch (...) {
    // The file has changed on the disk since the passes read it: whoever poses the shot next is told.
  }
}

void PassMotion::pose(double seconds) {
  const std::vector<int> read = shot_.files->pose(seconds);
  bringInto(shot_.scene, shot_.opaque.space.fromRec709, &read);
}

void PassMotion::moveTo(int pass, PassSettings& sample) {
  if (!moves()) return;
  const PassPoint& point = points_[static_cast<std::size_t>(pass)];
  if (poses_) {
    pose(shot_.moment->at(shutter_.open + (shutter_.close - shutter_.open) * point.time));
    if (shot_.sceneCamera && !shutter_.holdsCamera)
      posed_ = chooseCamera(request_.shot.camera, shot_.opaque.gbuffer, shot_.scene, request_.shot.opaque);
  }
  shot_.camera = throughLens(posed_, lens_, lensPoint(point.lens, lens_.blades));
  if (triangles_) triangles_->pose(shot_.camera);
  light(sample);
}

void PassMotion::light(PassSettings& sample) {
  Request request = request_;
  request.passes = std::min(request.passes, kShadowSamples);
  request.shadows.views.clear();
  light_.reset();
  pictureLight_.reset();
  if (poses_ && request.shadows.on()) {
    const Camera from = shot_.camera;
    shot_.camera = taken_;
    pictureLight_ = lightShot(request, shot_, device_, quiet_);
    shot_.camera = from;
    if (sameView(from, taken_)) light_ = pictureLight_;
  }
  if (!light_) light_ = lightShot(request, shot_, device_, quiet_);
  light_->applyTo(sample, shot_);
}

void PassMotion::occlude(const GBuffer& gbuffer, PassSettings& sample) {
  if (!moves() || !triangles_) return;
  sample.occlusion.occluders = nullptr;
  placeOccluders(request_.foliage, sample, *triangles_, gbuffer, shot_.camera, quiet_);
}

void PassMotion::relight(const Veil& veil, const GBuffer& base) {
  moving_.add(veil, picture() ? &picture()->gbuffer->beauty : nullptr, base.beauty);
}

}  // namespace pellucid
