// Images as NumPy arrays, which show the image's own memory.
#pragma once
#include <pybind11/numpy.h>

#include <memory>
#include <optional>
#include <string>

#include "composite/pipeline/memory_picture.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/opaque_io.h"

namespace pellucid::python {

// Arrays of (height, width) or (height, width, channels) that read and write
// the image's own memory.
//   owner  keeps the image alive as long as an array does
pybind11::array viewOf(const Image<float>& image, std::shared_ptr<const void> owner);
pybind11::array viewOf(const Image<std::uint8_t>& image, std::shared_ptr<const void> owner);
pybind11::array viewOf(const Image<glm::vec3>& image, std::shared_ptr<const void> owner);
pybind11::array viewOf(const Image<glm::vec4>& image, std::shared_ptr<const void> owner);
// {layer: {channel: array}}
pybind11::dict viewsOf(const std::vector<ExtraLayer>& layers, const std::shared_ptr<const void>& owner);

using Floats = pybind11::array_t<float, pybind11::array::c_style | pybind11::array::forcecast>;

// A picture in memory, black and with nothing hit. Throws UsageError for shapes that do not fit.
//   size       height, width
//   normals    (height, width, 3), world; or none
//   occlusion  (height, width), [0,1], 1 is open; or none
//   origin     x, y of the first pixel in the display window
//   display    width, height of that window
std::shared_ptr<MemoryPicture> pictureOf(std::pair<int, int> size, bool hasAlpha, const std::optional<Floats>& normals,
                                         const std::optional<Floats>& occlusion, std::pair<int, int> origin,
                                         std::pair<int, int> display, double pixelAspect);
// Its colours, (height, width, 4), and depths, (height, width), to render into.
pybind11::array colourOf(const std::shared_ptr<MemoryPicture>& picture);
pybind11::array depthOf(const std::shared_ptr<MemoryPicture>& picture);

// 4x4 matrices of column vectors, as NumPy writes them: p' = M @ p. Throws
// UsageError.
Camera cameraOf(const pybind11::array_t<double>& viewFromWorld, const pybind11::array_t<double>& clipFromView);

}  // namespace pellucid::python
