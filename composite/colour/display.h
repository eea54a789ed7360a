// Pictures as a display shows them, by a config's displays and views.
#pragma once
#include <glm/glm.hpp>

#include "composite/colour/config.h"
#include "gbuffer/image.h"

namespace pellucid {

struct DisplayChoice {
  std::string display, view;  // "": the config's first
  double exposure = 0.0;      // stops
  std::string look = {};      // in the place of the view's own; "": the view's
};

class DisplayTransform {
 public:
  // Throws UsageError for a display, a view or a look that the config does not have.
  //   space  of the pictures
  DisplayTransform(const ColourConfig& config, const DisplayChoice& choice, const ColourSpace& space);
  ~DisplayTransform();
  DisplayTransform(DisplayTransform&&) noexcept;

  // Scene-linear to what the display is sent, clipped to [0,1]; what is no number is black.
  void apply(Image<glm::vec3>& picture) const;
  std::string title() const { return title_; }  // "display sRGB, view sRGB, exposure 0"

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::string title_;
};

// Throws as the constructor above.
void checkDisplay(const ColourConfig& config, const DisplayChoice& choice);

// 8 bits a channel, rounded to nearest, written beside the file and renamed. Throws ResourceError.
void writePng(const std::string& path, const Image<glm::vec3>& shown);

}  // namespace pellucid
