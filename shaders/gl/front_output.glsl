#pragma once
// The planes of the nearest layer, beside the sums of the others, whose outputs come before.
#include "shared/front_tail.glsl"

#define WRITE_FRONT(type, plane, field) plane = front ? type(targets.field) : type(0.0f);

// A layer to the planes of the nearest, or none.
void writeFront(FrontTargets targets, bool front) {
  FRONT_PLANES(WRITE_FRONT)
}

// One layer to the planes of the nearest, or to the sums of the others.
void writeFrontOrTail(Layer layer, WeightSettings settings, bool front) {
  OitSums sums = layerSums(layer, settings, NORMALISATION);
  writeFront(packFront(layer, sums.depth), front);
  writeOitSums(sums, layer.z);
  if (front) writeNothing();
#ifdef NEAREST_Z
  NEAREST_Z = layer.z;  // of all layers
#endif
}
