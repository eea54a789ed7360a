#include "composite/pipeline/pass_picture.h"

#include <algorithm>

#include "gbuffer/camera_match.h"
#include "gbuffer/moved_depth.h"

namespace pellucid {

PassPicture::PassPicture(const LitPicture& centres, const DepthPlanes* planes, const EdgePasses* edges,
                         TransparentPass* triangles, const Camera& camera, const Window& area)
    : centres_(centres),
      planes_(planes),
      edges_(edges),
      triangles_(triangles),
      taken_(camera),
      camera_(camera),
      picture_(centres) {
  if (!planes_) return;
  const GBuffer& own = *centres.gbuffer;
  part_ = {area.x0 - own.data.x0, area.y0 - own.data.y0, area.x1 - own.data.x0, area.y1 - own.data.y0};
  moved_.display = own.display;
  moved_.data = own.data;
  moved_.pixelAspect = own.pixelAspect;
  moved_.hasAlpha = own.hasAlpha;
  moved_.viewZ = own.viewZ;
  moved_.depthPrecision = own.depthPrecision;
  moved_.camera = own.camera;
  picture_.gbuffer = &moved_;
  if (centres.deepOpaque) {
    samplePlanes_.emplace(*centres.deepOpaque, camera.orthographic);
    movedDeep_ = *centres.deepOpaque;
    picture_.deepOpaque = &movedDeep_;
  }
  if (!edges_ || edges_->empty()) return;
  passWeight_ = Image<float>(moved_.data.width(), moved_.data.height(), 1.0f);
  picture_.passWeight = &passWeight_;
  picture_.edges = &edgeTexels_;
}

PassPicture::~PassPicture() {
  if (planes_ && triangles_) triangles_->over(*centres_.gbuffer, camera_);
}

void PassPicture::moveDepth(glm::dvec2 sample) {
  Image<std::uint8_t> unseen;
  const bool counts = !unseen_.empty();
  depthFrom(*planes_, *centres_.gbuffer, taken_, camera_, sample, moved_.viewZ, counts ? &unseen : nullptr);
  for (std::size_t i = 0; i < unseen.size(); ++i) unseen_[i] += unseen[i];
}

Image<float> PassPicture::unseenShare() const {
  Image<float> share(unseen_.width(), unseen_.height(), 0.0f);
  for (std::size_t i = 0; i < share.size(); ++i)
    share[i] = static_cast<float>(static_cast<double>(unseen_[i]) / std::max(counted_, 1));
  return share;
}

void PassPicture::moveTo(glm::dvec2 sample, int pass, const LitPicture* lit) {
  if (lit) {
    picture_.centres = lit->centres;
    if (samplePlanes_)
      movedDeep_ = *lit->deepOpaque;
    else
      picture_.deepOpaque = lit->deepOpaque;
    if (planes_)
      moved_.beauty = lit->gbuffer->beauty.shown(nullptr);
    else
      picture_.gbuffer = lit->gbuffer;
  }
  ++counted_;
  if (!planes_) return;
  picture_.planes = nullptr;
  if (samplePlanes_) {
    samplePlanes_->moveTo(sample, movedDeep_);
    moved_.viewZ = movedDeep_.farthest;
  } else if (sameView(camera_, taken_)) {
    planes_->depthAt(sample, part_, moved_.viewZ);
    picture_.planes = planes_;
  } else {
    moveDepth(sample);
  }
  if (edges_) {
    edges_->depthAt(pass, moved_.viewZ);
    if (picture_.passWeight) edges_->weightAt(pass, passWeight_);
    if (picture_.edges) edgeTexels_ = edges_->texelsOf(pass, picture_.centres->beauty);
  }
  if (triangles_) triangles_->over(moved_, camera_);
}

}  // namespace pellucid
