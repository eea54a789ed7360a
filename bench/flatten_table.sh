#!/bin/bash
# Flattening unsorted deep EXRs, 1920x1080, half R G B A and float Z: time and peak memory of ours and of oiiotool, for 4, 16
# and 64 samples a pixel. Whole processes, half out; the least of three runs each, taken in turn.
#   flatten_table.sh PELLUCID DEEPGEN WORKDIR     DEEPGEN OUT.exr W H N makes the files; WORKDIR best on a RAM disk
set -eu
pellucid=$1 deepgen=$2 work=$3
mkdir -p "$work"
measure() { # name, command...: seconds and MB, the least so far in $work/NAME
  local name=$1; shift
  /usr/bin/time -f "%e %U %M" -o "$work/now" "$@" >/dev/null 2>&1
  cat "$work/now" >>"$work/$name"
}
least() { awk -v k="$2" 'NR == 1 || $k < m { m = $k } END { print m }' "$work/$1"; }
printf '%-8s %-30s %9s %9s %9s\n' samples program seconds cpu 'peak MB'
for n in ${SAMPLES:-4 16 64}; do
  "$deepgen" "$work/deep.exr" 1920 1080 "$n" zips 1
  rm -f "$work"/ours "$work"/flatten "$work"/merge
  for _ in ${RUNS:-1 2 3}; do
    measure ours "$pellucid" flatten "$work/deep.exr" --type half -o "$work/ours.exr"
    measure flatten oiiotool "$work/deep.exr" --flatten -d half --compression none -o "$work/theirs.exr"
  done
  for row in "ours:pellucid flatten" "flatten:oiiotool --flatten (unsorted)"; do
    name=${row%%:*}
    printf '%-8s %-30s %9s %9s %9.0f\n' "$n" "${row#*:}" "$(least "$name" 1)" "$(least "$name" 2)" \
      "$(awk -v k="$(least "$name" 3)" 'BEGIN { print k / 1024 }')"
  done
done
rm -f "$work/deep.exr" "$work/ours.exr" "$work/theirs.exr"
