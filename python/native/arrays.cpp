#include "python/native/arrays.h"

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <utility>

#include "gbuffer/camera_matrices.h"
#include "gbuffer/errors.h"

namespace py = pybind11;

namespace pellucid::python {
namespace {

// The array's capsule holds the image, and so the pixels where they are.
template <class Number, class T>
py::array holding(Image<T> image, int channels) {
  static_assert(sizeof(T) % sizeof(Number) == 0);
  auto held = std::make_unique<Image<T>>(std::move(image));
  std::vector<py::ssize_t> shape{held->height(), held->width()};
  if (channels > 1) shape.push_back(channels);
  const auto* first = reinterpret_cast<const Number*>(held->data());
  const py::capsule owner(held.get(), [](void* kept) { delete static_cast<Image<T>*>(kept); });
  held.release();
  return py::array_t<Number>(shape, first, owner);
}

// Keeps the array for C++, which lets go of it on any thread, with Python's lock or without.
std::shared_ptr<const void> kept(const Floats& array) {
  return std::shared_ptr<const void>(py::object(array).release().ptr(), [](const void* object) {
    const py::gil_scoped_acquire locked;
    py::handle(static_cast<PyObject*>(const_cast<void*>(object))).dec_ref();
  });
}

template <class T>
Image<T> shownBy(const Floats& array, int channels, std::pair<py::ssize_t, py::ssize_t> size, const char* name) {
  static_assert(sizeof(T) % sizeof(float) == 0 && alignof(T) == alignof(float));
  const bool fits = array.ndim() == (channels == 1 ? 2 : 3) && array.shape(0) == size.first &&
                    array.shape(1) == size.second && (channels == 1 || array.shape(2) == channels);
  if (!fits)
    throw UsageError(fmt::format("{}: found another shape, expected ({}, {}{})", name, size.first, size.second,
                                 channels == 1 ? "" : fmt::format(", {}", channels)));
  return Image<T>::borrowed(static_cast<int>(size.second), static_cast<int>(size.first),
                            reinterpret_cast<const T*>(array.data()), kept(array));
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

py::array arrayOf(Image<float> image) {
  return holding<float>(std::move(image), 1);
}
py::array arrayOf(Image<std::uint8_t> image) {
  return holding<std::uint8_t>(std::move(image), 1);
}
py::array arrayOf(Image<glm::vec3> image) {
  return holding<float>(std::move(image), 3);
}
py::array arrayOf(Image<glm::vec4> image) {
  return holding<float>(std::move(image), 4);
}

py::dict arraysOf(std::vector<ExtraLayer> layers) {
  py::dict arrays;
  for (ExtraLayer& layer : layers) {
    py::dict channels = arrays.contains(layer.name.c_str()) ? py::dict(arrays[layer.name.c_str()]) : py::dict();
    for (auto& [name, image] : layer.channels) channels[name.c_str()] = arrayOf(std::move(image));
    arrays[layer.name.c_str()] = channels;
  }
  return arrays;
}

std::shared_ptr<GBuffer> pictureOf(const Floats& colour, const Floats& depth, bool hasAlpha,
                                   const std::optional<Floats>& normals, const std::optional<Floats>& occlusion,
                                   const Framing& framing) {
  if (colour.ndim() != 3) throw UsageError("colour: found another shape, expected (height, width, 4)");
  const std::pair<py::ssize_t, py::ssize_t> size{colour.shape(0), colour.shape(1)};
  const auto [height, width] = size;
  constexpr py::ssize_t kMost = std::numeric_limits<int>::max() / 2;
  const bool framed = framing.display.first > 0 && framing.display.second > 0 && framing.pixelAspect > 0.0;
  if (height <= 0 || width <= 0 || height > kMost || width > kMost || !framed)
    throw UsageError(fmt::format("picture: found {}x{} pixels in a window of {}x{}, expected positive sizes", width,
                                 height, framing.display.first, framing.display.second));
  const auto planes = std::make_shared<GBuffer>();
  planes->beauty = shownBy<glm::vec4>(colour, 4, size, "colour");
  planes->viewZ = shownBy<float>(depth, 1, size, "depth");
  planes->hasAlpha = hasAlpha;
  if (normals) planes->normal = shownBy<glm::vec3>(*normals, 3, size, "normals");
  if (occlusion) planes->occlusion = shownBy<float>(*occlusion, 1, size, "occlusion");
  const auto [x, y] = framing.origin;
  planes->display = {0, 0, framing.display.first, framing.display.second};
  planes->data = {x, y, x + static_cast<int>(width), y + static_cast<int>(height)};
  planes->pixelAspect = framing.pixelAspect;
  return planes;
}

Camera cameraOf(const py::array_t<double>& viewFromWorld, const py::array_t<double>& clipFromView) {
  return cameraFromMatrices(matrixOf(viewFromWorld, "view from world"), matrixOf(clipFromView, "clip from view"));
}

}  // namespace pellucid::python
