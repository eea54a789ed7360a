// Depth of field: what of a lens is asked for, and the camera that each pass sees the shot through.
#pragma once
#include <optional>

#include "composite/pipeline/journal.h"
#include "gbuffer/exr_document.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

struct LensRequest {
  std::optional<double> radius;       // --lens-radius, metres
  std::optional<double> fStop;        // --f-stop: radius = focal length / (2 N)
  std::optional<double> focalLength;  // --focal-length, millimetres; else the header's
  std::optional<double> focus;        // --focus METRES, planar
  bool autoFocus = false;             // --focus auto
  int blades = 0;                     // --lens-blades; 0 is round
  bool on() const { return radius || fStop; }
};

// Throws UsageError for what contradicts itself, or says how a lens is without one.
void checkLens(const LensRequest& request);

struct Lens {
  double radius = 0.0;  // metres
  double focus = 1.0;   // planar metres
  int blades = 0;
  bool open() const { return radius > 0.0; }
};

// Notes what was inferred. Throws MeaningError where nothing says what is needed, or the camera is orthographic.
Lens lensOf(const LensRequest& request, const ExrDocument& document, const GBuffer& gbuffer, const Camera& camera,
            Journal& journal);

// The pinhole at a point of the lens, its picture shifted so that what is in focus stays where it is.
//   point  on an aperture of radius 1, x to the right and y up
Camera throughLens(const Camera& camera, const Lens& lens, glm::dvec2 point);

}  // namespace pellucid
