#pragma once
// What a layer tells besides what it looks like: motion and identity. Of the exact tier lists hold it, and
// gl/exact_marks.frag makes the plane of them.
#ifdef MARKS_HERE
#include "gl/mark_share.glsl"
#endif
MARK_OUTPUTS

// Before pldWriteLayer(); pldWriteFragment() sees to it itself.
//   motion    pixels, y down
//   identity  of the object, at most 16777215; 0 for none
void pldMark(vec2 motion, uint identity) {
  const float kMost = 65536.0f;
  seamMarks = vec4(clamp(motion, vec2(-kMost), vec2(kMost)), 0.0f, float(min(identity, 16777215u)));
}

#ifdef MARKS_HERE
void writeMarks(Layer layer) {
#ifdef NEAREST_HERE
  // As isFront() of shared/front_tail.glsl.
  precise float most = seamFrontZ * 1.000001f;
  float identity = layer.z <= most ? seamMarks.w : intBitsToFloat(0x7f800000);
#else
  float identity = 0.0f;
#endif
#ifdef MOTION
  float share = markShare(layer.coverage, layer.transmission);
  precise vec2 moved = share * seamMarks.xy;
  layerMarks = vec4(moved, share, identity);
#else
  layerMarks = identity;
#endif
}
#endif
