// Planes of 32-bit floats that hold no layer. A rasteriser on a CPU clears wide texels one by one and stores drawn ones
// by the block. Defines: PLANE_OUTPUTS, EMPTY_PLANES of shaders/plane_defines.h.
PLANE_OUTPUTS

#define EMPTY(type, plane, value) plane = value;

void main() {
  EMPTY_PLANES(EMPTY)
}
