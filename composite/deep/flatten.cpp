#include "composite/deep/flatten.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>

#include "composite/depth_order.h"
#include "gbuffer/errors.h"

namespace pellucid {
namespace {

// Depth stays in the file's unit: nothing is compared with it.
const DepthConverter kAsStored({}, PixelType::float32, std::nullopt, 1.0, nullptr, {}, "");

struct Source {
  DeepChannels channels;
  std::unique_ptr<DeepReader> reader;
  DeepRows rows;
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
    for (std::uint64_t i = begin; i < end; ++i)
      if (!(z_[i] <= std::numeric_limits<float>::max()) || (zBack_ >= 0 && back_[i] > z_[i])) return false;
    if (!sort(z_ + begin, count)) return false;
    double left[4] = {1, 1, 1, 1}, light[3] = {0, 0, 0};
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint64_t i = begin + order_[k];
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
                                     static_cast<double>(opacity_[2][i])) /
                                        3.0;
      if (!inRange || !(alpha >= 0.0 && alpha <= 1.0) || !std::isfinite(sum)) return false;
      left[3] *= 1.0 - alpha;
    }
    for (int c = 0; c < 3; ++c) flat.light[c] = light[c];
    for (int c = 0; c < 4; ++c) flat.opacity[c] = 1.0 - left[c];
    frontZ = count == 0 ? std::numeric_limits<float>::infinity() : z_[begin + order_[0]];
    return true;
  }

 private:
  // False where two depths are the same.
  bool sort(const float* z, std::size_t count) {
    if (order_.size() < count) order_.resize(count);
    if (count <= kMostRanked) return orderByDepth(z, count, order_.data());
    std::iota(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(count), 0u);
    std::sort(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(count),
              [&](std::uint32_t a, std::uint32_t b) { return z[a] < z[b]; });
    for (std::size_t i = 1; i < count; ++i)
      if (z[order_[i]] == z[order_[i - 1]]) return false;
    return true;
  }

  static const float* column(const DeepRows& rows, int index) {
    return rows.channels.empty() ? nullptr : rows.channels[static_cast<std::size_t>(index)].data();
  }
  int zBack_;
  const float *z_ = nullptr, *back_ = nullptr, *alpha_ = nullptr;
  const float *light_[3] = {}, *opacity_[3] = {};
  std::vector<std::uint32_t> order_;
};

// Range of the pixel's samples, empty outside the rows.
std::pair<std::uint64_t, std::uint64_t> samplesAt(const DeepRows& rows, int x, int y) {
  const Window& w = rows.window;
  if (x < w.x0 || x >= w.x1 || y < w.y0 || y >= w.y1) return {0, 0};
  const auto pixel =
      static_cast<std::size_t>(y - w.y0) * static_cast<std::size_t>(w.width()) + static_cast<std::size_t>(x - w.x0);
  return {rows.offsets[pixel], rows.offsets[pixel + 1]};
}

std::uint64_t samplesIn(const DeepRows& rows, int y) {
  return samplesAt(rows, rows.window.x1 - 1, y).second - samplesAt(rows, rows.window.x0, y).first;
}

void flattenRows(std::vector<Source>& sources, const Window& band, FlatPicture& flat, std::mutex& mutex) {
  tbb::parallel_for(tbb::blocked_range<int>(band.y0, band.y1), [&](const tbb::blocked_range<int>& range) {
    std::vector<DeepSample> samples;
    DeepOddities oddities;
    PointPixel points(sources[0].channels, sources[0].rows);
    for (int y = range.begin(); y != range.end(); ++y)
      for (int x = band.x0; x < band.x1; ++x) {
        const int px = x - flat.data.x0, py = y - flat.data.y0;
        DeepFlat result;
        float frontZ = std::numeric_limits<float>::infinity();
        const auto [first, last] = samplesAt(sources[0].rows, x, y);
        if (sources.size() > 1 || !points.composite(first, last, result, frontZ)) {
          samples.clear();
          for (const Source& source : sources)
            for (auto [i, end] = samplesAt(source.rows, x, y); i < end; ++i) {
              DeepSample sample;
              if (sampleAt(source.channels, source.rows, i, kAsStored, x, y, sample, oddities))
                samples.push_back(sample);
            }
          result = flattenSamples(samples);
          const bool far = samples.empty() || samples[0].z >= kFarthest;
          frontZ = far ? std::numeric_limits<float>::infinity() : static_cast<float>(samples[0].z);
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

FlatPicture flattenDeep(const std::vector<std::string>& paths, std::uint64_t most, const std::string& view,
                        const std::function<void(double)>& told) {
  std::vector<Source> sources(paths.size());
  FlatPicture flat;
  // Beside a file that has the view, one that tells no views apart is the same for every eye.
  std::vector<ExrDocument> documents;
  for (const std::string& path : paths) documents.push_back(readExr(path));
  const bool haveViews = std::any_of(documents.begin(), documents.end(), tellsViews);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const ExrDocument& document = documents[i];
    sources[i].channels = resolveDeep(document, haveViews && !tellsViews(document) ? "" : view);
    if (i == 0) flat.like = document.parts[static_cast<std::size_t>(sources[0].channels.part)];
    if (!sources[i].channels.note.empty()) flat.notes.push_back(sources[i].channels.note);
    sources[i].reader = std::make_unique<DeepReader>(paths[i], sources[i].channels.part, sources[i].channels.names);
    flat.colouredOpacity |= sources[i].channels.colouredOpacity;
    const Window& data = sources[i].reader->data();
    if (i == 0) flat.data = data;
    flat.data = {std::min(flat.data.x0, data.x0), std::min(flat.data.y0, data.y0), std::max(flat.data.x1, data.x1),
                 std::max(flat.data.y1, data.y1)};
    if (sources[i].reader->display() != sources[0].reader->display())
      throw MeaningError(
          fmt::format("{}: found another display window than that of {}, expected the same", paths[i], paths[0]));
  }
  flat.display = sources[0].reader->display();
  const int width = flat.data.width(), height = flat.data.height();
  flat.light = Image<glm::vec3>(width, height);
  flat.opacity = Image<glm::vec4>(width, height);
  flat.frontZ = Image<float>(width, height);
  std::mutex mutex;
  for (int y = flat.data.y0; y < flat.data.y1;) {
    int end = flat.data.y1;
    for (Source& source : sources) {
      const Window& data = source.reader->data();
      const int from = std::max(y, data.y0), to = std::min(end, data.y1);
      if (from >= to) {
        source.rows = {};
        continue;
      }
      source.rows = source.reader->read(from, to, most, std::move(source.rows));
      end = source.rows.window.y1;
    }
    for (const Source& source : sources)
      for (int row = std::max(y, source.rows.window.y0); row < std::min(end, source.rows.window.y1); ++row)
        flat.samples += samplesIn(source.rows, row);
    flattenRows(sources, {flat.data.x0, y, flat.data.x1, end}, flat, mutex);
    y = end;
    if (told) told(static_cast<double>(y - flat.data.y0) / height);
  }
  return flat;
}

}  // namespace pellucid
