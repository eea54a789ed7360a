#!/usr/bin/env bash
# The engine's window under Xvfb against the frame that it draws without one.
#   window.sh FOLDER_OF_PROGRAMS OUTDIR
set -euo pipefail
programs=$1 out=$2
mkdir -p "$out/headless" "$out/window"
"$programs/pellucid_samples" "$out" ball 180 >/dev/null
"$programs/pellucid_engine" "$out/ball.glb" "$out/headless" 320x180
xvfb-run -a -s "-screen 0 1920x1080x24 -noreset" "$programs/pellucid_engine" "$out/ball.glb" "$out/window" 320x180 phenomenological window:3
# The frame: the same bits. What the window shows: the frame as sRGB of 8 bits, the driver's own conversion, within one step.
"$programs/pellucid" compare "$out/headless/frame.exr" "$out/window/frame.exr" --fail 0 >"$out/compare.txt" || { cat "$out/compare.txt"; exit 1; }
oiiotool "$out/headless/frame.exr" --ch R,G,B --clamp:min=0:max=1 --tocolorspace sRGB -o "$out/frame-srgb.exr"
oiiotool "$out/window/window.exr" --ch R,G,B -o "$out/window-rgb.exr"
oiiotool --fail .00393 --warn .00393 "$out/frame-srgb.exr" "$out/window-rgb.exr" --diff
