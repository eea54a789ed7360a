// What lies over a picture as arrays of its size.
#pragma once
#include <pybind11/numpy.h>

#include <optional>

#include "composite/veil.h"

namespace pellucid::python {

// The pipeline paints where layers may be, and a veil may be a small part of the picture. A plane of all of it is made
// when it is first asked for; one that is whole already is handed out as it lies. Under Python's lock.
class VeilPlanes {
 public:
  //   data  the picture's window
  VeilPlanes(Veil veil, const Window& data) : veil_(std::move(veil)), data_(data) {}
  pybind11::array light();
  pybind11::array transmission();
  pybind11::array frontDepth();

 private:
  template <class T>
  pybind11::array whole(std::optional<pybind11::array>& plane, Image<T>& part, T nothing) const;
  Veil veil_;
  Window data_;
  std::optional<pybind11::array> light_, transmission_, frontDepth_;
};

// Its class in the module, `VeilPlanes`.
void addVeilPlanes(pybind11::module_& module);

}  // namespace pellucid::python
