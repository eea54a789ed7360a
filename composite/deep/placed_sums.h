// Sums over a deep picture: planes of its places, one for each of its samples and one for what each pixel shows beyond
// them, so that two steps give the picture of one.
#pragma once
#include <string>

#include "composite/deep/deep_opaque.h"
#include "composite/resolve.h"

namespace pellucid {

// Places in rows as wide as the picture; the last row may have some that nothing uses.
Window placesWindow(const DeepOpaque& opaque);

// How many places there are, and a hash of the samples' depths: what planes of places say of the picture that they
// belong to.
std::string placesText(const DeepOpaque& opaque);

// Puts the sums of a row's entries at their places.
//   sums    of row.lists
//   placed  of placesWindow(), and of the same tier
void putAtPlaces(const HeldOutRow& row, const OitPlanes& sums, OitPlanes& placed);

// All places as the entries of one row, without lists; in front of none a layer bends.
HeldOutRow rowOfPlaces(const DeepOpaque& opaque);

// The veil of the picture from that of its places.
//   places      of rowOfPlaces(), with what bends
//   scatter     what looks the background up elsewhere, of the picture's data window; null where nothing does
//   background  the picture flattened
Veil veilOfPlaces(const HeldOutRow& places, const Veil& placed, const OitPlanes* scatter, const LookupSettings& lookup,
                  const DeepOpaque& opaque, const GBuffer& background);

// The same from sums.
//   scatter  without planes of scattering where nothing looks elsewhere
Veil resolvePlaces(const OitPlanes& placed, const OitPlanes& scatter, const ResolveSettings& settings,
                   const LookupSettings& lookup, const DeepOpaque& opaque, const GBuffer& background);

}  // namespace pellucid
