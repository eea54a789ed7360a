#!/usr/bin/python3
"""What a frame of a sequence costs beside a run of its own, whether memory stays flat, and what --jobs 2 gains.

  sequence_cost.py PELLUCID SAMPLES WORKDIR [SAMPLE,...] [FRAMES] [HEIGHT]

SAMPLES writes the pictures and scenes; the scene is given an animation, so that every frame has a pose of its own. One
picture serves all frames, as of a camera that stands still, or each frame has a file of its own. All of it are whole
processes in one go, half of the single runs before the sequence and half after it. Times say little elsewhere; the
ratios are what is claimed.
"""
import json, os, shutil, struct, sys, time
from pathlib import Path


def run(words, folder):
    """Seconds on the clock, seconds of all cores, peak kilobytes: of the process and of those it waited for."""
    start = time.monotonic()
    child = os.fork()
    if child == 0:
        os.chdir(folder)
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 1)
        os.dup2(null, 2)
        os.execv(words[0], words)
    _, status, usage = os.wait4(child, 0)
    if status != 0:
        sys.exit(f"{' '.join(words)}: ended with {status}")
    return time.monotonic() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss


def animated(source, target, frames):
    """The scene under a node that moves 5 mm a frame at 24 a second."""
    data = source.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    scene = json.loads(data[20:20 + length])
    blob = data[28 + length:28 + length + struct.unpack_from("<I", data, 20 + length)[0]]
    blob += bytes(-len(blob) % 4)
    keys = struct.pack("<2f", 0.0, frames / 24.0)
    moves = struct.pack("<6f", 0, 0, 0, 0.005 * frames, 0, 0)
    nodes = scene["scenes"][scene.get("scene", 0)]["nodes"]
    moved = [node for node in nodes if "camera" not in scene["nodes"][node]]
    scene["nodes"].append({"name": "moved", "children": moved})
    top = len(scene["nodes"]) - 1
    scene["scenes"][scene.get("scene", 0)]["nodes"] = [node for node in nodes if node not in moved] + [top]
    views, accessors = scene["bufferViews"], scene["accessors"]
    views += [{"buffer": 0, "byteOffset": len(blob), "byteLength": 8},
              {"buffer": 0, "byteOffset": len(blob) + 8, "byteLength": 24}]
    accessors += [{"bufferView": len(views) - 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0],
                   "max": [frames / 24.0]},
                  {"bufferView": len(views) - 1, "componentType": 5126, "count": 2, "type": "VEC3"}]
    scene["animations"] = [{"samplers": [{"input": len(accessors) - 2, "output": len(accessors) - 1}],
                            "channels": [{"sampler": 0, "target": {"node": top, "path": "translation"}}]}]
    blob += keys + moves
    scene["buffers"][0]["byteLength"] = len(blob)
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(blob))
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(blob), 0x4E4942) + blob
    target.write_bytes(head + chunks)


def make(samples, folder, sample, frames, height):
    folder.mkdir(parents=True, exist_ok=True)
    run([samples, ".", sample, str(height)], folder)
    animated(folder / f"{sample}.glb", folder / "glass.glb", frames)
    for frame in range(1, frames + 1):
        link = folder / f"shot.{frame:04}.exr"
        link.unlink(missing_ok=True)
        os.link(folder / f"{sample}.exr", link)


def ratios(pellucid, folder, opaque, single, frames):
    """Per frame of a sequence over a run of its own: clock, cores."""
    job = [pellucid, "composite"]
    one, many = [0.0, 0.0], [0.0, 0.0]
    for frame in range(1, frames + 1):
        if frame == frames // 2 + 1:
            clock, cores, _ = run(job + [opaque, "glass.glb", "-o", "out.####.exr", "--frames", f"1-{frames}"], folder)
            many = [clock, cores]
        flags = ["glass.glb", "-o", f"one.{frame:04}.exr", "--frame", str(frame)]
        clock, cores, _ = run(job + [single.format(frame)] + flags, folder)
        one[0] += clock
        one[1] += cores
    for frame in (1, frames // 2, frames):
        run([pellucid, "compare", f"one.{frame:04}.exr", f"out.{frame:04}.exr", "--fail", "0"], folder)
    return [a / b for a, b in zip(many, one)], one, many


def main():
    pellucid, samples, work = os.path.realpath(sys.argv[1]), os.path.realpath(sys.argv[2]), Path(sys.argv[3])
    names = sys.argv[4].split(",") if len(sys.argv) > 4 else ["bars", "bottles", "smoke"]
    frames = int(sys.argv[5]) if len(sys.argv) > 5 else 20
    height = int(sys.argv[6]) if len(sys.argv) > 6 else 1080
    print(f"| sample, {frames} frames of {height} lines | picture | clock | cores | s a single run | s a frame |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name in names:
        folder = work / name
        make(samples, folder, name, frames, height)
        for kind, opaque, single in (("one for all", f"{name}.exr", f"{name}.exr"),
                                     ("one each", "shot.####.exr", "shot.{:04}.exr")):
            (clock, cores), one, many = ratios(pellucid, folder, opaque, single, frames)
            seconds = f"{one[0] / frames:.2f} | {many[0] / frames:.2f}"
            print(f"| {name} | {kind} | {clock:.2f} | {cores:.2f} | {seconds} |", flush=True)
    small = work / "small"
    make(samples, small, "bottles", 200, 90)
    job = [pellucid, "composite", "shot.####.exr", "glass.glb", "-o", "out.####.exr", "--threads", "1"]
    peaks = [run(job + ["--frames", f"1-{count}"], small)[2] for count in (20, 200)]
    print(f"peak memory of 200 frames of 90 lines over that of 20: {peaks[1] / peaks[0]:.3f} ({peaks[1] / 1024:.0f} MB)")
    clocks = [run(job[:-2] + ["--frames", "1-20", "--jobs", jobs], small)[0] for jobs in ("1", "2", "1", "2")]
    print(f"--jobs 2 over --jobs 1, 20 frames of 90 lines: {(clocks[1] + clocks[3]) / (clocks[0] + clocks[2]):.2f}")
    shutil.rmtree(work)


main()
