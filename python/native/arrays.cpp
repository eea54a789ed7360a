#include "python/native/arrays.h"

#include <fmt/format.h>

#include <cstring>
#include <limits>

#include "gbuffer/camera_matrices.h"
#include "gbuffer/errors.h"

namespace py = pybind11;

namespace pellucid::python {
namespace {

// Keeps anything that C++ counts alive for Python.
py::capsule capsuleOf(std::shared_ptr<const void> owner) {
  return py::capsule(new std::shared_ptr<const void>(std::move(owner)),
                     [](void* kept) { delete static_cast<std::shared_ptr<const void>*>(kept); });
}

template <class Number, class T>
py::array view(const Image<T>& image, int channels, std::shared_ptr<const void> owner) {
  std::vector<py::ssize_t> shape{image.height(), image.width()};
  if (channels > 1) shape.push_back(channels);
  static_assert(sizeof(T) % sizeof(Number) == 0);
  return py::array_t<Number>(shape, reinterpret_cast<const Number*>(image.data()), capsuleOf(std::move(owner)));
}

template <class T>
Image<T> copyOf(const Floats& array, int channels, std::pair<int, int> size, const char* name) {
  const bool fits = array.ndim() == (channels == 1 ? 2 : 3) && array.shape(0) == size.first &&
                    array.shape(1) == size.second && (channels == 1 || array.shape(2) == channels);
  if (!fits)
    throw UsageError(fmt::format("{}: found another shape, expected ({}, {}{})", name, size.first, size.second,
                                 channels == 1 ? "" : fmt::format(", {}", channels)));
  Image<T> image(size.second, size.first);
  std::memcpy(image.data(), array.data(), image.size() * sizeof(T));
  return image;
}

glm::dmat4 matrixOf(const py::array_t<double>& array, const char* name) {
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4)
    throw UsageError(fmt::format("camera: {}: found {} axes, expected a 4x4 matrix", name, array.ndim()));
  glm::dmat4 matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix[column][row] = array.at(row, column);
  return matrix;
}

}  // namespace

py::array viewOf(const Image<float>& image, std::shared_ptr<const void> owner) {
  return view<float>(image, 1, std::move(owner));
}
py::array viewOf(const Image<std::uint8_t>& image, std::shared_ptr<const void> owner) {
  return view<std::uint8_t>(image, 1, std::move(owner));
}
py::array viewOf(const Image<glm::vec3>& image, std::shared_ptr<const void> owner) {
  return view<float>(image, 3, std::move(owner));
}
py::array viewOf(const Image<glm::vec4>& image, std::shared_ptr<const void> owner) {
  return view<float>(image, 4, std::move(owner));
}

py::dict viewsOf(const std::vector<ExtraLayer>& layers, const std::shared_ptr<const void>& owner) {
  py::dict views;
  for (const ExtraLayer& layer : layers) {
    py::dict channels = views.contains(layer.name.c_str()) ? py::dict(views[layer.name.c_str()]) : py::dict();
    for (const auto& [name, image] : layer.channels) channels[name.c_str()] = viewOf(image, owner);
    views[layer.name.c_str()] = channels;
  }
  return views;
}

std::shared_ptr<MemoryPicture> pictureOf(std::pair<int, int> size, bool hasAlpha, const std::optional<Floats>& normals,
                                         const std::optional<Floats>& occlusion, std::pair<int, int> origin,
                                         std::pair<int, int> display, double pixelAspect) {
  const auto [height, width] = size;
  if (height <= 0 || width <= 0 || display.first <= 0 || display.second <= 0 || !(pixelAspect > 0.0))
    throw UsageError(fmt::format("picture: found {}x{} pixels in a window of {}x{}, expected positive sizes", width,
                                 height, display.first, display.second));
  GBuffer planes;
  planes.beauty = Image<glm::vec4>(width, height, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  planes.viewZ = Image<float>(width, height, std::numeric_limits<float>::infinity());
  planes.hasAlpha = hasAlpha;
  if (normals) planes.normal = copyOf<glm::vec3>(*normals, 3, size, "normals");
  if (occlusion) planes.occlusion = copyOf<float>(*occlusion, 1, size, "occlusion");
  planes.display = {0, 0, display.first, display.second};
  planes.data = {origin.first, origin.second, origin.first + width, origin.second + height};
  planes.pixelAspect = pixelAspect;
  return std::make_shared<MemoryPicture>(std::move(planes));
}

py::array colourOf(const std::shared_ptr<MemoryPicture>& picture) {
  return py::array_t<float>({picture->height(), picture->width(), 4}, &picture->beauty()->x, capsuleOf(picture));
}

py::array depthOf(const std::shared_ptr<MemoryPicture>& picture) {
  return py::array_t<float>({picture->height(), picture->width()}, picture->viewZ(), capsuleOf(picture));
}

Camera cameraOf(const py::array_t<double>& viewFromWorld, const py::array_t<double>& clipFromView) {
  return cameraFromMatrices(matrixOf(viewFromWorld, "view from world"), matrixOf(clipFromView, "clip from view"));
}

}  // namespace pellucid::python
