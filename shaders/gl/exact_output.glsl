#pragma once
// Appends one layer to its pixel's list. The sums are made of the lists when the stage ends: gl/exact_fold.frag.
#include "gl/exact_lists.glsl"
#ifdef PLD_MARKS
#ifdef LISTS_MARKS
#include "gl/listed_marks.glsl"
#endif
#endif

// What stands behind the opaque must not be written down.
layout(early_fragment_tests) in;

// Beyond the room fragments are counted, so that the host learns of them; the count cannot run over.
const uint kMostCounted = 0x80000000u;

//   offset  and variance, or the gradient of a rim
void appendLayer(Layer layer, vec4 offset, vec4 dispersion, uint rowLength) {
  uint place = atomicAdd(pldFragmentCount, 1u);
  if (place >= listRoom()) {
    atomicMin(pldFragmentCount, kMostCounted);
    return;
  }
  pldRadiances[place] = vec4(layer.radiance, layer.coverage);
  pldTransmissions[place] = vec4(layer.transmission, layer.z);
#ifdef LISTS_OFFSETS
  pldOffsets[place] = offset;
#endif
#ifdef DISPERSION
  pldDispersions[place] = dispersion;
#endif
#ifdef PLD_MARKS
#ifdef LISTS_MARKS
  pldMarks[place] = seamMarks;
#endif
#endif
  pldLinks[linkOf(place)] = atomicExchange(pldLinks[headHere(rowLength)], place + 1u);
}
