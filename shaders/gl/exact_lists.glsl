#pragma once
// The fragments of a stage of the exact tier, linked per pixel in whatever order they came.
PLD_STORAGE_0 buffer PldLinks {
  uint pldFragmentCount;  // that came, those without room among them
  uint pldLinks[];        // 1 + a place, 0 for none: each pixel's newest fragment, then what each place came after
};
PLD_STORAGE_1 buffer PldRadiances { vec4 pldRadiances[]; };          // radiance, coverage
PLD_STORAGE_2 buffer PldTransmissions { vec4 pldTransmissions[]; };  // transmission, z
#ifdef LISTS_OFFSETS
PLD_STORAGE_3 buffer PldOffsets { vec4 pldOffsets[]; };  // offset, variance; of rims the gradient
#endif
#ifdef DISPERSION
PLD_STORAGE_4 buffer PldDispersions { vec4 pldDispersions[]; };
#endif

uint listRoom() { return uint(pldRadiances.length()); }

// Of pldLinks: where that of a place stands.
uint linkOf(uint place) { return uint(pldLinks.length()) - listRoom() + place; }

//   rowLength  pixels of a row, of the largest picture
uint headHere(uint rowLength) { return uint(gl_FragCoord.y) * rowLength + uint(gl_FragCoord.x); }
