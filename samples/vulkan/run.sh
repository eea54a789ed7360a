#!/usr/bin/env bash
# The sample engine's frame on Vulkan against the same frame on GL, for every method and tier that it takes.
#   run.sh FOLDER_OF_PROGRAMS OUTDIR
set -euo pipefail
programs=$1 out=$2
mkdir -p "$out/gl" "$out/vulkan"
size=352x198
for sample in ball mixed foliage; do "$programs/pellucid_samples" "$out" $sample 198 >/dev/null; done

# differs NAME MANY SOME: what the program that ran last gives against GL's. Rasterised attributes belong to each
# driver. At edges of triangles, and where a polished surface's highlight turns a last bit of a normal into some
# percent, MANY percent of the pixels may be off by any amount; SOME percent by more than 1e-5, which is rounding behind
# a division. They are .006 (four pixels of 69,696) and 1; and .01 and 2 where planes are half floats or bytes, since a
# last bit that differs is there a step of 5e-4 of a value, or of 1/255, and lies under every rim of a leaf.
differs() {
  for picture in gl vulkan; do oiiotool "$out/$picture/$1.exr" --ch R,G,B -o "$out/$picture/$1-rgb.exr"; done
  for limits in ".001 $2" ".00001 $3"; do
    read -r most percent <<<"$limits"
    oiiotool --fail "$most" --failpercent "$percent" --hardfail 1000 --warn 1000 \
      "$out/gl/$1-rgb.exr" "$out/vulkan/$1-rgb.exr" --diff >"$out/diff.txt" || { cat "$out/diff.txt"; exit 1; }
  done
  echo "  $1: within .001 but for $2 % of the pixels at most, within 1e-5 but for $3 %"
}

# same SAMPLE METHOD ROWS [MANY SOME]
same() {
  local many=.006 some=1
  if [[ $2 == *:half* || $2 == *:published* ]]; then many=.01 some=2; fi
  "$programs/pellucid_engine" "$out/$1.glb" "$out/gl" $size $2 >/dev/null
  # Ends with 1 where the validation layers say anything.
  "$programs/pellucid_vulkan" "$out/$1.glb" "$out/vulkan" $size $2 $3 >"$out/vulkan.txt" 2>&1 ||
    { cat "$out/vulkan.txt"; exit 1; }
  echo "$1, $2, rows $3: $(tail -n 1 "$out/vulkan.txt")"
  differs opaque "${4:-.006}" "${5:-1}"
  differs frame "${4:-$many}" "${5:-$some}"
}

for asked in weighted phenomenological front+tail weighted:half phenomenological:half front+tail:half \
  weighted:published phenomenological:exact front+tail:exact; do
  same ball $asked up
done
# Smoke at half the resolution among glass, and ambient occlusion at rims of leaves: in stages of their own or, in the
# published tier and with front+tail, by the seam of the layers.
for asked in weighted phenomenological front+tail phenomenological:half phenomenological:exact; do
  same mixed $asked,low up
done
for asked in phenomenological front+tail phenomenological:half weighted:published phenomenological:exact; do
  same foliage $asked,rims up
done
# The sun's shadow map of what is transparent, on opaque things and on layers.
for asked in phenomenological weighted:half phenomenological:exact; do
  same ball $asked,shadows up
done
same mixed phenomenological,low,shadows up
# Rows that run down: texels of the pyramid lie elsewhere, so what frosted glass spreads differs by some 1e-5.
same mixed phenomenological,low down
# The level of a texture is one for each square of four pixels, by the first of its rows, which is the other one there:
# masks of leaves are sharpened, so that rims show it (.20 % of the pixels are off by more than .001 without occlusion,
# .23 % with it).
same foliage phenomenological,rims down .3 5
same ball phenomenological,shadows down

# A device that cannot blend into a plane says so and draws nothing wrong.
if ! "$programs/pellucid_vulkan" "$out/ball.glb" "$out/vulkan" $size phenomenological:published up >"$out/vulkan.txt" 2>&1; then
  grep 'does not blend into' "$out/vulkan.txt"
fi
oiiotool "$out/vulkan/frame-rgb.exr" --clamp:min=0:max=1 --tocolorspace sRGB -o "$out/frame.png"
echo "$out/frame.png"
