#include "composite/pipeline/not_finite.h"

#include <fmt/format.h>

#include <optional>

#include "gbuffer/finite_colour.h"

namespace pellucid {

void noteWhatIsNotFinite(const Picture& picture, const Veil& veil, const GBuffer& background, Journal& journal) {
  std::size_t pixels = 0;
  std::optional<glm::ivec2> first;
  for (int y = 0; y < veil.touched.height(); ++y)
    for (int x = 0; x < veil.touched.width(); ++x) {
      if (!veil.touched.at(x, y)) continue;
      const glm::ivec2 place = veil.place + glm::ivec2(x, y);
      const glm::vec4 &shown = picture.rgba.at(place.x, place.y), &behind = background.beauty.at(place.x, place.y);
      if (isFinite(glm::dvec3(shown)) || !isFinite(glm::dvec3(behind))) continue;
      if (!first) first = place;
      ++pixels;
    }
  if (!first) return;
  journal.note(fmt::format(
      "{} pixels are not finite over a background that is, the first at {}, {}: weighted sums in floats hold "
      "radiance up to 1e20; --method over holds all that a float holds",
      pixels, background.data.x0 + first->x, background.data.y0 + first->y));
}

}  // namespace pellucid
