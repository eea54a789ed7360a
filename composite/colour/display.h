// Pictures as a display shows them, by a config's displays and views.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "composite/colour/config.h"
#include "gbuffer/image.h"

namespace pellucid {

struct DisplayChoice {
  std::string display, view;  // "": the config's first
  double exposure = 0.0;      // stops
  std::string look = {};      // in the place of the view's own; "": the view's
};

// A table that a shader looks up, row by row from (0, 0, 0).
struct ShaderTable {
  std::string sampler;                   // its name in the text
  int width = 1, height = 1, depth = 0;  // depth 0: a two-dimensional texture
  int channels = 3;                      // 1 or 3
  bool linear = true;                    // texels between are interpolated
  std::vector<float> values = {};
};

// What a display is shown, for a device: OpenColorIO's own text, GLSL ES 3.0.
struct DisplayShader {
  std::string title;  // "display sRGB, view sRGB"
  std::string text;   // vec4 shown(vec4): scene-linear to what the display is sent, not clipped
  std::vector<ShaderTable> tables;
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
  // The same steps. Throws InputError for a config whose steps have no shader.
  DisplayShader shader() const;
  std::string title() const { return title_; }  // "display sRGB, view sRGB, exposure 0"

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::string names_, title_;
};

// Throws as the constructor above.
void checkDisplay(const ColourConfig& config, const DisplayChoice& choice);

// 8 bits a channel, rounded to nearest, written beside the file and renamed. Throws ResourceError.
void writePng(const std::string& path, const Image<glm::vec3>& shown);

}  // namespace pellucid
