#include "engine_bridge/scene/animations.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

namespace pellucid::gltf {

namespace {

// Numbers that a file's curves may hold: a few, and more for each of its bytes.
constexpr std::size_t kFreeNumbers = std::size_t{1} << 24, kNumbersPerByte = 4;

bool wantsAll(const std::vector<std::string>& wanted) {
  return wanted.size() == 1 && wanted[0] == "all";
}

std::string listOf(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 8;
  std::string list;
  for (std::size_t i = 0; i < names.size() && i < kMost; ++i) list += (i ? ", " : "") + names[i];
  return names.size() > kMost ? list + fmt::format(" and {} more", names.size() - kMost) : list;
}

}  // namespace

std::shared_ptr<const Curve> Animations::curveOf(const JsonView& sampler, const CurveShape& shape) {
  // Exporters let many samplers share accessors.
  const std::string key =
      fmt::format("{} {} {} {} {}", sampler.at("input").unsignedInteger(), sampler.at("output").unsignedInteger(),
                  sampler.string("interpolation", "LINEAR"), static_cast<int>(shape.kind), shape.width);
  if (const auto found = curves_.find(key); found != curves_.end()) return found->second;
  auto curve = std::make_shared<const Curve>(readCurve(*file_, sampler, shape));
  charged_ += curve->seconds.size() + curve->values.size();
  if (charged_ > kFreeNumbers + kNumbersPerByte * file_->bytesRead())
    sampler.refuse(fmt::format("takes the file's animations to {} numbers; expected at most {} a byte of it", charged_,
                               kNumbersPerByte));
  return curves_.emplace(key, std::move(curve)).first->second;
}

Animations::Played Animations::read(const JsonView& animation, const std::string& name, Notes& notes) {
  Played played{name, {}};
  const JsonView channels = animation.at("channels"), samplers = animation.at("samplers");
  std::set<std::string> moved;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const JsonView channel = channels.at(i), target = channel.at("target");
    const JsonView sampler = samplers.at(channel.at("sampler").index(samplers.size(), "samplers"));
    const std::optional<Moved> what = movedBy(*file_, target, notes);
    if (!what) continue;
    if (!moved.insert(what->pointer).second)
      target.refuse(fmt::format("moves {} a second time in one animation; expected once", what->pointer));
    played.channels.push_back({what->pointer, curveOf(sampler, what->shape)});
  }
  return played;
}

Animations::Animations(GltfFile& file, const std::vector<std::string>& wanted, Notes& notes) : file_(&file) {
  const std::size_t count = file.count("animations");
  std::vector<Played> chosen;
  for (std::size_t i = 0; i < count; ++i) {
    const JsonView animation = file.item("animations", i);
    names_.push_back(animation.string("name", ""));
    if (names_.back().empty()) names_.back() = fmt::format("animation {}", i);
    const bool named = std::find(wanted.begin(), wanted.end(), names_.back()) != wanted.end();
    if (wanted.empty() || wantsAll(wanted) || named) chosen.push_back(read(animation, names_.back(), notes));
  }
  std::map<std::string, std::size_t> places;  // of what is moved among the channels
  for (const Played& played : chosen) {
    const bool overlaps = std::any_of(played.channels.begin(), played.channels.end(),
                                      [&](const Channel& channel) { return places.count(channel.pointer) > 0; });
    if (overlaps && wanted.empty()) {
      channels_ = chosen[0].channels;
      played_ = {chosen[0].name};
      notes.add(
          fmt::format("has {} animations that move the same things, of which the first is played, {}; "
                      "--animation NAME chooses among {}",
                      count, chosen[0].name, listOf(names_)));
      break;
    }
    played_.push_back(played.name);
    for (const Channel& channel : played.channels) {
      const auto [place, fresh] = places.emplace(channel.pointer, channels_.size());
      if (fresh)
        channels_.push_back(channel);
      else
        channels_[place->second] = channel;
    }
  }
  first_ = std::numeric_limits<double>::infinity();
  last_ = -first_;
  for (const Channel& channel : channels_) {
    first_ = std::min(first_, static_cast<double>(channel.curve->seconds.front()));
    last_ = std::max(last_, static_cast<double>(channel.curve->seconds.back()));
  }
}

std::string Animations::description() const {
  return fmt::format("{} ({:g} s to {:g} s)", listOf(played_), first_, last_);
}

void Animations::pose(double seconds) {
  for (const Channel& channel : channels_) file_->put(channel.pointer, channel.curve->at(seconds));
}

}  // namespace pellucid::gltf
