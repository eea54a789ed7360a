// Where the planes of shaders/plane_layout.h lie in the records, number by number.
#pragma once
#include <cstddef>

#include "gbuffer/accum.h"
#include "gbuffer/rim_planes.h"
#include "shaders/plane_layout.h"

namespace pellucid {

// One component of a plane, whatever image it is part of.
template <class Number>
struct StridedValues {
  Number* first = nullptr;  // of the top left pixel
  std::size_t stride = 0;   // numbers from one pixel to the next, row by row

  explicit operator bool() const { return first != nullptr; }
  Number& operator[](std::size_t pixel) const { return first[pixel * stride]; }
};
using PlaneValues = StridedValues<float>;
using ConstPlaneValues = StridedValues<const float>;

// Nowhere when the record does not hold it. Sums lie unpacked, whatever the layers are.
PlaneValues valuesOf(OitPlanes& planes, PlaneSum sum, int component);
PlaneValues valuesOf(RimPlanes& planes, PlaneSum sum, int component);
ConstPlaneValues valuesOf(const OitPlanes& planes, PlaneSum sum, int component);
ConstPlaneValues valuesOf(const RimPlanes& planes, PlaneSum sum, int component);

// Adds what a layer adds to the sums of one pixel.
void addSums(OitPlanes& planes, int x, int y, const shading::OitTargets& sums);

}  // namespace pellucid
