#include "composite/cli/lists.h"

#include <algorithm>
#include <limits>

#include "composite/fog.h"

namespace pellucid::cli {
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

void eachList(TransparentPass* pass, std::vector<std::unique_ptr<DeepSource>>& deep, const GBuffer& gbuffer,
              const PassSettings& settings, VolumeRule rule, const std::function<void(const FragmentLists&)>& tile) {
  // A sample is held as up to 16 floats, then once more as a fragment.
  const std::uint64_t most = std::max<std::uint64_t>(settings.budgetBytes / (64 + sizeof(Fragment)), 1);
  const auto veiled = [&](const FragmentLists& lists) {
    if (settings.fog)
      tile(withFog(*settings.fog, gbuffer, settings.sample, lists));
    else
      tile(lists);
  };
  const auto merge = [&](const FragmentLists& lists) {
    if (deep.empty())
      veiled(lists);
    else
      mergeDeep(lists, deep, gbuffer, rule, most, veiled);
  };
  PassSettings listed = settings;
  if (!deep.empty()) listed.tile = std::max(gbuffer.data.width(), gbuffer.data.height());  // files are read by rows
  if (pass)
    pass->fragments(listed, merge);
  else
    merge(emptyLists(gbuffer.data));
}

}  // namespace pellucid::cli
