// Planes of 32-bit floats that hold no layer. A rasteriser on a CPU clears wide texels one by one and stores drawn ones by the block. Defines: the
// value of every plane there is, PLANE_0 to PLANE_7 by draw buffer.
#ifdef PLANE_0
layout(location = 0) out vec4 plane0;
#endif
#ifdef PLANE_1
layout(location = 1) out vec4 plane1;
#endif
#ifdef PLANE_2
layout(location = 2) out vec4 plane2;
#endif
#ifdef PLANE_3
layout(location = 3) out vec4 plane3;
#endif
#ifdef PLANE_4
layout(location = 4) out vec4 plane4;
#endif
#ifdef PLANE_5
layout(location = 5) out vec4 plane5;
#endif
#ifdef PLANE_6
layout(location = 6) out vec4 plane6;
#endif
#ifdef PLANE_7
layout(location = 7) out vec4 plane7;
#endif

void main() {
#ifdef PLANE_0
  plane0 = PLANE_0;
#endif
#ifdef PLANE_1
  plane1 = PLANE_1;
#endif
#ifdef PLANE_2
  plane2 = PLANE_2;
#endif
#ifdef PLANE_3
  plane3 = PLANE_3;
#endif
#ifdef PLANE_4
  plane4 = PLANE_4;
#endif
#ifdef PLANE_5
  plane5 = PLANE_5;
#endif
#ifdef PLANE_6
  plane6 = PLANE_6;
#endif
#ifdef PLANE_7
  plane7 = PLANE_7;
#endif
}
