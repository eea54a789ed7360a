// The order-independent sums of one jittered pass, from wherever its layers come: what resolve, `accumulate` and the
// debug layers are made of.
#pragma once
#include "composite/low_resolution.h"
#include "composite/pipeline/painter.h"

namespace pellucid {

// Blended by the device, or added from fragment lists, as the plan says; fog and what is drawn at low resolution are
// in them. Of a flat picture.
OitPlanes sumsOf(const PaintContext& context, const PassSettings& sample);

// Sums of the marked materials over the view, of the plan's tier but for the published one, whose texels are floats.
OitPlanes lowSums(const PaintContext& context, const LowView& view, const PassSettings& sample);
// The same over a deep picture, each of whose samples has sums of its own.
struct PlacedSums {
  OitPlanes places;   // of placesWindow()
  OitPlanes scatter;  // what looks the background up elsewhere, of the picture; empty where nothing does
};
PlacedSums placedSumsOf(const PaintContext& context, const PassSettings& sample, int pass);

// What the lists of a window add to planes of the plan's tier.
void foldInto(const Plan& plan, const FragmentLists& lists, const PassSettings& sample, OitPlanes& planes,
              PublishedClamps& clamps);
OitPlanes emptySums(const Plan& plan, const PassSettings& sample, const Window& display, const Window& data);

// While it lives, the pass draws over a low-resolution view of the picture.
class DrawnOver {
 public:
  DrawnOver(TransparentPass& pass, const LowView& view, const GBuffer& gbuffer, const Camera& camera)
      : pass_(pass), gbuffer_(gbuffer), camera_(camera) {
    pass_.over(view.gbuffer, view.camera);
  }
  ~DrawnOver() { pass_.over(gbuffer_, camera_); }
  DrawnOver(const DrawnOver&) = delete;
  DrawnOver& operator=(const DrawnOver&) = delete;

 private:
  TransparentPass& pass_;
  const GBuffer& gbuffer_;
  const Camera& camera_;
};

// Whether a plan's pass leaves the marked materials to a low-resolution view.
PassSettings fullResolutionPart(const Plan& plan, const PassSettings& sample);
// The others, for the view: fog and deep files are not among them.
PassSettings lowResolutionPart(const PassSettings& sample);

}  // namespace pellucid
