#include "composite/pipeline/pass_picture.h"

namespace pellucid {

PassPicture::PassPicture(const LitPicture& centres, const DepthPlanes* planes, TransparentPass* triangles,
                         const Camera& camera)
    : centres_(centres), planes_(planes), triangles_(triangles), camera_(camera), picture_(centres) {
  if (!planes_) return;
  moved_ = *centres.gbuffer;
  picture_.gbuffer = &moved_;
}

PassPicture::~PassPicture() {
  if (planes_ && triangles_) triangles_->over(*centres_.gbuffer, camera_);
}

void PassPicture::moveTo(glm::dvec2 sample) {
  if (!planes_) return;
  planes_->depthAt(sample, moved_.viewZ);
  if (triangles_) triangles_->over(moved_, camera_);
}

}  // namespace pellucid
