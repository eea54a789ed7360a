#include "engine_bridge/c/views.h"

#include "engine_bridge/c/host_textures.h"

namespace pellucid::c {
namespace {

bool readsOf(const PlannedPass& pass, const PlannedPass& other) {
  for (const PlannedRead& read : pass.reads)
    for (const pld_recipe_attachment& one : other.attachments)
      if (read.image == one.image) return true;
  return false;
}

}  // namespace

// Null for a view of what this pass does not keep.
const PlannedPass* Views::passOf(pld_view view) const {
  for (const PlannedPass& pass : plan_.passes)
    if (pass.shows(view)) return &pass;
  return nullptr;
}

pld_status Views::failOutput(pld_view view) {
  constexpr const char* features[] = {"PLD_FEATURE_OUTPUTS", "PLD_FEATURE_OUTPUTS", "PLD_FEATURE_DEPTHS",
                                      "PLD_FEATURE_DEPTHS",  "PLD_FEATURE_MOTION",  "PLD_FEATURE_IDENTITY"};
  if (view == PLD_VIEW_OPACITY_DEPTH && device_.permutation.has(PLD_FEATURE_DEPTHS))
    return device_.fail(PLD_ERROR_UNSUPPORTED,
                        "pld_resolve: PLD_VIEW_OPACITY_DEPTH: sums do not tell in which order opacity grows: expected "
                        "PLD_TIER_EXACT, whose lists do, without PLD_FEATURE_LOW_RESOLUTION, whose layers are in none");
  return device_.fail(PLD_ERROR_UNSUPPORTED, "pld_resolve: view %d needs %s", static_cast<int>(view),
                      features[view - PLD_VIEW_REACTIVE]);
}

pld_status Views::check(const pld_target& target, const pld_frame& frame) {
  if (target.view < PLD_VIEW_PICTURE || target.view > PLD_VIEW_IDENTITY)
    return device_.fail(PLD_ERROR_ARGUMENT, "pld_resolve: found view %d, which pld_view does not have",
                        static_cast<int>(target.view));
  if (isOutput(target.view)) return passOf(target.view) ? PLD_OK : failOutput(target.view);
  if (target.view != PLD_VIEW_PICTURE && !(device_.info.flags & PLD_FLAG_DEBUG_VIEWS))
    return device_.fail(PLD_ERROR_UNSUPPORTED, "pld_resolve: views need PLD_FLAG_DEBUG_VIEWS");
  const bool rims = isOfRims(target.view);
  if (!isOfShadows(target.view) && !passOf(target.view))
    return device_.fail(PLD_ERROR_UNSUPPORTED, "pld_resolve: view %d needs %s", static_cast<int>(target.view),
                        rims ? "PLD_FEATURE_RIMS and a stage of rims" : "PLD_FEATURE_LOW_RESOLUTION");
  TextureFacts open;
  if (rims &&
      (!factsOf(device_.gl, frame.occlusion_texture, open) || open.width < frame.width || open.height < frame.height))
    return device_.fail(PLD_ERROR_TEXTURE, "pld_resolve: occlusion_texture %u is no longer what pld_begin saw",
                        frame.occlusion_texture);
  return PLD_OK;
}

// What it reads of the same moment is drawn before it.
void Views::draw(const PlannedPass& pass, const pld_target& target) {
  for (const PlannedPass& other : plan_.passes) {
    if (other.moment != Moment::resolve || other.lastView >= 0 || !readsOf(pass, other)) continue;
    runner_.run(other);
    target_.bindAgain(target);
  }
  runner_.run(pass, target.view);
}

pld_status Views::resolve(const pld_target& target, const pld_frame& frame, int width) {
  const GlFunctions& gl = device_.gl;
  TextureFacts colour;
  if (!device_.trusts() &&
      (!factsOf(gl, frame.colour_texture, colour) || colour.width < frame.width || colour.height < frame.height))
    return device_.fail(PLD_ERROR_TEXTURE, "pld_resolve: colour_texture %u is no longer what pld_begin saw",
                        frame.colour_texture);
  if (const pld_status status = target_.check(target, frame.width, frame.height, frame.colour_texture);
      status != PLD_OK)
    return status;
  device_.save({0, runner_.unitsOfResolve()}, -1);
  if (const pld_status status = target_.bind(target, frame.colour_texture); status != PLD_OK) {
    device_.restore();
    return status;
  }
  device_.pushGroup("pellucid resolve");
  device_.timers.mark(gl, Timers::kResolve);
  runner_.begin(frame, width);
  draw(*passOf(target.view), target);
  device_.looked = true;
  target_.unbind(target);
  device_.restore();
  device_.popGroup();
  device_.timers.mark(gl, Timers::kResolved);
  return PLD_OK;
}

pld_status Views::resolveFace(const pld_target& target) {
  if (!casters_.exist())
    return device_.fail(PLD_ERROR_ORDER, "pld_resolve: a view of shadow maps before pld_shadow_resize");
  const int face = target.shadow_face, edge = casters_.edge();
  if (face < 0 || face >= casters_.info().faces)
    return device_.fail(PLD_ERROR_ARGUMENT, "pld_resolve: shadow_face: found %d, expected 0 to %d", face,
                        casters_.info().faces - 1);
  if (!casters_.hasFace(face))
    return device_.fail(PLD_ERROR_ORDER, "pld_resolve: shadow_face %d has not been drawn", face);
  if (const pld_status status = target_.check(target, edge, edge, 0); status != PLD_OK) return status;
  device_.save({0, 1}, -1);
  if (const pld_status status = target_.bind(target, casters_.texture()); status != PLD_OK) {
    device_.restore();
    return status;
  }
  device_.pushGroup("pellucid view");
  setPlainDrawing(device_.gl, edge, edge);
  device_.allowColours(1, false);
  casters_.drawView(target.view, face);
  target_.unbind(target);
  device_.restore();
  device_.popGroup();
  return PLD_OK;
}

}  // namespace pellucid::c
