#include "gbuffer/object_coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "gbuffer/lower_case.h"
#include "gbuffer/pixel_rows.h"

namespace pellucid {
namespace {

constexpr float kWhole = 1023.0f / 1024.0f;  // of a pixel: the rest is rounding
constexpr int kMostRanks = 100;              // layers are numbered by two digits

// The names of all layers of the kind, those that say that they tell objects apart first.
std::vector<std::string> layersOf(const ExrDocument& document) {
  std::vector<std::string> objects, others;
  for (const ExrPart& part : document.parts)
    for (const auto& [key, attribute] : part.attributes) {
      if (key.rfind("cryptomatte/", 0) != 0 || key.size() < 6 || key.substr(key.size() - 5) != "/name") continue;
      const std::optional<std::string> name = part.text(key);
      if (!name || name->empty()) continue;
      (lowerCase(*name).find("object") != std::string::npos ? objects : others).push_back(*name);
    }
  objects.insert(objects.end(), others.begin(), others.end());
  return objects;
}

// Four channels of one layer: two objects and how much of the pixel each has.
struct Rank {
  int part = 0;
  const ExrChannel* channel[4] = {};
};

std::optional<Rank> rankOf(const std::vector<NamedChannel>& channels, const std::string& layer, int number,
                           const std::string& view) {
  const std::string wanted = lowerCase(fmt::format("{}{:02}", layer, number));
  constexpr const char* kSuffixes[4][2] = {{"r", "red"}, {"g", "green"}, {"b", "blue"}, {"a", "alpha"}};
  Rank rank;
  for (const NamedChannel& channel : channels) {
    if (!channel.view.empty() && channel.view != view) continue;
    const std::string name = lowerCase(channel.layerName);
    const bool whole = name == wanted;
    const bool last = name.size() > wanted.size() && name[name.size() - wanted.size() - 1] == '.' &&
                      name.compare(name.size() - wanted.size(), wanted.size(), wanted) == 0;
    if ((!whole && !last) || channel.channel->type != PixelType::float32) continue;
    for (std::size_t c = 0; c < 4; ++c)
      if (channel.suffix == kSuffixes[c][0] || channel.suffix == kSuffixes[c][1]) rank.channel[c] = channel.channel;
    rank.part = channel.part;
  }
  const bool complete = std::all_of(std::begin(rank.channel), std::end(rank.channel), [](const auto* c) { return c; });
  return complete ? std::optional<Rank>(rank) : std::nullopt;
}

}  // namespace

void ObjectCoverage::add(const Image<std::uint32_t>& object, const Image<float>& coverage) {
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    const float part = coverage[i];
    if (!(part > 0.0f) || object[i] == kNoObject || covered_[i] >= kWhole) continue;
    covered_[i] += part;
    if (most_[i] == kNoObject) most_[i] = object[i];  // objects come in the order of their parts, the largest first
    if (part < kWhole) shared_.push_back({i, object[i], part});
  }
}

// What nothing covers is a part of its own.
void ObjectCoverage::finish() {
  const std::size_t parts = shared_.size();
  for (std::size_t k = 0; k < parts; ++k) {
    const Part part = shared_[k];
    const bool first = most_[part.pixel] == part.object;
    if (first && covered_[part.pixel] < kWhole) shared_.push_back({part.pixel, kNoObject, 1.0f - covered_[part.pixel]});
    if (first && 2.0f * part.coverage < 1.0f && 1.0f - covered_[part.pixel] > part.coverage)
      most_[part.pixel] = kNoObject;
  }
  std::stable_sort(shared_.begin(), shared_.end(), [](const Part& a, const Part& b) { return a.pixel < b.pixel; });
  covered_ = Image<float>();
}

std::shared_ptr<const ObjectCoverage> ObjectCoverage::of(const ExrDocument& document,
                                                         const std::vector<NamedChannel>& channels,
                                                         const std::string& view, const Window& data) {
  for (const std::string& layer : layersOf(document)) {
    std::shared_ptr<ObjectCoverage> found(new ObjectCoverage(data));
    found->layer_ = layer;
    found->covered_ = Image<float>(data.width(), data.height(), 0.0f);
    for (int number = 0; number < kMostRanks; ++number) {
      const std::optional<Rank> rank = rankOf(channels, layer, number, view);
      if (!rank) break;
      const Window& from = document.parts[static_cast<std::size_t>(rank->part)].data;
      for (const int pair : {0, 2}) {
        Image<std::uint32_t> object(data.width(), data.height(), kNoObject);
        Image<float> coverage(data.width(), data.height(), 0.0f);
        visitPixels(*rank->channel[pair], from, data,
                    [&](int x, int y, float id) { object.at(x, y) = std::bit_cast<std::uint32_t>(id); });
        visitPixels(*rank->channel[pair + 1], from, data, [&](int x, int y, float part) { coverage.at(x, y) = part; });
        found->add(object, coverage);
      }
    }
    found->finish();
    if (!found->shared_.empty()) return found;
  }
  return nullptr;
}

double ObjectCoverage::coverage(int x, int y, const std::vector<std::uint32_t>& objects) const {
  const std::size_t pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(most_.width()) + static_cast<std::size_t>(x);
  const auto asked = [&](std::uint32_t object) {
    return std::find(objects.begin(), objects.end(), object) != objects.end();
  };
  auto part = std::lower_bound(shared_.begin(), shared_.end(), pixel,
                               [](const Part& one, std::size_t at) { return one.pixel < at; });
  if (part == shared_.end() || part->pixel != pixel) return asked(most_[pixel]) ? 1.0 : 0.0;
  double sum = 0.0;
  for (; part != shared_.end() && part->pixel == pixel; ++part)
    if (asked(part->object)) sum += static_cast<double>(part->coverage);
  return std::clamp(sum, 0.0, 1.0);
}

}  // namespace pellucid
