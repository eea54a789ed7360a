// Images as NumPy arrays and arrays as images, without a copy: each shows the other's memory, and keeps it alive.
#pragma once
#include <pybind11/numpy.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gbuffer/gbuffer.h"
#include "gbuffer/opaque_io.h"

namespace pellucid::python {

// An array of (height, width) or (height, width, channels) that has the image's pixels for its own.
pybind11::array arrayOf(Image<float> image);
pybind11::array arrayOf(Image<std::uint8_t> image);
pybind11::array arrayOf(Image<glm::vec3> image);
pybind11::array arrayOf(Image<glm::vec4> image);
// {layer: {channel: array}}
pybind11::dict arraysOf(std::vector<ExtraLayer> layers);

// An array of another type or layout is converted on the way, once.
using Floats = pybind11::array_t<float, pybind11::array::c_style | pybind11::array::forcecast>;

// How a picture's arrays lie.
struct Framing {
  std::pair<int, int> origin;   // x, y of the first pixel in the display window
  std::pair<int, int> display;  // width, height of that window
  double pixelAspect = 1.0;
};

// An opaque picture whose planes are the arrays, which live as long as it does. Throws UsageError for shapes that do
// not fit.
//   colour     (height, width, 4)
//   depth      (height, width)
//   hasAlpha   the fourth channel is one of the picture; else it is 1
//   normals    (height, width, 3), world; or none
//   occlusion  (height, width), [0,1], 1 is open; or none
std::shared_ptr<GBuffer> pictureOf(const Floats& colour, const Floats& depth, bool hasAlpha,
                                   const std::optional<Floats>& normals, const std::optional<Floats>& occlusion,
                                   const Framing& framing);

// 4x4 matrices of column vectors, as NumPy writes them: p' = M @ p. Throws
// UsageError.
Camera cameraOf(const pybind11::array_t<double>& viewFromWorld, const pybind11::array_t<double>& clipFromView);

}  // namespace pellucid::python
