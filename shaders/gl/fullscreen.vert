// One triangle over the whole viewport.
void main() {
  vec2 corner = vec2((gl_VertexID & 1) << 2, (gl_VertexID & 2) << 1) - vec2(1.0f);
  gl_Position = vec4(corner, 0.5f, 1.0f);
}
