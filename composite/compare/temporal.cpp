#include "composite/compare/temporal.h"

#include <algorithm>
#include <cmath>

#include "composite/compare/structure.h"

namespace pellucid {
namespace {

constexpr double kNotFinite = std::numeric_limits<double>::quiet_NaN();

std::size_t placeIn(const Window& window, int x, int y) {
  return static_cast<std::size_t>(y - window.y0) * static_cast<std::size_t>(window.width()) +
         static_cast<std::size_t>(x - window.x0);
}

Window overlapOf(const Window& a, const Window& b) {
  Window both{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
  both.x1 = std::max(both.x1, both.x0);
  both.y1 = std::max(both.y1, both.y0);
  return both;
}

std::vector<double> differenceOfPlanes(const ChannelPair& pair, const Window& both) {
  std::vector<double> difference;
  difference.reserve(static_cast<std::size_t>(both.width()) * static_cast<std::size_t>(both.height()));
  for (int y = both.y0; y < both.y1; ++y)
    for (int x = both.x0; x < both.x1; ++x) {
      const auto a = static_cast<double>(pair.a->at(placeIn(pair.partA->data, x, y)));
      const auto b = static_cast<double>(pair.b->at(placeIn(pair.partB->data, x, y)));
      difference.push_back(std::isfinite(a) && std::isfinite(b) ? a - b : kNotFinite);
    }
  return difference;
}

bool wants(const CompareSettings& settings, const std::string& layer) {
  return settings.layers.empty() ||
         std::find(settings.layers.begin(), settings.layers.end(), layer) != settings.layers.end();
}

TemporalLayer& layerNamed(std::vector<TemporalLayer>& layers, const std::string& name) {
  for (TemporalLayer& layer : layers)
    if (layer.name == name) return layer;
  layers.push_back({name});
  return layers.back();
}

}  // namespace

std::vector<TemporalLayer> TemporalError::next(const ExrDocument& a, const ExrDocument& b,
                                               const CompareSettings& settings) {
  CompareReport structure;
  std::map<std::string, Values> now;
  std::vector<TemporalLayer> layers;
  for (const ChannelPair& pair : pairChannels(a, b, structure)) {
    if (pair.partA->deep || !wants(settings, pair.layer)) continue;
    Values values;
    values.window = overlapOf(pair.partA->data, pair.partB->data);
    values.difference = differenceOfPlanes(pair, values.window);
    const auto before = before_.find(pair.name);
    if (before != before_.end() && before->second.window == values.window) {
      TemporalLayer& layer = layerNamed(layers, pair.layer);
      for (std::size_t i = 0; i < values.difference.size(); ++i) {
        const double error = values.difference[i] - before->second.difference[i];
        if (std::isnan(error)) continue;
        ++layer.values;
        if (error != 0.0) ++layer.changed;
        layer.rms += error * error;  // the sum until the end
        layer.largest = std::max(layer.largest, std::abs(error));
      }
    }
    now[pair.name] = std::move(values);
  }
  for (TemporalLayer& layer : layers)
    if (layer.values > 0) layer.rms = std::sqrt(layer.rms / static_cast<double>(layer.values));
  before_ = std::move(now);
  return layers;
}

}  // namespace pellucid
