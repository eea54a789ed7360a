// Light of what glows because it is hot.
#pragma once
#include <glm/glm.hpp>

namespace pellucid {

constexpr double kHottest = 1e5;  // kelvin

// Radiance of a black body by Planck's law, as the CIE 1931 observer sees it: linear Rec.709, whose luminance is lumens
// over 683, W/(sr m^2) as lamps have them. Below about 1000 K and above some 1e4 K a channel is less than 0: no display
// of Rec.709 shows so pure a colour. 0 at 0 K.
//   kelvin  0 to kHottest
glm::dvec3 blackbodyRadiance(double kelvin);

}  // namespace pellucid
