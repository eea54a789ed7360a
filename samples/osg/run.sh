#!/usr/bin/env bash
# The OpenSceneGraph sample against the offline program's pictures of the same opaque EXR and the same glass.
#   run.sh FOLDER_OF_PROGRAMS OUTDIR [FLAGS OF pellucid_osg]
set -euo pipefail
programs=$1 out=$2
shift 2
mkdir -p "$out"
"$programs/pellucid_osg" "$out" --write-scene "$@"
offline() {
  "$programs/pellucid" composite "$out/opaque.exr" "$out/glass.glb" -o "$out/offline-$1.exr" --method "$1" --aa 1 \
    --environment 0.62,0.66,0.72 "${@:2}" >"$out/offline-$1.txt" 2>&1 || { cat "$out/offline-$1.txt" >&2; exit 1; }
}
offline over --refract off --diffusion off
offline weighted --weight-range 0.1:100 --refract off --diffusion off
offline front+tail --weight-range 0.1:100 --refract off --diffusion off
offline phenomenological --weight-range 0.1:100
exec "$programs/pellucid_osg" "$out" "$@"
