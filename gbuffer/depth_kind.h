// What the numbers of a depth channel mean, and how one of them becomes planar metres. For flat pictures and for deep
// samples alike.
#pragma once
#include <optional>
#include <string>

#include "gbuffer/camera.h"
#include "gbuffer/exr_document.h"

namespace pellucid {

enum class DepthMeaning {
  planar,      // distance along the view axis
  ray,         // distance from the eye
  inverse,     // 1 / planar
  device,      // window depth of the camera's clip range
  negative,    // minus planar
  normalised,  // planar, a range of it mapped to 0..1
  evidence,    // what the picture's planes fit
};

struct DepthKind {
  DepthMeaning meaning = DepthMeaning::planar;
  bool reversed = false;               // of device: 1 is at the near plane
  bool inverted = false;               // of normalised: 1 is near
  bool negated = false;                // of ray and inverse: minus that
  double rangeNear = 0, rangeFar = 1;  // of normalised, in the file's unit
  unsigned candidates = 0;             // of evidence: bit 1 << meaning of each
  bool mayBeNegated() const { return meaning == DepthMeaning::ray || meaning == DepthMeaning::inverse; }
  bool mayBe(DepthMeaning one) const {
    return meaning == DepthMeaning::evidence ? ((candidates >> static_cast<int>(one)) & 1u) != 0 : meaning == one;
  }
};

// "planar", "inverse:negative", "normalised:0.5:40:inverted"; "auto" lets the picture choose, "planar|ray" among these.
// Throws UsageError naming all forms.
DepthKind parseDepthKind(const std::string& text);
std::string depthKindForms();                       // for help and messages
std::string depthKindText(const DepthKind& kind);   // as --depth-kind takes it
std::string depthKindWords(const DepthKind& kind);  // "distance along the ray (ray)", for sentences

// Whether converting it takes a camera.
bool needsCamera(const DepthKind& kind);

class DepthConverter {
 public:
  //   far     from which nothing was hit, in the file's numbers; without it what renderers write
  //   unit    metres in one unit of the file
  //   camera  may be null where needsCamera() does not hold; its clip range is read for `device` alone
  //   what    names file and channel, for messages
  // Throws MeaningError when the camera is missing or has no clip range, UsageError for a far value that is none.
  DepthConverter(const DepthKind& kind, PixelType type, std::optional<double> far, double unit, const Camera* camera,
                 const Window& display, const std::string& what);

  // Planar metres, > 0, or +inf where nothing was hit.
  //   x, y  pixels of the display window, (x + 0.5, y + 0.5) at a centre
  double operator()(double value, double x, double y) const;
  // The same without a limit: what is far is far, not nothing. Not above 0 for what lies behind the eye.
  double distance(double value, double x, double y) const;
  double far() const { return far_; }
  const DepthKind& kind() const { return kind_; }
  // Of a file in the same unit whose depth is planar, whatever was said of others.
  DepthConverter planar() const;
  // What an error of 1 in the stored number is of that depth at most, as a part of it: 0 where the number is as exact
  // as the depth, because one goes with the other or with its inverse.
  double stretch(double planarMetres) const;

 private:
  double deviceDistance(double value) const;

  DepthKind kind_;
  double far_, unit_;
  const Camera* camera_;
  Window display_;
};

// Distance from the eye over planar depth at a position of the display window; 1 for orthographic cameras.
double rayOverPlanar(const Camera& camera, const Window& display, double x, double y);

}  // namespace pellucid
