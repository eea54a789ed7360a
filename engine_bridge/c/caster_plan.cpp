#include "engine_bridge/c/caster_plan.h"

#include <utility>

#include "engine_bridge/c/caster_table.h"

namespace pellucid::c {
namespace {

constexpr const char* kSamplers[] = {"first", "second", "third"};  // of shaders/gl/shadow_filter.frag
constexpr const char* kAcross[] = {"acrossRed", "acrossGreen", "acrossBlue"};

uint32_t add(RecipePlan& plan, PlannedImage image) {
  plan.images.push_back(std::move(image));
  return static_cast<uint32_t>(plan.images.size() - 1);
}

uint32_t addTexels(RecipePlan& plan, const char* name, PartOfFrame part) {
  return add(plan, {name, PLD_ROLE_OWN, PLD_FORMAT_RGBA32F, part});
}

// Nearest depths by their minimum, where the coins leave none PLD_SHADOW_NOTHING; optical depths add up, in alpha where
// one channel serves all.
std::vector<uint32_t> addDrawn(RecipePlan& plan) {
  const float nothing = shading::PLD_SHADOW_NOTHING;
  std::vector<uint32_t> drawn{addTexels(plan, "nearest", PartOfFrame::drawnFace)};
  plan.images.back().clear = {nothing, nothing, nothing, 0.0f};
  if (channelsOf(plan.maps) > 1) drawn.push_back(addTexels(plan, "steps", PartOfFrame::drawnFace));
  return drawn;
}

void addDraws(RecipePlan& plan, const std::vector<uint32_t>& drawn, pld_depth depth) {
  constexpr pld_factor one = PLD_FACTOR_ONE;
  PlannedPass& pass = plan.passes.emplace_back();
  pass.name = "casters";
  pass.kind = PLD_PASS_DRAWS;
  pass.moment = Moment::draws;
  pass.stage = PLD_STAGE_CASTERS;
  pass.part = PartOfFrame::drawnFace;
  pass.depthImage = add(plan, {"depth", PLD_ROLE_SHADOW_DEPTH, PLD_FORMAT_HOST, PartOfFrame::drawnFace});
  pass.compare = depth == PLD_DEPTH_REVERSED ? PLD_COMPARE_GREATER_OR_EQUAL : PLD_COMPARE_LESS_OR_EQUAL;
  for (uint32_t i = 0; i < drawn.size(); ++i)
    pass.attachments.push_back({drawn[i],
                                i,
                                0,
                                PLD_LOAD_CLEAR,
                                kAllComponents,
                                {1, one, one, i == 0 ? PLD_BLEND_MINIMUM : PLD_BLEND_ADD, one, one, PLD_BLEND_ADD}});
}

//   filter  FILTER of shaders/gl/shadow_filter.frag
PlannedPass& addFilter(RecipePlan& plan, const char* name, const char* filter, PartOfFrame part,
                       const std::vector<uint32_t>& from) {
  PlannedPass& pass = plan.passes.emplace_back();
  pass.name = name;
  pass.stage = PLD_STAGE_CASTERS;
  pass.part = part;
  pass.file = "gl/shadow_filter.frag";
  if (channelsOf(plan.maps) == 1) pass.defines.emplace_back("GREY");
  pass.defines.emplace_back(filter);
  for (uint32_t i = 0; i < from.size(); ++i) pass.reads.push_back({from[i], i, kSamplers[i]});
  return pass;
}

}  // namespace

RecipePlan casterPlan(const pld_shadow_info& info, pld_depth depth) {
  RecipePlan plan;
  plan.maps = info;
  const auto channels = static_cast<uint32_t>(channelsOf(info));
  const std::vector<uint32_t> drawn = addDrawn(plan);
  addDraws(plan, drawn, depth);
  std::vector<uint32_t> across;
  if (isFiltered(info)) {
    PlannedPass& pass = addFilter(plan, "filtered across", "FILTER 1", PartOfFrame::acrossFace, drawn);
    for (uint32_t i = 0; i < channels; ++i) {
      across.push_back(addTexels(plan, kAcross[i], PartOfFrame::acrossFace));
      pass.attachments.push_back({across[i], i, 0, PLD_LOAD_ANY, kAllComponents, {}});
    }
  }
  PlannedPass& kept = isFiltered(info) ? addFilter(plan, "filtered down", "FILTER 2", PartOfFrame::keptFace, across)
                                       : addFilter(plan, "kept", "FILTER 0", PartOfFrame::keptFace, drawn);
  const uint32_t maps = add(plan, {"maps", PLD_ROLE_SHADOW_MAPS, PLD_FORMAT_RGBA32F, PartOfFrame::keptFace,
                                   static_cast<uint32_t>(info.faces) * channels});
  for (uint32_t i = 0; i < channels; ++i)
    kept.attachments.push_back({maps, i, PLD_LAYER_OF_FACE, PLD_LOAD_ANY, kAllComponents, {}});
  return plan;
}

}  // namespace pellucid::c
