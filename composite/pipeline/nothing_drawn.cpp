#include "composite/pipeline/nothing_drawn.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "engine_bridge/scene/unseen.h"

namespace pellucid {

void noteThatNothingShows(const Shot& shot, Journal& journal) {
  std::vector<std::string> paths = shot.geometry;
  for (const auto& file : shot.deep) paths.push_back(file->path());
  std::string why;
  if (shot.hasScene) why = whyNothingShows(shot.scene, shot.camera, shot.opaque.gbuffer);
  if (!shot.deep.empty())
    why += std::string(why.empty() ? "" : "; ") +
           "no deep sample that hides or adds anything lies before what the picture shows";
  journal.note(fmt::format("{}: nothing of it shows in the picture: {}", fmt::join(paths, ", "), why));
}

bool anyTouched(const Image<std::uint8_t>& touched) {
  for (std::size_t i = 0; i < touched.size(); ++i)
    if (touched[i]) return true;
  return false;
}

bool anyLayers(const OitPlanes& planes) {
  for (std::size_t i = 0; i < planes.weight.size(); ++i)
    if (planes.weight[i].a > 0.0f || std::isfinite(planes.solid[i].a)) return true;
  return false;
}

}  // namespace pellucid
