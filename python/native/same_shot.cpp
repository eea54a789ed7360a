#include "python/native/same_shot.h"

#include <algorithm>

namespace pellucid::python {
namespace {

// Each takes its record apart into all of its fields, so that a new one does not compile until it is compared here.

bool same(const SideFile& a, const SideFile& b) {
  const auto& [name, path, channel] = a;
  const auto& [name2, path2, channel2] = b;
  return name == name2 && path == path2 && channel == channel2;
}

bool same(const std::optional<SideFile>& a, const std::optional<SideFile>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}

bool same(const ReadOptions& a, const ReadOptions& b) {
  const auto& [preset, beauty, view, depth, depthFile, aovs, kind, far, unit, framing] = a;
  const auto& [preset2, beauty2, view2, depth2, depthFile2, aovs2, kind2, far2, unit2, framing2] = b;
  const bool sides = std::equal(aovs.begin(), aovs.end(), aovs2.begin(), aovs2.end(),
                                [](const SideFile& one, const SideFile& other) { return same(one, other); });
  return sides && same(depthFile, depthFile2) && preset == preset2 && beauty == beauty2 && view == view2 &&
         depth == depth2 && kind == kind2 && far == far2 && unit == unit2 && framing == framing2;
}

bool same(const SceneOptions& a, const SceneOptions& b) {
  return a == b;
}

bool same(const ShotTime& a, const ShotTime& b) {
  const auto& [frame, seconds, rate, offset, animations] = a;
  const auto& [frame2, seconds2, rate2, offset2, animations2] = b;
  return frame == frame2 && seconds == seconds2 && rate == rate2 && offset == offset2 && animations == animations2;
}

bool same(const ColourRequest& a, const ColourRequest& b) {
  const auto& [config, by, space] = a;
  const auto& [config2, by2, space2] = b;
  return config == config2 && by == by2 && space == space2;
}

bool same(std::monostate, std::monostate) {
  return true;
}
bool same(const NamedCamera& a, const NamedCamera& b) {
  const auto& [name] = a;
  const auto& [name2] = b;
  return name == name2;
}
bool same(const PlacedCamera& a, const PlacedCamera& b) {
  const auto& [eye, look, up, fov] = a;
  const auto& [eye2, look2, up2, fov2] = b;
  return eye == eye2 && look == look2 && up == up2 && fov == fov2;
}
bool same(const FittedCamera& a, const FittedCamera& b) {
  const auto& [azimuth, elevation] = a;
  const auto& [azimuth2, elevation2] = b;
  return azimuth == azimuth2 && elevation == elevation2;
}
bool same(const Camera& a, const Camera& b) {
  const auto& [view, ortho, focal, centre, near, far, origin] = a;
  const auto& [view2, ortho2, focal2, centre2, near2, far2, origin2] = b;
  return view == view2 && ortho == ortho2 && focal == focal2 && centre == centre2 && near == near2 && far == far2 &&
         origin == origin2;
}
bool same(const glm::vec3& a, const glm::vec3& b) {
  return a == b;
}
bool same(const PictureOfSurroundings& a, const PictureOfSurroundings& b) {
  const auto& [path] = a;
  const auto& [path2] = b;
  return path == path2;
}

template <class... Kinds>
bool same(const std::variant<Kinds...>& a, const std::variant<Kinds...>& b) {
  if (a.index() != b.index()) return false;
  return std::visit([&](const auto& one) { return same(one, std::get<std::decay_t<decltype(one)>>(b)); }, a);
}

}  // namespace

bool sameShot(const ShotRequest& a, const ShotRequest& b) {
  const auto& [opaque, memory, rendered, inputs, read, scene, time, camera, surroundings, colour] = a;
  const auto& [opaque2, memory2, rendered2, inputs2, read2, scene2, time2, camera2, surroundings2, colour2] = b;
  return opaque == opaque2 && memory == memory2 && rendered == rendered2 && inputs == inputs2 && same(read, read2) &&
         same(scene, scene2) && same(time, time2) && same(camera, camera2) && same(surroundings, surroundings2) &&
         same(colour, colour2);
}

}  // namespace pellucid::python
