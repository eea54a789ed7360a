// Where the picture was taken from. View space is right-handed, y up, looking down -z (glTF, GL).
#pragma once
#include <glm/glm.hpp>
#include <string>

#include "gbuffer/image.h"

namespace pellucid {

struct Camera {
  glm::dmat4 viewFromWorld{1.0};  // column vectors, metres; no scale, no shear
  bool orthographic = false;
  // Perspective: NDC = focal * (x, y) / z + centre. Orthographic: NDC = focal * (x, y) + centre. z = -view.z.
  // NDC is -1..1 over the EXR *display* window, y up.
  glm::dvec2 focal{1.0, 1.0};
  glm::dvec2 centre{0.0, 0.0};
  double rangeNear = 0.0, rangeFar = 0.0;  // the renderer's clip range where it is known, else 0
  std::string origin;                      // "attribute worldToCamera", "glTF node cam", "--camera"
};

// NDC of the data window (what GL's viewport covers) from view space; reversed z with an infinite far plane:
// clip.z / clip.w = kClipNear / z for perspective, and the same from z for orthographic is left to gl_FragDepth.
//   sample  where in the pixel the sample lies, (0.5, 0.5) the centre, y down
glm::dmat4 clipFromView(const Camera& camera, const Window& display, const Window& data, glm::dvec2 sample);
constexpr double kClipNear = 1e-7;  // metres; reversed z loses nothing by it

// Pixel position in the display window's coordinates, (x + 0.5, y + 0.5) at a pixel's centre, y down, and planar z.
struct Projected {
  glm::dvec2 pixel;
  double z;  // planar metres, > 0 in front
};
Projected project(const Camera& camera, const Window& display, glm::dvec3 world);

// EXR's attributes: row vectors, left-handed, +z forward; worldToNDC has (0,0) at the top left of the display window
// and (1,1) at its bottom right. Throws MeaningError when the two do not describe one pinhole or orthographic camera.
//   worldToCamera, worldToNdc  M44f as stored, row major
Camera cameraFromExr(const glm::dmat4& worldToCameraRows, const glm::dmat4& worldToNdcRows, const std::string& file);
// The same two, from a camera: [0] worldToCamera, [1] worldToNDC, in EXR's row-vector layout.
void cameraToExr(const Camera& camera, float worldToCamera[4][4], float worldToNdc[4][4]);

// F_px, focal length in pixels. MODEL, Symbols
double focalPixels(const Camera& camera, const Window& display);

}  // namespace pellucid
