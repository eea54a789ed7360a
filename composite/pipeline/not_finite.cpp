#include "composite/pipeline/not_finite.h"

#include <fmt/format.h>

#include <optional>

#include "gbuffer/finite_colour.h"

namespace pellucid {

void noteWhatIsNotFinite(const Picture& picture, const GBuffer& background, Journal& journal) {
  std::size_t pixels = 0;
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
    if (isFinite(glm::dvec3(picture.rgba[i])) || !isFinite(glm::dvec3(background.beauty[i]))) continue;
    if (!first) first = i;
    ++pixels;
  }
  if (!first) return;
  const auto width = static_cast<std::size_t>(picture.rgba.width());
  const int x = background.data.x0 + static_cast<int>(*first % width);
  const int y = background.data.y0 + static_cast<int>(*first / width);
  journal.note(fmt::format(
      "{} pixels are not finite over a background that is, the first at {}, {}: weighted sums in floats hold "
      "radiance up to 1e20; --method over holds all that a float holds",
      pixels, x, y));
}

}  // namespace pellucid
