#pragma once
// Beside gl/exact_lists.glsl, of passes that tell motion or identity.
LISTS_MARKS buffer PldMarks { vec4 pldMarks[]; };  // motion in pixels, y down; unused; identity
