// A shot as one pass sees it: in the pose of the pass's time, from the pass's point of the lens.
#pragma once
#include <memory>
#include <vector>

#include "composite/moving_light.h"
#include "composite/pass_points.h"
#include "composite/pipeline/lighting.h"
#include "composite/pipeline/plan.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid {

// While it lives, it moves the shot itself: its scene, its camera, and what draws it. Afterwards the shot stands as it
// stood. Where neither a shutter nor a lens is open it does nothing at all.
class PassMotion {
 public:
  // All of it must outlive this.
  //   triangles  draws the shot's scene; may be null
  PassMotion(const Request& request, const Plan& plan, const Lens& lens, Shot& shot, TransparentPass* triangles,
             Device& device);
  ~PassMotion();
  PassMotion(const PassMotion&) = delete;
  PassMotion& operator=(const PassMotion&) = delete;

  bool moves() const { return poses_ || lens_.open(); }
  // Also gives the settings the light of that time.
  void moveTo(int pass, PassSettings& sample);
  // The picture as it is lit in the pass; null where that is as in every other.
  const LitPicture* picture() const { return pictureLight_ ? &pictureLight_->picture : nullptr; }
  // Gives the settings the occluders of leaves as they stand now.
  void occlude(const GBuffer& gbuffer, PassSettings& sample);

  // Forgets what relight() has added up: all passes are painted once more.
  void begin() { moving_ = MovingLight(); }
  // Adds up what shadows that move do to the picture behind each pass's veil, and puts it into the mean of the veils.
  //   base  the picture that the mean is composed over
  void relight(const Veil& veil, const GBuffer& base);
  void finish(Veil& mean) const { moving_.finish(mean); }

 private:
  void pose(double seconds);
  void light(PassSettings& sample);

  const Request& request_;
  Lens lens_;
  Shot& shot_;
  TransparentPass* triangles_;
  Device& device_;
  Journal quiet_;  // what every pass would say again
  Shutter shutter_;
  bool poses_ = false;
  Camera taken_;  // of the frame
  Camera posed_;  // of the pass's time, through the middle of the lens
  std::vector<PassPoint> points_;
  // Of the opaque picture, from where it was taken, and of the layers, from where the pass sees them.
  std::shared_ptr<const Lighting> pictureLight_, light_;
  MovingLight moving_;
};

}  // namespace pellucid
