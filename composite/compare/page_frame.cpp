#include "composite/compare/page_frame.h"

namespace pellucid {

const char* const kPageHead = R"HTML(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<style>
body { font: 14px/1.45 system-ui, sans-serif; margin: 1.5em auto; max-width: 1500px; padding: 0 1em; background: #16181c; color: #dde; }
h1 { font-size: 1.3em; } h2 { font-size: 1.1em; margin-top: 1.5em; } p { margin: .2em 0; }
table { border-collapse: collapse; } td, th { padding: .15em .7em; border-bottom: 1px solid #333; text-align: right; white-space: nowrap; }
td:first-child, th:first-child { text-align: left; }
.views { display: flex; gap: 12px; flex-wrap: wrap; } .views figure { margin: 0; flex: 1 1 560px; }
canvas { width: 100%; background: #000; display: block; cursor: grab; touch-action: none; } #legend { height: 34px; cursor: default; }
.controls { display: flex; flex-wrap: wrap; gap: 1em; margin: .8em 0; align-items: center; }
#readout { font: 12px ui-monospace, monospace; min-height: 3.2em; white-space: pre; } svg { max-width: 100%; background: #fff; margin-top: 1em; }
select, button { background: #2a2d33; color: #dde; border: 1px solid #555; padding: .2em .4em; }
</style>
)HTML";

const char* const kPageViews = R"HTML(<div class="controls">
<label>left <select id="left"></select></label><label>right <select id="right"></select></label>
<label>split <input id="split" type="range" min="0" max="1" step="0.001" value="0.5"></label>
<label>exposure <input id="exposure" type="range" min="-10" max="10" step="0.25" value="0"> <span id="stops">0</span></label>
<label>error scale 1e<input id="scale" type="range" min="-5" max="1" step="1" value="0"> <span id="scaletext">0</span></label>
<button id="reset">whole picture</button></div>
<div class="views"><figure><canvas id="view"></canvas><figcaption>left and right of the split; drag moves, the wheel zooms both views; <span id="shownby"></span></figcaption></figure>
<figure><canvas id="heat"></canvas><canvas id="legend"></canvas><figcaption>largest |left - right| of a channel, logarithmic; grey is exactly 0, magenta is not finite in one</figcaption></figure></div>
<div id="readout"></div>
)HTML";

const char* const kPageScript = R"JS(
const toFloat = new Float32Array(65536);
for (let h = 0; h < 65536; ++h) {
  const s = h & 0x8000 ? -1 : 1, e = h >> 10 & 31, m = h & 1023;
  toFloat[h] = e === 31 ? (m ? NaN : s * Infinity) : e ? s * 2 ** (e - 15) * (1 + m / 1024) : s * 2 ** -14 * (m / 1024);
}
async function unpack(picture) {
  const bytes = Uint8Array.from(atob(picture.data), c => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  const plain = new Uint8Array(await new Response(stream).arrayBuffer());
  const n = picture.width * picture.height * 3;
  const bits = new Uint16Array(n);
  for (let i = 0; i < n; ++i) bits[i] = plain[i] | plain[n + i] << 8;
  picture.bits = bits;
  delete picture.data;
}
function valueAt(picture, x, y, c) { return toFloat[picture.bits[(c * picture.height + y) * picture.width + x]]; }
function display(v) {
  if (!(v > 0)) return 0;
  if (v >= 1) return 255;
  return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
}
const state = { left: data.left, right: data.right, split: 0.5, exposure: data.exposure, scale: 0, zoom: 1,
  x: 0, y: 0 };
const cache = new Map();
function bitmap(key, width, height, fill) {
  if (cache.has(key)) return cache.get(key);
  const canvas = document.createElement('canvas');
  canvas.width = width; canvas.height = height;
  const context = canvas.getContext('2d'), image = context.createImageData(width, height);
  fill(image.data);
  context.putImageData(image, 0, 0);
  if (cache.size > 6) cache.delete(cache.keys().next().value);
  cache.set(key, canvas);
  return canvas;
}
function exposed(index) {
  const p = data.pictures[index], n = p.width * p.height, gain = 2 ** state.exposure;
  return bitmap('p' + index + ':' + state.exposure, p.width, p.height, out => {
    if (programs[p.display]) return shade(programs[p.display], p, gain, out);
    const shown = new Uint8ClampedArray(65536);
    for (let h = 0; h < 65536; ++h) shown[h] = display(toFloat[h] * gain);
    for (let i = 0; i < n; ++i) {
      for (let c = 0; c < 3; ++c) out[4 * i + c] = shown[p.bits[c * n + i]];
      out[4 * i + 3] = 255;
    }
  });
}
const ramp = [[0, 0, 4], [40, 11, 84], [101, 21, 110], [159, 42, 99], [212, 72, 66], [245, 125, 21], [250, 193, 39], [252, 255, 164]];
function colour(t) {
  t = Math.min(Math.max(t, 0), 1) * (ramp.length - 1);
  const i = Math.min(Math.floor(t), ramp.length - 2), f = t - i;
  return [0, 1, 2].map(c => ramp[i][c] + f * (ramp[i + 1][c] - ramp[i][c]));
}
const decades = 4;
function heatOf(a, b) {
  const p = data.pictures[a], q = data.pictures[b];
  const width = Math.min(p.width, q.width), height = Math.min(p.height, q.height);
  return bitmap('h' + a + ',' + b + ':' + state.scale, width, height, out => {
    for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) {
      let worst = 0, odd = false;
      for (let c = 0; c < 3; ++c) {
        const u = valueAt(p, x, y, c), v = valueAt(q, x, y, c);
        if (Number.isFinite(u) && Number.isFinite(v)) worst = Math.max(worst, Math.abs(u - v));
        else if (!Object.is(u, v)) odd = true;
      }
      const t = (Math.log10(worst) - state.scale + decades) / decades;
      const rgb = odd ? [255, 0, 255] : worst === 0 ? [60, 60, 60] : colour(t);
      out.set([rgb[0], rgb[1], rgb[2], 255], 4 * (y * width + x));
    }
  });
}
function place(canvas, picture) {
  canvas.width = Math.max(64, Math.round(canvas.clientWidth || 640));
  canvas.height = Math.round(canvas.width * picture.height / picture.width);
  const context = canvas.getContext('2d');
  context.imageSmoothingEnabled = false;
  return [context, canvas.width / picture.width * state.zoom];
}
function drawAt(context, source, k) { context.drawImage(source, -state.x * k, -state.y * k, source.width * k, source.height * k); }
function draw() {
  const p = data.pictures[state.left];
  $('shownby').textContent = shownBy(p);
  const [view, k] = place($('view'), p), edge = state.split * $('view').width;
  for (const [index, from, to] of [[state.left, 0, edge], [state.right, edge, $('view').width]]) {
    view.save(); view.beginPath(); view.rect(from, 0, to - from, $('view').height); view.clip();
    drawAt(view, exposed(index), k); view.restore();
  }
  view.fillStyle = '#ff0'; view.fillRect(edge - 0.5, 0, 1, $('view').height);
  const [heat, kh] = place($('heat'), p);
  drawAt(heat, heatOf(state.left, state.right), kh);
  drawLegend();
  $('stops').textContent = (state.exposure > 0 ? '+' : '') + state.exposure;
  $('scaletext').textContent = state.scale;
}
function drawLegend() {
  const canvas = $('legend');
  canvas.width = $('heat').width; canvas.height = 34;
  const context = canvas.getContext('2d');
  context.fillStyle = '#16181c'; context.fillRect(0, 0, canvas.width, 34);
  for (let x = 0; x < canvas.width; ++x) {
    context.fillStyle = 'rgb(' + colour(x / (canvas.width - 1)).map(Math.round).join(',') + ')';
    context.fillRect(x, 0, 1, 16);
  }
  context.fillStyle = '#dde'; context.font = '12px sans-serif';
  for (let d = 0; d <= decades; ++d) {
    context.textAlign = d === 0 ? 'left' : d === decades ? 'right' : 'center';
    context.fillText('1e' + (state.scale - decades + d), d / decades * canvas.width, 30);
  }
}
function pixelAt(canvas, event) {
  const box = canvas.getBoundingClientRect(), p = data.pictures[state.left], k = box.width / p.width * state.zoom;
  return [Math.floor((event.clientX - box.left) / k + state.x), Math.floor((event.clientY - box.top) / k + state.y)];
}
function readout(x, y) {
  const line = index => {
    const p = data.pictures[index];
    if (x < 0 || y < 0 || x >= p.width || y >= p.height) return '';
    return p.name.padEnd(28) + [0, 1, 2].map(c => valueAt(p, x, y, c).toPrecision(6).padStart(12)).join('') + '\n';
  };
  $('readout').textContent = 'pixel (' + x + ', ' + y + ')\n' + line(state.left) + line(state.right);
}
function clampPan() {
  const p = data.pictures[state.left];
  state.x = Math.min(Math.max(state.x, 0), p.width * (1 - 1 / state.zoom));
  state.y = Math.min(Math.max(state.y, 0), p.height * (1 - 1 / state.zoom));
}
function wire() {
  for (const side of ['left', 'right']) {
    data.pictures.forEach((p, i) => $(side).add(new Option(p.name, i)));
    $(side).value = state[side];
    $(side).oninput = () => { state[side] = +$(side).value; draw(); };
  }
  $('exposure').min = Math.min(-10, data.exposure); $('exposure').max = Math.max(10, data.exposure);
  $('exposure').value = data.exposure;
  for (const name of ['split', 'exposure', 'scale']) $(name).oninput = () => { state[name] = +$(name).value; draw(); };
  $('reset').onclick = () => { state.zoom = 1; state.x = state.y = 0; draw(); };
  for (const canvas of [$('view'), $('heat')]) {
    let grabbed = null;
    canvas.onpointerdown = e => { grabbed = [e.clientX, e.clientY]; canvas.setPointerCapture(e.pointerId); };
    canvas.onpointerup = () => { grabbed = null; };
    canvas.onpointermove = e => {
      readout(...pixelAt(canvas, e));
      if (!grabbed) return;
      const k = canvas.getBoundingClientRect().width / data.pictures[state.left].width * state.zoom;
      state.x -= (e.clientX - grabbed[0]) / k; state.y -= (e.clientY - grabbed[1]) / k;
      grabbed = [e.clientX, e.clientY];
      clampPan(); draw();
    };
    canvas.onwheel = e => {
      e.preventDefault();
      const box = canvas.getBoundingClientRect(), p = data.pictures[state.left];
      const u = (e.clientX - box.left) / box.width * p.width, v = (e.clientY - box.top) / box.width * p.width;
      const before = state.zoom;
      state.zoom = Math.min(Math.max(state.zoom * (e.deltaY < 0 ? 1.25 : 0.8), 1), 64);
      state.x += u / before - u / state.zoom; state.y += v / before - v / state.zoom;
      clampPan(); draw();
    };
  }
  window.onresize = draw;
}
window.pellucid = { data, state, draw, valueAt, exposed, programs,
  ready: Promise.all(data.pictures.map(unpack)).then(() => { wire(); draw(); }) };
)JS";

}  // namespace pellucid
