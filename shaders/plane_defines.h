// What shaders/gl is told of the planes: defines for the stages that write or read them. Lists of planes are macros
// that take a macro, as in `SUM_PLANES(F) F(vec4, radianceSum, radiance) ...`.
//
//   PLANE_OUTPUTS      declares the outputs            PLANE_SAMPLERS  declares the samplers of the same names
//   SUM_PLANES(F)      F(type, plane, field): what gl/packing.glsl packs, field of OitTargets
//   FRONT_PLANES(F)    the same of the nearest layer, field of FrontTargets
//   SCATTER_PLANES(F)  F(plane, texels, around, scale): what scattering adds besides; scale by `factor` pixels a texel
//   ADDED_PLANES(F)    F(type, plane): all that add; ADDED_PLANE_COUNT of them
//   HALF_PLANES(F)     F(place, type): what is added in half floats
//   EMPTY_PLANES(F)    F(type, plane, value)
//   MARK_OUTPUTS       as PLANE_OUTPUTS, of PlaneStage::marks or solidMarks; may be empty
//   NEAREST_Z          place of the nearest depth, where it is kept
//   REFRACTION_Z(P), DIFFUSE_Z(P)  depths of what scatters: P(plane).component
//
// and what the layers are: SORTED, GREY, AVERAGED_ONLY, HALF, PUBLISHED, FRONT_TAIL, SCATTER, DISPERSION,
// DIFFUSE_IN_ALPHA, as in LayerModel; WEIGHT, NORMALISATION; for readers LIGHT_TARGET, NO_SOLIDS, HALF_SUMS, LOW_OVER.
#pragma once
#include <string>
#include <vector>

#include "shaders/plane_layout.h"

namespace pellucid {

// Of a stage that writes planes: gl/sums_output.glsl, front_output, published_output, rims_output.
std::vector<std::string> writeDefines(const LayerModel& model, PlaneStage stage = PlaneStage::layers);
// WEIGHT and NORMALISATION alone.
std::vector<std::string> weightDefines(const LayerModel& model);
// Of gl/resolve_here.glsl and lookup.glsl.
//   showsThrough  false for stages that look at a pixel's layers and not at the background behind them
std::vector<std::string> readDefines(const LayerModel& model, bool showsThrough = true);
// Of gl/upsample.frag: the sums of `low` as texels, entered into the planes of `model`.
std::vector<std::string> upsampleDefines(const LayerModel& model, const LayerModel& low);
// MARK_OUTPUTS.
std::string markOutputs(const LayerModel& model, PlaneStage stage);
// Of gl/empty_planes.frag.
std::vector<std::string> emptyDefines(const LayerModel& model);
// RIM_SAMPLERS, which gl/rims_apply.frag and view_rims.frag take besides what readers do.
//   firstUnit  of the first plane of rims; below 0: their own
std::string rimSamplers(int firstUnit = -1);
// Of gl/exact_fold.frag and of stages that list fragments for it: whether a record has an offset.
bool listsOffsets(const LayerModel& model, PlaneStage stage);
// Blocks of gl/exact_lists.glsl in the order of their bindings; the lists of a stage take so many of them.
const char* listBlockName(int block);
int listBlocks(const LayerModel& model, PlaneStage stage);

}  // namespace pellucid
