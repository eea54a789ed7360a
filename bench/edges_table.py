#!/usr/bin/python3
"""How far pictures that a renderer has filtered are off: with and without --edges, for each --filter.

  edges_table.py PELLUCID ASSETS WORKDIR

Frames of ../shared/assets, whose opaque things and truth Cycles drew with the same samples: flat colours, so that
nothing is noisy but the filter; and a still, whose light is noisy. Each is composited by `over`. A row is the root of
the mean squared error of all pixels, and of those at whose side the opaque depth breaks off. The first row is what
there was before edges were taken apart.
"""
import subprocess, sys
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

SHOT_SCENE = "blender_shot/transparent_unlit"
SHOTS = {  # what was drawn by which filter, the scene, the truth
    "1001, Blackman-Harris": ("blender_shot/opaque.1001", SHOT_SCENE, "blender_shot/flat_truth.1001"),
    "1005, Blackman-Harris": ("blender_shot/opaque.1005", SHOT_SCENE, "blender_shot/flat_truth.1005"),
    "1005, box": ("blender_shot/box_opaque.1005", SHOT_SCENE, "blender_shot/box_truth.1005"),
    "still, Blackman-Harris": ("blender/gbuffer", "blender/transparent_unlit", "blender/gt_unlit"),
}
ROWS = [("off", "box", 8), ("off", "blackman-harris", 8), ("off", "blackman-harris", 16), ("resolve", "box", 16),
        ("resolve", "triangle", 16), ("resolve", "gaussian", 16), ("resolve", "blackman-harris", 8),
        ("resolve", "blackman-harris", 16), ("resolve", "blackman-harris", 64), ("resolve", "box", 64)]
BREAK = 1.05  # of two depths side by side: more is another surface


def planes_of(path, channels):
    """Channels by the ends of their names, those of Blender's `Combined` first: height x width x number."""
    file = oiio.ImageInput.open(str(path))
    names = list(file.spec().channelnames)
    pixels = file.read_image(0, 0, 0, len(names), oiio.FLOAT)
    file.close()
    ending = lambda end: [i for i, name in enumerate(names) if ("." + name).endswith("." + end)]
    picked = [(ending("Combined." + channel) + ending(channel))[0] for channel in channels]
    return pixels[:, :, picked].astype(np.float64)


def edges_of(path):
    """Where the depth of a pixel or of one of the eight about it breaks off."""
    depth = planes_of(path, ["Z"])[:, :, 0]
    padded = np.pad(depth, 1, mode="edge")
    height, width = depth.shape
    around = np.stack([padded[y : y + height, x : x + width] for y in range(3) for x in range(3)])
    return around.max(0) > BREAK * around.min(0)


def main():
    program, assets, folder = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    head = "| picture | `--edges` | `--filter` | `--aa` | RMSE | of the edges' pixels |"
    print(head + "\n| --- | --- | --- | --- | --- | --- |")
    for shot, (opaque, scene, truth) in SHOTS.items():
        right, edges = planes_of(assets / f"{truth}.exr", "RGB"), edges_of(assets / f"{opaque}.exr")
        for how, shape, passes in ROWS:
            out = folder / "out.exr"
            words = [program, "composite", f"{assets / opaque}.exr", f"{assets / scene}.glb", "-o", str(out),
                     "--edges", how, "--filter", shape, "--aa", str(passes)]
            ended = subprocess.run(words, capture_output=True, text=True)
            if ended.returncode != 0:
                sys.exit(f"{' '.join(words)}: ended with {ended.returncode}: {ended.stderr}")
            squared = ((planes_of(out, "RGB") - right) ** 2).mean(2)
            whole, apart = squared.mean() ** 0.5, squared[edges].mean() ** 0.5
            print(f"| {shot} | {how} | {shape} | {passes} | {whole:.5f} | {apart:.5f} |", flush=True)


if __name__ == "__main__":
    main()
