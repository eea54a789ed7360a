#!/bin/bash
# Flattening unsorted deep EXRs, 1920x1080, half R G B A and float Z: time, CPU and peak memory of ours and of oiiotool, for
# 4, 16 and 64 samples a pixel in one file, and in two of half as many (what --deepmerge takes, which sorts; --flatten alone
# does not). Whole processes, half out, ZIP; the least of RUNS runs each (3), taken in turn.
#   flatten_table.sh [WORKDIR]     best on a RAM disk; SAMPLES="4 16" leaves some out
set -eu
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=${1:-$here/build/flatten}
pellucid=$here/build/bin/pellucid deepfile=$here/build/bin/measure_deep_file
mkdir -p "$work"
trap 'rm -f "$work"/*.exr "$work"/{now,one,two,flatten,merge}' EXIT
measure() { # name, command...: seconds, CPU seconds and KiB of one run go to $work/NAME
  local name=$1
  shift
  /usr/bin/time -f "%e %U %S %M" -o "$work/now" "$@" >/dev/null
  awk '{ print $1, $2 + $3, $4 }' "$work/now" >>"$work/$name"
}
least() { awk -v k="$2" 'NR == 1 || $k < m { m = $k } END { print m }' "$work/$1"; }
printf '%-8s %-34s %9s %9s %9s\n' samples program seconds cpu 'peak MB'
for n in ${SAMPLES:-4 16 64}; do
  "$deepfile" "$work/deep.exr" 1920 1080 "$n" 1
  "$deepfile" "$work/a.exr" 1920 1080 $((n / 2)) 2
  "$deepfile" "$work/b.exr" 1920 1080 $((n / 2)) 3
  rm -f "$work"/{one,two,flatten,merge}
  for ((run = 0; run < ${RUNS:-3}; ++run)); do
    measure one "$pellucid" flatten "$work/deep.exr" --type half -o "$work/ours.exr"
    measure flatten oiiotool "$work/deep.exr" --flatten -d half --compression zip -o "$work/theirs.exr"
    measure two "$pellucid" flatten "$work/a.exr" "$work/b.exr" --type half -o "$work/ours.exr"
    measure merge oiiotool "$work/a.exr" "$work/b.exr" --deepmerge --flatten -d half --compression zip -o "$work/theirs.exr"
  done
  for row in "one:pellucid flatten" "flatten:oiiotool --flatten (unsorted)" "two:pellucid flatten, two files" \
    "merge:oiiotool --deepmerge --flatten"; do
    name=${row%%:*}
    printf '%-8s %-34s %9s %9s %9.0f\n' "$n" "${row#*:}" "$(least "$name" 1)" "$(least "$name" 2)" \
      "$(awk -v k="$(least "$name" 3)" 'BEGIN { print k / 1024 }')"
  done
done
