#include "engine_bridge/embree/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gbuffer/channels.h"
#include "gbuffer/colour_space.h"
#include "gbuffer/errors.h"
#include "gbuffer/exr_document.h"
#include "gbuffer/producers.h"
#include "shaders/shading.h"

namespace pellucid {
namespace {

double luminance(glm::vec3 v) {
  return 0.2126 * static_cast<double>(v.r) + 0.7152 * static_cast<double>(v.g) + 0.0722 * static_cast<double>(v.b);
}

// Cell of a cumulative table that holds `at`, and how far into it.
std::size_t cellOf(const double* cumulative, std::size_t cells, double at, double& within) {
  const double* above = std::upper_bound(cumulative, cumulative + cells + 1, at);
  std::size_t cell = above == cumulative ? 0 : static_cast<std::size_t>(above - cumulative) - 1;
  cell = std::min(cell, cells - 1);
  const double width = cumulative[cell + 1] - cumulative[cell];
  within = width > 0 ? std::clamp((at - cumulative[cell]) / width, 0.0, 1.0) : 0.5;
  return cell;
}

}  // namespace

Environment::Environment(glm::vec3 radiance) : constant_(radiance) {}

Environment::Environment(Image<glm::vec3> latLong) : map_(std::move(latLong)) {
  const auto width = static_cast<std::size_t>(map_.width()), height = static_cast<std::size_t>(map_.height());
  rows_.assign(height + 1, 0.0);
  columns_.assign((width + 1) * height, 0.0);
  for (std::size_t y = 0; y < height; ++y) {
    double* columns = &columns_[y * (width + 1)];
    for (std::size_t x = 0; x < width; ++x) columns[x + 1] = columns[x] + luminance(map_[y * width + x]);
    const double sum = columns[width];
    if (sum > 0)
      for (std::size_t x = 0; x <= width; ++x) columns[x] /= sum;
    // A row's solid angle, exactly.
    const double band = std::cos(M_PI * static_cast<double>(y) / static_cast<double>(height)) -
                        std::cos(M_PI * static_cast<double>(y + 1) / static_cast<double>(height));
    rows_[y + 1] = rows_[y] + sum * band;
  }
  total_ = rows_[height];
  if (total_ > 0)
    for (double& row : rows_) row /= total_;
}

glm::vec3 Environment::radiance(glm::vec3 towards) const {
  if (map_.empty()) return constant_;
  const glm::vec2 uv = shading::latLongOf(towards);
  const int width = map_.width(), height = map_.height();
  const float x = uv.x * static_cast<float>(width) - 0.5f, y = uv.y * static_cast<float>(height) - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const float fx = x - left, fy = y - top;
  const auto column = [&](float at) {
    const int i = static_cast<int>(at) % width;
    return i < 0 ? i + width : i;
  };
  const auto row = [&](float at) { return std::clamp(static_cast<int>(at), 0, height - 1); };
  const int x0 = column(left), x1 = column(left + 1.0f), y0 = row(top), y1 = row(top + 1.0f);
  const glm::vec3 upper = map_.at(x0, y0) * (1.0f - fx) + map_.at(x1, y0) * fx;
  const glm::vec3 lower = map_.at(x0, y1) * (1.0f - fx) + map_.at(x1, y1) * fx;
  return upper * (1.0f - fy) + lower * fy;
}

Environment::Chosen Environment::choose(glm::vec2 random) const {
  if (!(total_ > 0)) return {glm::vec3(0, 1, 0), 0.0f};
  const auto width = static_cast<std::size_t>(map_.width()), height = static_cast<std::size_t>(map_.height());
  double down = 0, across = 0;
  const std::size_t y = cellOf(rows_.data(), height, static_cast<double>(random.y), down);
  const std::size_t x = cellOf(&columns_[y * (width + 1)], width, static_cast<double>(random.x), across);
  // Even in solid angle within the row: even in the cosine.
  const double top = std::cos(M_PI * static_cast<double>(y) / static_cast<double>(height));
  const double bottom = std::cos(M_PI * static_cast<double>(y + 1) / static_cast<double>(height));
  const double polar = std::acos(std::clamp(top + (bottom - top) * down, -1.0, 1.0));
  const glm::vec2 uv(static_cast<float>((static_cast<double>(x) + across) / static_cast<double>(width)),
                     static_cast<float>(polar / M_PI));
  Chosen chosen;
  chosen.towards = glm::normalize(shading::directionOfLatLong(uv));
  chosen.density = density(chosen.towards);
  return chosen;
}

float Environment::density(glm::vec3 towards) const {
  if (!(total_ > 0)) return 0.0f;
  const glm::vec2 uv = shading::latLongOf(towards);
  const int width = map_.width(), height = map_.height();
  const int x = std::clamp(static_cast<int>(uv.x * static_cast<float>(width)), 0, width - 1);
  const int y = std::clamp(static_cast<int>(uv.y * static_cast<float>(height)), 0, height - 1);
  // Probability of a texel is luminance * band / total; its solid angle is band * 2 pi / width.
  return static_cast<float>(luminance(map_.at(x, y)) / total_ * width / (2.0 * M_PI));
}

Environment readEnvironment(const std::string& path, std::vector<std::string>& notes, const glm::dmat3& fromRec709) {
  const ExrDocument document = readExr(path);
  const std::vector<NamedChannel> channels = nameChannels(document);
  const Producer* producer = recogniseProducer(document, channels, "auto").row;
  const BeautyChannels beauty = resolveBeauty(document, channels, "", "", producer);
  const ExrPart& part = document.parts[static_cast<std::size_t>(beauty.part)];
  Image<glm::vec3> map(part.data.width(), part.data.height());
  if (map.empty()) throw MeaningError(path + ": environment: found no pixels, expected a lat-long picture");
  std::size_t repaired = 0;
  for (std::size_t i = 0; i < map.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = beauty.channel[c]->at(i);
      const bool good = std::isfinite(value) && value >= 0.0f;
      map[i][c] = good ? value : 0.0f;
      repaired += good ? 0 : 1;
    }
  if (repaired > 0)
    notes.push_back(fmt::format("{}: {} values are negative or not finite and count as black", path, repaired));
  const ColourSpace own = statedSpace(part, producer ? producer->space : "", notes);
  if (own.fromRec709 != fromRec709) {
    const glm::dmat3 matrix = fromRec709 * glm::inverse(own.fromRec709);
    for (std::size_t i = 0; i < map.size(); ++i) map[i] = converted(matrix, map[i]);
  }
  return Environment(std::move(map));
}

}  // namespace pellucid
