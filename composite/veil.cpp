#include "composite/veil.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace pellucid {

Veil::Veil(int width, int height)
    : light(width, height, glm::vec3(0.0f)),
      transmission(width, height, glm::vec3(1.0f)),
      frontZ(width, height, std::numeric_limits<float>::infinity()),
      touched(width, height, 0) {}

void Veil::addScatter() {
  if (scatters()) return;
  direct = transmission;
  applied = Image<glm::vec4>(transmission.width(), transmission.height(), glm::vec4(0.0f));
}

void VeilMean::add(Veil sample) {
  ++count_;
  if (count_ == 1) {
    sum_ = std::move(sample);
    return;
  }
  if (sample.scatters()) sum_.addScatter();
  if (sum_.scatters())
    for (std::size_t i = 0; i < sum_.touched.size(); ++i) {
      sum_.direct[i] += sample.scatters() ? sample.direct[i] : sample.transmission[i];
      if (sample.scatters()) sum_.applied[i] += sample.applied[i];
    }
  for (std::size_t i = 0; i < sum_.touched.size(); ++i) {
    sum_.light[i] += sample.light[i];
    sum_.transmission[i] += sample.transmission[i];
    sum_.frontZ[i] = std::min(sum_.frontZ[i], sample.frontZ[i]);
    sum_.touched[i] |= sample.touched[i];
  }
}

Veil VeilMean::finish() {
  if (count_ == 0) throw std::logic_error("VeilMean: no sample was added");
  Veil mean = std::move(sum_);
  const float share = 1.0f / static_cast<float>(count_);
  if (count_ > 1)
    for (std::size_t i = 0; i < mean.touched.size(); ++i) {
      mean.light[i] *= share;
      mean.transmission[i] *= share;
    }
  if (count_ > 1 && mean.scatters())
    for (std::size_t i = 0; i < mean.touched.size(); ++i) {
      mean.direct[i] *= share;
      mean.applied[i] *= share;
    }
  count_ = 0;
  return mean;
}

}  // namespace pellucid
