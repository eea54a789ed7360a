#include "engine_bridge/c/views.h"

#include "engine_bridge/c/host_textures.h"

namespace pellucid::c {

std::string Views::build() {
  const std::vector<std::string> defines = resolveDefines(device_.permutation);
  std::string failure = picture_.build(device_.gl, "gl/picture.frag", defines);
  if (failure.empty() && device_.permutation.outputs())
    failure = outputs_.build(device_.gl, "gl/outputs.frag", defines);
  if (!failure.empty() || !(device_.info.flags & PLD_FLAG_DEBUG_VIEWS)) return failure;
  failure = view_.build(device_.gl, "gl/view.frag", defines);
  if (failure.empty()) failure = rims_.buildView();
  if (failure.empty()) failure = low_.buildView();
  return failure;
}

void Views::destroy() {
  picture_.destroy(device_.gl);
  view_.destroy(device_.gl);
  outputs_.destroy(device_.gl);
  target_.destroy();
}

pld_status Views::check(const pld_target& target, const pld_frame& frame) {
  if (target.view < PLD_VIEW_PICTURE || target.view > PLD_VIEW_NEAREST_DEPTH)
    return device_.fail(PLD_ERROR_ARGUMENT, "pld_resolve: found view %d, which pld_view does not have",
                        static_cast<int>(target.view));
  if (isOutput(target.view)) {
    if (device_.permutation.outputs()) return PLD_OK;
    return device_.fail(PLD_ERROR_UNSUPPORTED, "pld_resolve: view %d needs PLD_FEATURE_OUTPUTS",
                        static_cast<int>(target.view));
  }
  if (target.view != PLD_VIEW_PICTURE && !(device_.info.flags & PLD_FLAG_DEBUG_VIEWS))
    return device_.fail(PLD_ERROR_UNSUPPORTED, "pld_resolve: views need PLD_FLAG_DEBUG_VIEWS");
  const bool rims = isOfRims(target.view);
  if ((rims && !device_.permutation.rimsApart()) || (isOfLow(target.view) && !device_.permutation.low()))
    return device_.fail(PLD_ERROR_UNSUPPORTED, "pld_resolve: view %d needs %s", static_cast<int>(target.view),
                        rims ? "PLD_FEATURE_RIMS and a stage of rims" : "PLD_FEATURE_LOW_RESOLUTION");
  TextureFacts open;
  if (rims &&
      (!factsOf(device_.gl, frame.occlusion_texture, open) || open.width < frame.width || open.height < frame.height))
    return device_.fail(PLD_ERROR_TEXTURE, "pld_resolve: occlusion_texture %u is no longer what pld_begin saw",
                        frame.occlusion_texture);
  return PLD_OK;
}

Units Views::units() const {
  const Permutation& p = device_.permutation;
  const bool views = p.rimsApart() && (device_.info.flags & PLD_FLAG_DEBUG_VIEWS);
  return {0, p.scatters() || p.lowOver() || views ? kLookupUnits : kSpreadUnit};
}

void Views::bindPlanes(GLuint background) const {
  device_.bind(kBackgroundUnit, background);
  c::bindPlanes(device_, planes_.layers());
  if (planes_.planarZ()) device_.bind(kOpaqueZUnit, planes_.planarZ());
  if (planes_.solid()) device_.bind(kSolidUnit, planes_.solid());
  low_.bindOver();
}

// The pyramid that the background is spread by, from the planes that are bound.
void Views::drawSpread(const pld_target& target, const pld_frame& frame) {
  spread_.bind();
  device_.allowColours(1, true);
  spread_.draw(frame.width, frame.height);
  setViewportTo(device_.gl, 0, 0, frame.width, frame.height);
  device_.allowColours(1, false);
  target_.bindAgain(target);
}

void Views::drawSums(pld_view view, const pld_frame& frame) const {
  const GlFunctions& gl = device_.gl;
  const Program& program = view == PLD_VIEW_PICTURE ? picture_ : isOutput(view) ? outputs_ : view_;
  device_.use(program);
  gl.Uniform2i(program.place(gl, "pictureSize"), frame.width, frame.height);
  gl.Uniform1i(program.place(gl, "view"), static_cast<GLint>(view));
  spread_.setUniforms(program, frame.width, frame.height);
  device_.drawEverywhere();
}

pld_status Views::resolve(const pld_target& target, const pld_frame& frame) {
  const GlFunctions& gl = device_.gl;
  TextureFacts colour;
  if (!device_.trusts() &&
      (!factsOf(gl, frame.colour_texture, colour) || colour.width < frame.width || colour.height < frame.height))
    return device_.fail(PLD_ERROR_TEXTURE, "pld_resolve: colour_texture %u is no longer what pld_begin saw",
                        frame.colour_texture);
  if (const pld_status status = target_.check(target, frame.width, frame.height, frame.colour_texture);
      status != PLD_OK)
    return status;
  device_.save(units(), -1);
  if (const pld_status status = target_.bind(target, frame.colour_texture); status != PLD_OK) {
    device_.restore();
    return status;
  }
  device_.pushGroup("pellucid resolve");
  device_.timers.mark(gl, Timers::kResolve);
  setPlainDrawing(gl, frame.width, frame.height);
  device_.allowColours(1, false);
  bindPlanes(frame.colour_texture);
  if (isOfRims(target.view)) {
    rims_.drawView(target.view, frame);
  } else if (isOfLow(target.view)) {
    low_.drawView(target.view, frame);
  } else {
    if (spread_.exist()) drawSpread(target, frame);
    drawSums(target.view, frame);
  }
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
