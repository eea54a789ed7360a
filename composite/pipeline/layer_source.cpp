#include "composite/pipeline/layer_source.h"

#include <algorithm>
#include <limits>

#include "composite/low_resolution.h"
#include "shaders/shading.h"

namespace pellucid {
namespace {

FragmentLists emptyLists(const Window& window) {
  FragmentLists lists;
  lists.window = window;
  lists.solid =
      Image<glm::vec4>(window.width(), window.height(), glm::vec4(0, 0, 0, std::numeric_limits<float>::infinity()));
  lists.offsets.assign(lists.solid.size() + 1, 0);
  return lists;
}

}  // namespace

FragmentLists tiedToPixels(const FragmentLists& lists, FragmentLists joined) {
  const auto width = static_cast<std::size_t>(joined.window.width());
  for (std::size_t pixel = 0; pixel + 1 < joined.offsets.size(); ++pixel) {
    const std::uint64_t own = lists.offsets[pixel + 1] - lists.offsets[pixel];
    const glm::uvec2 at(joined.window.x0 + static_cast<int>(pixel % width),
                        joined.window.y0 + static_cast<int>(pixel / width));
    for (std::uint64_t i = joined.offsets[pixel] + own; i < joined.offsets[pixel + 1]; ++i)
      joined.fragments[i].identity = shading::coinKeyOf(at, joined.fragments[i].identity, 0u);
  }
  return joined;
}

void LayerSources::each(const SourceView& view, const ListSink& sink) const {
  ListSink chain = sink;
  const LowResolutionFragments* low = view.low;
  const auto joinLow = [&] {
    if (low)
      chain = [low, pieces = view.settings.pieces, next = std::move(chain)](const FragmentLists& lists) {
        next(pieces ? tiedToPixels(lists, low->among(lists)) : low->among(lists));
      };
    low = nullptr;
  };
  for (auto source = joined_.rbegin(); source != joined_.rend(); ++source) {
    if (!(*source)->runsBetween()) joinLow();
    chain = (*source)->into(view, std::move(chain));
  }
  joinLow();
  const Window& data = view.picture.gbuffer->data;
  if (!pass_) {
    chain(emptyLists(data));
    return;
  }
  PassSettings listed = view.settings;
  const bool rows = std::any_of(joined_.begin(), joined_.end(), [](const auto& source) { return source->wantsRows(); });
  if (rows) listed.tile = std::max(data.width(), data.height());
  pass_->fragments(listed, chain);
}

bool LayerSources::mayScatter(const PassSettings& settings) const {
  return (pass_ && pass_->scatters(settings)) || (settings.fog && settings.fog->diffuses()) ||
         std::any_of(joined_.begin(), joined_.end(), [](const auto& source) { return source->mayScatter(); });
}

}  // namespace pellucid
