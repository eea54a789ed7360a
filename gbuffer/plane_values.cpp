#include "gbuffer/plane_values.h"

namespace pellucid {
namespace {

template <class Vector>
PlaneValues componentOf(Image<Vector>& image, int component) {
  if (image.empty()) return {};
  return {&(*image.data())[component], static_cast<std::size_t>(Vector::length())};
}

PlaneValues scalarsOf(Image<float>& image) {
  return image.empty() ? PlaneValues{} : PlaneValues{image.data(), 1};
}

}  // namespace

PlaneValues valuesOf(OitPlanes& planes, PlaneSum sum, int component) {
  const auto added = static_cast<std::size_t>(sum);
  if (added < kAddedSums) return componentOf(*planes.sums()[added], component);
  switch (sum) {
    case PlaneSum::nearestZ:
      return scalarsOf(component == 0 ? planes.frontZ : planes.diffuseZ);
    case PlaneSum::solid:
      return componentOf(planes.solid, component);
    default:
      return {};
  }
}

ConstPlaneValues valuesOf(const OitPlanes& planes, PlaneSum sum, int component) {
  const PlaneValues values = valuesOf(const_cast<OitPlanes&>(planes), sum, component);  // only looked at
  return {values.first, values.stride};
}

void addSums(OitPlanes& planes, int x, int y, const shading::OitTargets& sums) {
  planes.radiance.at(x, y) += sums.radiance;
  planes.weight.at(x, y) += sums.weight;
  planes.opacity.at(x, y) += sums.opacity;
  planes.depth.at(x, y) += sums.depth;
  planes.light.at(x, y) += sums.light;
}

PlaneValues valuesOf(RimPlanes& planes, PlaneSum sum, int component) {
  switch (sum) {
    case PlaneSum::rimAveraged:
      return componentOf(planes.averaged, component);
    case PlaneSum::rimAdded:
      return componentOf(planes.added, component);
    case PlaneSum::rimGradient:
      return componentOf(planes.gradient, component);
    default:
      return {};
  }
}

ConstPlaneValues valuesOf(const RimPlanes& planes, PlaneSum sum, int component) {
  const PlaneValues values = valuesOf(const_cast<RimPlanes&>(planes), sum, component);  // only looked at
  return {values.first, values.stride};
}

}  // namespace pellucid
