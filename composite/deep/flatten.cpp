#include "composite/deep/flatten.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

struct Source {
  DeepChannels channels;
  std::unique_ptr<DeepReader> reader;
  DeepRows rows;
};

// Where a sample lies in depth and in the rows: what is sorted.
struct Place {
  float z;
  std::uint32_t index;
};

// Composites pixels of points whose depths differ, the common case, without making records of them.
class PointPixel {
 public:
  PointPixel(const DeepChannels& channels, const DeepRows& rows) : zBack_(channels.zBack) {
    z_ = column(rows, channels.z);
    if (zBack_ >= 0) back_ = column(rows, channels.zBack);
    for (std::size_t c = 0; c < 3; ++c) {
      light_[c] = column(rows, channels.light[c]);
      opacity_[c] = column(rows, channels.opacity[c]);
    }
    alpha_ = channels.alpha >= 0 ? column(rows, channels.alpha) : nullptr;
  }

  // False when the samples need the general rules: volumes, coincident depths, values out of range.
  bool composite(std::uint64_t begin, std::uint64_t end, DeepFlat& flat, float& frontZ) {
    const auto count = static_cast<std::size_t>(end - begin);
    places_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const float z = z_[begin + i];
      if (zBack_ >= 0 && back_[begin + i] > z) return false;
      // Insertion: lists are short, and often sorted already.
      std::size_t at = i;
      while (at > 0 && places_[at - 1].z > z) {
        places_[at] = places_[at - 1];
        --at;
      }
      places_[at] = {z, static_cast<std::uint32_t>(i)};
      if (!(z <= std::numeric_limits<float>::max()) || count > kShort) return false;
    }
    for (std::size_t i = 1; i < count; ++i)
      if (places_[i].z == places_[i - 1].z) return false;
    double left[4] = {1, 1, 1, 1}, light[3] = {0, 0, 0};
    for (const Place& place : places_) {
      const std::uint64_t i = begin + place.index;
      double sum = 0;
      bool inRange = true;
      for (std::size_t c = 0; c < 3; ++c) {
        const double opacity = static_cast<double>(opacity_[c][i]), added = static_cast<double>(light_[c][i]);
        inRange &= opacity >= 0.0 && opacity <= 1.0;
        sum += added;
        light[c] += left[c] * added;
        left[c] *= 1.0 - opacity;
      }
      const double alpha = alpha_ ? static_cast<double>(alpha_[i])
                                  : (static_cast<double>(opacity_[0][i]) + static_cast<double>(opacity_[1][i]) +
                                     static_cast<double>(opacity_[2][i])) / 3.0;
      if (!inRange || !(alpha >= 0.0 && alpha <= 1.0) || !std::isfinite(sum)) return false;
      left[3] *= 1.0 - alpha;
    }
    for (int c = 0; c < 3; ++c) flat.light[c] = light[c];
    for (int c = 0; c < 4; ++c) flat.opacity[c] = 1.0 - left[c];
    frontZ = places_.empty() ? std::numeric_limits<float>::infinity() : places_[0].z;
    return true;
  }

 private:
  static constexpr std::size_t kShort = 128;  // beyond, insertion costs more than the general sort
  static const float* column(const DeepRows& rows, int index) {
    return rows.channels[static_cast<std::size_t>(index)].data();
  }
  int zBack_;
  const float *z_ = nullptr, *back_ = nullptr, *alpha_ = nullptr;
  const float *light_[3] = {}, *opacity_[3] = {};
  std::vector<Place> places_;
};

void flattenRows(std::vector<Source>& sources, const Window& band, FlatPicture& flat, std::mutex& mutex) {
  tbb::parallel_for(tbb::blocked_range<int>(band.y0, band.y1), [&](const tbb::blocked_range<int>& range) {
    std::vector<DeepSample> samples;
    DeepOddities oddities;
    PointPixel points(sources[0].channels, sources[0].rows);
    for (int y = range.begin(); y != range.end(); ++y)
      for (int x = band.x0; x < band.x1; ++x) {
        const int px = x - flat.data.x0, py = y - flat.data.y0;
        const auto pixel = static_cast<std::size_t>(y - band.y0) * static_cast<std::size_t>(band.width()) +
                           static_cast<std::size_t>(x - band.x0);
        DeepFlat result;
        float frontZ = std::numeric_limits<float>::infinity();
        const DeepRows& first = sources[0].rows;
        if (sources.size() > 1 ||
            !points.composite(first.offsets[pixel], first.offsets[pixel + 1], result, frontZ)) {
          samples.clear();
          for (const Source& source : sources)
            for (std::uint64_t i = source.rows.offsets[pixel]; i < source.rows.offsets[pixel + 1]; ++i) {
              DeepSample sample;
              if (sampleAt(source.channels, source.rows, i, 1.0, sample, oddities)) samples.push_back(sample);
            }
          result = flattenSamples(samples);
          frontZ = samples.empty() ? std::numeric_limits<float>::infinity() : static_cast<float>(samples[0].z);
        }
        flat.light.at(px, py) = glm::vec3(result.light);
        flat.opacity.at(px, py) = glm::vec4(result.opacity);
        flat.frontZ.at(px, py) = frontZ;
      }
    const std::lock_guard lock(mutex);
    flat.oddities.add(oddities);
  });
}

}  // namespace

FlatPicture flattenDeep(const std::vector<std::string>& paths, std::uint64_t most) {
  std::vector<Source> sources(paths.size());
  FlatPicture flat;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    sources[i].channels = resolveDeep(paths[i]);
    sources[i].reader = std::make_unique<DeepReader>(paths[i], sources[i].channels.part, sources[i].channels.names);
    flat.colouredOpacity |= sources[i].channels.colouredOpacity;
    if (i > 0 && (sources[i].reader->data() != sources[0].reader->data() ||
                  sources[i].reader->display() != sources[0].reader->display()))
      throw MeaningError(fmt::format("{}: found other windows than those of {}, expected the same", paths[i], paths[0]));
  }
  flat.display = sources[0].reader->display();
  flat.data = sources[0].reader->data();
  const int width = flat.data.width(), height = flat.data.height();
  flat.light = Image<glm::vec3>(width, height);
  flat.opacity = Image<glm::vec4>(width, height);
  flat.frontZ = Image<float>(width, height);
  std::mutex mutex;
  for (int y = flat.data.y0; y < flat.data.y1;) {
    int end = flat.data.y1;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      sources[i].rows = sources[i].reader->read(y, end, i == 0 ? most : UINT64_MAX);
      end = sources[i].rows.window.y1;
      flat.samples += sources[i].rows.offsets.back();
    }
    flattenRows(sources, {flat.data.x0, y, flat.data.x1, end}, flat, mutex);
    y = end;
  }
  return flat;
}

}  // namespace pellucid
