// Draws a scene's casters into the C library's maps, with the same vertices as the C++ rooms do.
#pragma once
#include <memory>
#include <string>

#include "engine_bridge/scene/light_views.h"
#include "engine_bridge/scene/scene.h"
#include "tests/bridge/host.h"

namespace pellucid::test {

constexpr pld_shadow_form kShadowForms[] = {PLD_SHADOW_VARIANCE, PLD_SHADOW_PUBLISHED, PLD_SHADOW_NAIVE,
                                            PLD_SHADOW_STRATIFIED, PLD_SHADOW_CORRECTED};

// Room for the maps of a scene's lights.
pld_shadow_info shadowInfo(pld_shadow_form form, int size, int lights, int faces, bool coloured);

// Straight along -z, 2 wide, casters from 1 to 3.
pld_shadow_view plainShadowView();
// That one as light 0, and the six faces of a lamp, light 1.
std::vector<pld_shadow_view> sunAndLampViews();
// The main() of a caster that hides half of three quarters, a half and a quarter of the light, at a distance of 2.
extern const char* const kPlainCaster;

// Views of a light as the C++ rooms choose them for ShadowMapSettings::size; six have half the edge. Empty when nothing
// casts.
std::vector<pld_shadow_view> shadowViews(const Scene& scene, const Camera& camera, std::size_t light, int firstFace,
                                         int size);

// Draws what a view sees, between a begin and an end of its own. Expects all calls to succeed.
//   view  one of shadowViews(), by the same arguments
void drawCasters(pld_pass* pass, const pld_shadow_view& view, const Scene& scene, std::size_t light, int size);

// pldShadow() or, `onOpaque`, pldShadowOnOpaque(), of points, asked by a fragment shader.
std::vector<float> askShadows(pld_pass* pass, const pld_shadow_info& info, int light, const std::vector<float>& points,
                              bool onOpaque, int version = 450);

// The texels of a map, by layers.
std::vector<float> shadowTexels(pld_pass* pass, int edge, int layers);

}  // namespace pellucid::test
