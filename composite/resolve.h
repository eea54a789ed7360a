// Sums to a veil (shaders/shared/resolve.glsl), and a veil over a background to the picture.
#pragma once
#include <glm/glm.hpp>
#include <string>

#include "composite/gather.h"
#include "composite/veil.h"
#include "gbuffer/accum.h"
#include "gbuffer/fragments.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// How a pixel's sums become a colour: the model's weighted mean; or WB13 eqs. 3 and 4, of sums without a weight.
enum class SumFormula { mean, sum, average };
// By the method that planes name in their header.
SumFormula formulaOf(const std::string& method);

struct ResolveSettings {
  bool selfModulation = false;  // PT17 eq. 14; a heuristic for the published normalisation
  SumFormula formula = SumFormula::mean;
};

Veil resolve(const OitPlanes& planes, const ResolveSettings& settings);

// Where layers refract or diffuse, a solid is part of the background that they look up: it is taken out of the sums or
// lists before they are resolved, after backdropOf() has seen it. Fragments behind it leave the lists.
//   planes  hold what scatters in the lists' pixels
void hideSolids(OitPlanes& planes);
void hideSolids(FragmentLists& lists, const OitPlanes& planes);
// Whether that changes the lists.
bool hidesSolids(const FragmentLists& lists, const OitPlanes& planes);

// Applies the background to the pixels of the veil that refract or diffuse; the others are left alone.
//   top  row of the lookups' planes that is the veil's first
void showThrough(const Lookups& lookups, Veil& veil, int top = 0);
// The same for one that does.
void showThroughAt(const Lookups& lookups, int x, int y, Veil& veil, int top = 0);

// The steps above in their order, of planes of all of the background's window or of a part of it.
//   edges  of the background; null: none are known
Veil resolveOver(OitPlanes planes, const ResolveSettings& settings, const LookupSettings& lookup,
                 const GBuffer& background, const EdgeTexels* edges = nullptr);

struct Picture {
  Image<glm::vec4> rgba;  // scene-linear, premultiplied; equals the background where touched is 0
  Image<std::uint8_t> touched;
};

// Non-finite background colours stay in their own pixel; behind a solid they are hidden like any other.
Picture compose(const Veil& veil, const GBuffer& background);

}  // namespace pellucid
