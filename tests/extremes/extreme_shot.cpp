#include "tests/extremes/extreme_shot.h"

#include <algorithm>
#include <limits>

#include "gbuffer/deep_io.h"
#include "gbuffer/opaque_io.h"
#include "tests/support/random.h"

namespace pellucid::test {
namespace {

constexpr int kWidth = 64;
constexpr std::size_t kMostLayers = 3;

// A value of each quantity, the middle of its range where nothing varies it.
struct Values {
  double opacity = 0.5;
  reference::Rgb coloured{1.0, 1.0, 1.0};  // times the opacity
  double radiance = 1.0, background = 1.0, depth = 10.0;
};

void setValue(Values& values, Quantity quantity, double value) {
  if (quantity == Quantity::opacity) values.opacity = value;
  if (quantity == Quantity::colouredOpacity) values.coloured = {value, 0.5, 1.0};
  if (quantity == Quantity::radiance) values.radiance = value;
  if (quantity == Quantity::background) values.background = value;
  if (quantity == Quantity::depth) values.depth = value;
}

double asFloat(double value) {
  return static_cast<double>(static_cast<float>(value));
}

reference::Layer layerOf(const Values& values) {
  constexpr reference::Rgb kTint{1.0, 0.75, 0.25};
  reference::Layer layer;
  layer.coverage = 1.0;
  layer.z = asFloat(values.depth);
  for (std::size_t c = 0; c < 3; ++c) {
    const double opacity = asFloat(values.opacity * values.coloured[c]);
    layer.transmission[c] = 1.0 - opacity;
    layer.reflected[c] = asFloat(opacity * values.radiance * kTint[c]);
  }
  return layer;
}

double drawn(Random& random, Quantity quantity) {
  const std::vector<double>& range = rangeOf(quantity);
  return range[random.below(static_cast<std::uint32_t>(range.size()))];
}

ExtremePixel pixelOf(const Values& front, std::size_t layers, Random& random) {
  ExtremePixel pixel;
  for (std::size_t c = 0; c < 3; ++c) pixel.background[c] = asFloat(front.background);
  pixel.layers.push_back(layerOf(front));
  while (pixel.layers.size() < layers) {
    Values values;
    for (const Quantity quantity : {Quantity::opacity, Quantity::colouredOpacity, Quantity::radiance, Quantity::depth})
      setValue(values, quantity, drawn(random, quantity));
    values.depth *= random.between(1.01, 1.99);  // so that no two stand at one depth
    pixel.layers.push_back(layerOf(values));
  }
  std::sort(pixel.layers.begin(), pixel.layers.end(), [](const auto& a, const auto& b) { return a.z < b.z; });
  return pixel;
}

// Every value of one quantity with every value of another, before none, one and two more layers.
void addPairs(Quantity a, Quantity b, Random& random, ExtremeShot& shot) {
  for (const double first : rangeOf(a))
    for (const double second : rangeOf(b))
      for (std::size_t layers = 1; layers <= kMostLayers; ++layers) {
        Values values;
        setValue(values, a, first);
        setValue(values, b, second);
        shot.pixels.push_back(pixelOf(values, layers, random));
      }
}

void addLadder(Quantity varied, std::size_t layers, std::uint64_t seed, ExtremeShot& shot) {
  shot.ladders.push_back({varied, shot.pixels.size(), rangeOf(varied).size()});
  for (const double value : rangeOf(varied)) {
    Random same(seed);
    Values values;
    if (varied == Quantity::opacity || varied == Quantity::colouredOpacity) values.radiance = 0.0;
    setValue(values, varied, value);
    shot.pixels.push_back(pixelOf(values, layers, same));
  }
}

void writeBackgrounds(const ExtremeShot& shot) {
  Image<float> planes[3];
  for (std::size_t c = 0; c < 3; ++c) {
    planes[c] = Image<float>(shot.width, shot.height);
    for (std::size_t i = 0; i < shot.pixels.size(); ++i)
      planes[c][i] = static_cast<float>(shot.pixels[i].background[c]);
  }
  const Image<float> one(shot.width, shot.height, 1.0f), far(shot.width, shot.height, 3e38f);
  const Window window{0, 0, shot.width, shot.height};
  writeLayers(shot.picture, window, window,
              {{"", {{"R", planes[0]}, {"G", planes[1]}, {"B", planes[2]}, {"A", one}, {"Z", far}}}});
}

void writeStacks(const ExtremeShot& shot) {
  DeepHeader header;
  header.display = header.data = {0, 0, shot.width, shot.height};
  header.channels = {"A", "AB", "AG", "AR", "B", "G", "R", "Z"};
  DeepWriter writer(shot.layers, header);
  DeepRows rows;
  rows.window = header.data;
  rows.channels.resize(header.channels.size());
  rows.offsets.assign(1, 0);
  for (const ExtremePixel& pixel : shot.pixels) {
    for (const reference::Layer& layer : pixel.layers) {
      const reference::Rgb& t = layer.transmission;
      const double values[] = {(3.0 - t[0] - t[1] - t[2]) / 3.0,
                               1.0 - t[2],
                               1.0 - t[1],
                               1.0 - t[0],
                               layer.reflected[2],
                               layer.reflected[1],
                               layer.reflected[0],
                               layer.z};
      for (std::size_t c = 0; c < rows.channels.size(); ++c) rows.channels[c].push_back(static_cast<float>(values[c]));
    }
    rows.offsets.push_back(rows.channels[0].size());
  }
  writer.write(rows);
  writer.finish();
}

}  // namespace

const std::vector<double>& rangeOf(Quantity quantity) {
  static const std::vector<double> opacities{0.0, 1e-8, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999, 1.0 - 1e-7, 1.0},
      radiances{0.0, 1e-30, 1e-20, 1e-10, 1e-5, 1e-2, 1.0, 1e2, 1e5, 1e10, 1e20, 1e30},
      depths{1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6, 1e9};
  if (quantity == Quantity::depth) return depths;
  return quantity == Quantity::radiance || quantity == Quantity::background ? radiances : opacities;
}

ExtremeShot writeExtremeShot(const std::string& folder, std::uint64_t seed) {
  ExtremeShot shot;
  shot.picture = folder + "/picture.exr";
  shot.layers = folder + "/layers.exr";
  Random random(seed);
  for (int a = 0; a < kQuantities; ++a)
    for (int b = a + 1; b < kQuantities; ++b)
      addPairs(static_cast<Quantity>(a), static_cast<Quantity>(b), random, shot);
  addLadder(Quantity::opacity, 1, seed, shot);
  addLadder(Quantity::colouredOpacity, 1, seed, shot);
  addLadder(Quantity::radiance, 2, seed, shot);
  addLadder(Quantity::background, 3, seed, shot);
  // No layer over colours of the oddest bits, to the end of the last row and one more.
  constexpr double kOdd[] = {-0.0, 1e-40, -1e-40, -1.0, std::numeric_limits<float>::max(), 1e-45};
  for (std::size_t k = 0; k < kWidth || shot.pixels.size() % kWidth != 0; ++k) {
    const double odd = kOdd[k % std::size(kOdd)];
    shot.pixels.push_back({{}, {odd, 1.0, -odd}});
  }
  shot.width = kWidth;
  shot.height = static_cast<int>(shot.pixels.size() / kWidth);
  writeBackgrounds(shot);
  writeStacks(shot);
  return shot;
}

}  // namespace pellucid::test
