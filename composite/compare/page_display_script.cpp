#include "composite/compare/page_frame.h"

namespace pellucid {

// Each display has OpenColorIO's own shader; a picture goes through it tile by tile, from half floats to 8 bits.
// Browsers without WebGL 2 show the curve of sRGB, and say so.
const char* const kPageDisplayScript = R"JS('use strict';
const data = JSON.parse(document.getElementById('data').textContent);
const $ = id => document.getElementById(id);
const tile = 1024;
const gl = data.displays.length ? document.createElement('canvas').getContext('webgl2') : null;
const programs = data.displays.map(display => {
  try { return gl && gl.getExtension('OES_texture_float_linear') ? programOf(display) : null; }
  catch (problem) { console.log(String(problem)); return null; }
});
function compiled(kind, text) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, text); gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}
function programOf(display) {
  const handle = gl.createProgram();
  gl.attachShader(handle, compiled(gl.VERTEX_SHADER, `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }`));
  gl.attachShader(handle, compiled(gl.FRAGMENT_SHADER, `#version 300 es
precision highp float; precision highp int; precision highp sampler2D; precision highp sampler3D;
` + display.shader + `
uniform sampler2D picture; uniform float gain; out vec4 colour;
void main() {
  vec3 light = texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb * gain;
  colour = vec4(clamp(shown(vec4(light, 1.0)).rgb, 0.0, 1.0), 1.0);
}`));
  gl.linkProgram(handle);
  if (!gl.getProgramParameter(handle, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(handle));
  return { handle, tables: display.tables.map(tableOf) };
}
function tableOf(table) {
  const kind = table.depth ? gl.TEXTURE_3D : gl.TEXTURE_2D, texture = gl.createTexture();
  const values = new Float32Array(Uint8Array.from(atob(table.data), c => c.charCodeAt(0)).buffer);
  const inner = table.channels === 1 ? gl.R32F : gl.RGB32F, format = table.channels === 1 ? gl.RED : gl.RGB;
  gl.bindTexture(kind, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  if (table.depth) gl.texImage3D(kind, 0, inner, table.width, table.height, table.depth, 0, format, gl.FLOAT, values);
  else gl.texImage2D(kind, 0, inner, table.width, table.height, 0, format, gl.FLOAT, values);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
    gl.texParameteri(kind, name, table.linear ? gl.LINEAR : gl.NEAREST);
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
    gl.texParameteri(kind, name, gl.CLAMP_TO_EDGE);
  return { kind, texture, sampler: table.sampler };
}
// The halves of a tile, red, green and blue together; what is no number is black.
function halvesOf(p, x0, y0, width, height) {
  const halves = new Uint16Array(width * height * 3);
  for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) for (let c = 0; c < 3; ++c) {
    const bits = p.bits[(c * p.height + y0 + y) * p.width + x0 + x];
    halves[3 * (y * width + x) + c] = (bits & 0x7c00) === 0x7c00 ? 0 : bits;
  }
  return halves;
}
function textureOf(unit, inner, width, height, format, kind, values) {
  const texture = gl.createTexture();
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, inner, width, height, 0, format, kind, values);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  return texture;
}
// Fills the pixels of an ImageData with what the display is sent.
function shade(program, p, gain, out) {
  gl.useProgram(program.handle);
  const place = name => gl.getUniformLocation(program.handle, name);
  program.tables.forEach((table, i) => {
    gl.activeTexture(gl.TEXTURE2 + i); gl.bindTexture(table.kind, table.texture);
    gl.uniform1i(place(table.sampler), 2 + i);
  });
  gl.uniform1i(place('picture'), 0);
  gl.uniform1f(place('gain'), gain);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  for (let y0 = 0; y0 < p.height; y0 += tile) for (let x0 = 0; x0 < p.width; x0 += tile) {
    const width = Math.min(tile, p.width - x0), height = Math.min(tile, p.height - y0);
    const halves = halvesOf(p, x0, y0, width, height);
    const from = textureOf(0, gl.RGB16F, width, height, gl.RGB, gl.HALF_FLOAT, halves);
    const to = textureOf(1, gl.RGBA8, width, height, gl.RGBA, gl.UNSIGNED_BYTE, null), frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, to, 0);
    gl.viewport(0, 0, width, height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const pixels = new Uint8Array(width * height * 4);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    for (let y = 0; y < height; ++y)
      out.set(pixels.subarray(4 * y * width, 4 * (y + 1) * width), 4 * ((y0 + y) * p.width + x0));
    gl.deleteFramebuffer(frame); gl.deleteTexture(from); gl.deleteTexture(to);
  }
}
function shownBy(p) {
  if (programs[p.display]) return 'colours by ' + data.displays[p.display].title + ', and the stops above';
  const display = data.displays[p.display];
  return display ? 'this browser has no WebGL 2 for ' + display.title + ': the curve of sRGB' : 'the curve of sRGB';
}
)JS";

}  // namespace pellucid
