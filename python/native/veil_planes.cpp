#include "python/native/veil_planes.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "python/native/arrays.h"

namespace py = pybind11;

namespace pellucid::python {

//   nothing  the value where no part of the veil lies
template <class T>
py::array VeilPlanes::whole(std::optional<py::array>& plane, Image<T>& part, T nothing) const {
  if (plane) return *plane;
  Image<T> image = std::exchange(part, Image<T>());
  if (image.width() != data_.width() || image.height() != data_.height()) {
    Image<T> wide(data_.width(), data_.height(), nothing);
    for (int y = 0; y < image.height(); ++y)
      std::copy(image.row(y), image.row(y) + image.width(), wide.row(veil_.place.y + y) + veil_.place.x);
    image = std::move(wide);
  }
  plane = arrayOf(std::move(image));
  return *plane;
}

py::array VeilPlanes::light() {
  return whole(light_, veil_.light, glm::vec3(0.0f));
}

py::array VeilPlanes::transmission() {
  return whole(transmission_, veil_.transmission, glm::vec3(1.0f));
}

py::array VeilPlanes::frontDepth() {
  return whole(frontDepth_, veil_.frontZ, std::numeric_limits<float>::infinity());
}

void addVeilPlanes(py::module_& module) {
  py::class_<VeilPlanes>(module, "VeilPlanes")
      .def_property_readonly("light", &VeilPlanes::light)
      .def_property_readonly("transmission", &VeilPlanes::transmission)
      .def_property_readonly("front_depth", &VeilPlanes::frontDepth);
}

}  // namespace pellucid::python
