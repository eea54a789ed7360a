// Which planes belong together, and to which picture.
#pragma once
#include <string>

#include "gbuffer/accum.h"
#include "gbuffer/gbuffer.h"

namespace pellucid {

// All throw MeaningError that names both files, what was found and what was expected. Cameras agree when sameView says
// so.

// Sums add when windows, places, camera, colour space, method, weight, normalisation, tier and solids agree. Powers of
// depth may be over other reference depths: mergePlanes() brings them to one.
void expectSamePlanes(const OitPlanes& planes, const std::string& file, const OitPlanes& before,
                      const std::string& fileBefore);

// Says that the weights of planes cannot be brought to the reference depth of those before.
[[noreturn]] void refuseReference(const OitPlanes& planes, const std::string& file, const OitPlanes& before,
                                  const std::string& fileBefore);

// Sums are of the picture's colour space, unless they were made in one that was asked for, which overrules the file's,
// or by a config's rules, which no attribute here overrules.
void expectSpaceOf(const ColourSpace& picture, const std::string& pictureFile, const OitPlanes& planes,
                   const std::string& file);

// mergePlanes (accum.h) with the names of the files in its error.
void mergePlanes(OitPlanes& a, const OitPlanes& b, const std::string& fileA, const std::string& fileB);

// Planes belong over pictures of their display window (those of places: see OitInfo::places), data window and, where
// the picture's file states one, camera. A camera that was given by --camera when the planes were made overrules the
// file's then and here.
//   camera  that took the picture: the planes' own, unless their passes see it from elsewhere
void expectPlanesOf(const GBuffer& picture, const std::string& pictureFile, const OitPlanes& planes,
                    const Camera& camera, const std::string& file);

}  // namespace pellucid
