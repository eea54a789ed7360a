#include "composite/veil.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

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

Veil::Veil(const Window& part, const Window& data) : Veil(part.width(), part.height()) {
  place = glm::ivec2(part.x0 - data.x0, part.y0 - data.y0);
}

namespace {

template <class Texel>
Image<Texel> rowsOf(const Image<Texel>& all, int y0, int y1) {
  if (all.empty()) return {};
  Image<Texel> rows(all.width(), y1 - y0);
  std::copy(all.row(y0), all.row(y0) + rows.size(), rows.data());
  return rows;
}

template <class Texel>
void copyInto(const Image<Texel>& from, glm::ivec2 place, Image<Texel>& to) {
  for (int y = 0; y < from.height(); ++y)
    std::copy(from.row(y), from.row(y) + from.width(), to.row(place.y + y) + place.x);
}

// Calls work(begin, end) for parts of all pixels of a veil.
template <class Work>
void overPixels(const Veil& veil, const Work& work) {
  constexpr std::size_t kGrain = 16384;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, veil.touched.size(), kGrain),
                    [&](const tbb::blocked_range<std::size_t>& pixels) { work(pixels.begin(), pixels.end()); });
}

}  // namespace

Veil rowsOf(const Veil& veil, int y0, int y1) {
  Veil rows;
  rows.place = veil.place + glm::ivec2(0, y0);
  rows.light = rowsOf(veil.light, y0, y1);
  rows.transmission = rowsOf(veil.transmission, y0, y1);
  rows.frontZ = rowsOf(veil.frontZ, y0, y1);
  rows.touched = rowsOf(veil.touched, y0, y1);
  rows.direct = rowsOf(veil.direct, y0, y1);
  rows.applied = rowsOf(veil.applied, y0, y1);
  return rows;
}

Veil widened(Veil veil, const Window& data) {
  if (veil.touched.width() == data.width() && veil.touched.height() == data.height()) return veil;
  Veil wide(data.width(), data.height());
  copyInto(veil.light, veil.place, wide.light);
  copyInto(veil.transmission, veil.place, wide.transmission);
  copyInto(veil.frontZ, veil.place, wide.frontZ);
  copyInto(veil.touched, veil.place, wide.touched);
  if (!veil.scatters()) return wide;
  wide.addScatter();
  copyInto(veil.direct, veil.place, wide.direct);
  copyInto(veil.applied, veil.place, wide.applied);
  return wide;
}

void VeilMean::add(Veil sample) {
  ++count_;
  if (count_ == 1) {
    sum_ = std::move(sample);
    return;
  }
  if (sample.touched.size() != sum_.touched.size() || sample.place != sum_.place)
    throw std::logic_error("VeilMean: samples of different parts of a picture");
  if (sample.scatters()) sum_.addScatter();
  overPixels(sum_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && sum_.scatters(); ++i) {
      sum_.direct[i] += sample.scatters() ? sample.direct[i] : sample.transmission[i];
      if (sample.scatters()) sum_.applied[i] += sample.applied[i];
    }
    for (std::size_t i = begin; i < end; ++i) {
      sum_.light[i] += sample.light[i];
      sum_.transmission[i] += sample.transmission[i];
      sum_.frontZ[i] = std::min(sum_.frontZ[i], sample.frontZ[i]);
      sum_.touched[i] |= sample.touched[i];
    }
  });
}

void VeilMean::begin(const Veil& sample) {
  ++count_;
  if (count_ == 1) {
    sum_ = Veil(sample.touched.width(), sample.touched.height());
    sum_.place = sample.place;
  }
  if (sample.touched.size() != sum_.touched.size() || sample.place != sum_.place)
    throw std::logic_error("VeilMean: samples of different parts of a picture");
}

void VeilMean::addRows(const Veil& rows) {
  if (rows.scatters()) sum_.addScatter();
  const bool first = count_ == 1;  // which is taken as it is: -0 stays
  const auto put = [first](auto& sum, const auto& more) { sum = first ? more : sum + more; };
  const std::size_t from =
      static_cast<std::size_t>(rows.place.y - sum_.place.y) * static_cast<std::size_t>(sum_.touched.width());
  overPixels(rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t to = from + i;
      if (sum_.scatters()) put(sum_.direct[to], rows.scatters() ? rows.direct[i] : rows.transmission[i]);
      if (rows.scatters()) put(sum_.applied[to], rows.applied[i]);
      put(sum_.light[to], rows.light[i]);
      put(sum_.transmission[to], rows.transmission[i]);
      sum_.frontZ[to] = std::min(first ? rows.frontZ[i] : sum_.frontZ[to], rows.frontZ[i]);
      sum_.touched[to] |= rows.touched[i];
    }
  });
}

Veil VeilMean::finish() {
  if (count_ == 0) throw std::logic_error("VeilMean: no sample was added");
  Veil mean = std::move(sum_);
  const float share = 1.0f / static_cast<float>(count_);
  if (count_ > 1)
    overPixels(mean, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        mean.light[i] *= share;
        mean.transmission[i] *= share;
      }
      for (std::size_t i = begin; i < end && mean.scatters(); ++i) {
        mean.direct[i] *= share;
        mean.applied[i] *= share;
      }
    });
  count_ = 0;
  return mean;
}

}  // namespace pellucid
