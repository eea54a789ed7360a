#!/usr/bin/env bash
# The VTK sample with a weight that the offline program fits to its scene.
#   run.sh FOLDER_OF_PROGRAMS OUTDIR [FLAGS OF pellucid_vtk]
set -euo pipefail
programs=$1 out=$2
shift 2
mkdir -p "$out"
"$programs/pellucid_vtk" "$out" --write-scene "$@"
"$programs/pellucid" composite "$out/wall.exr" "$out/parts.glb" -o "$out/fitted.exr" --method weighted --weight auto --aa 1 \
  2>"$out/fit.txt" >/dev/null || { cat "$out/fit.txt" >&2; exit 1; }
flags=$(sed -n 's/.*the same again: //p' "$out/fit.txt")
flag() { sed -n "s/.*$1 \([^ ]*\).*/\1/p" <<<"$flags"; }
weight=$(flag --weight) range=$(flag --weight-range) reference=$(flag --weight-reference)
echo "fitted weight: $flags"
name=${weight%%:*}
number=${weight#"$name"}
number=${number:-:3}
exec xvfb-run -a -s "-screen 0 1920x1080x24 -noreset" "$programs/pellucid_vtk" "$out" \
  --weight "$name:${number#:}:${range:-0.5:5000}:${reference:-1}" "$@"
