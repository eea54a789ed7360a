#!/usr/bin/python3
"""What a call of the Python module costs beside the work in it, at 1080 lines.

  python_call.py [WIDTH HEIGHT REPEATS]        with the module on PYTHONPATH

The picture is float32 arrays, and the scene a speck of glass, so that hardly anything is painted. The work is what the
program does, too: the stages that `--stats` lists, which a result has in `statistics["seconds"]`. One of them is not
work here: "read picture" takes the arrays over, where the program reads a file. So

  overhead = time of the call - its stages + "read picture"

which is: keywords become words, words become flags, the arrays are taken over and their depths checked, notes and plan
are made, the result is handed out and let go of, the GL context of `composite` is ended, and whatever else nobody
times. The least of many repeats is what it takes where nothing else runs; the median says how busy the machine was.
"""
import statistics, sys, time

import numpy
import pellucid

width, height, repeats = (int(word) for word in sys.argv[1:4]) if len(sys.argv) > 3 else (1920, 1080, 40)
colour = numpy.full((height, width, 4), (0.2, 0.4, 0.6, 1.0), numpy.float32)
y, x = numpy.mgrid[0:height, 0:width].astype(numpy.float32)
depth = numpy.where(y < height / 4, numpy.inf, 4 + 3 * y / height + numpy.sin(x / 40)).astype(numpy.float32)
del x, y
camera = pellucid.Camera(numpy.eye(4), [[height / width, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, -0.2], [0, 0, -1, 0]])
speck = pellucid.Mesh([[0, 0, -3], [0.02, 0, -3], [0, 0.02, -3]], material={
    "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.1, 0.1, 0.5], "metallicFactor": 0}})
options = {"environment": (1, 1, 1), "aa": 1}


def line(what, milliseconds):
    print(f"{what:<62} {min(milliseconds):8.3f} {statistics.median(milliseconds):8.3f}")


def timed(work):
    """Milliseconds, with those of letting go of the result, and what `work` keeps of it."""
    start = time.perf_counter()
    kept = work()
    return 1e3 * (time.perf_counter() - start), kept


def report(what, call):
    calls, overheads = [], []
    for _ in range(repeats):
        total, seconds = timed(lambda: call().statistics["seconds"])
        calls.append(total)
        overheads.append(total - 1e3 * (sum(seconds.values()) - seconds.get("read picture", 0.0)))
    line(what, calls)
    line("  of which overhead", overheads)


print(f"{width} x {height}, {repeats} repeats, milliseconds")
print(f"{'':<62} {'least':>8} {'median':>8}")
line("Picture(colour, depth)", [timed(lambda: pellucid.Picture(colour, depth))[0] for _ in range(repeats)])
picture = pellucid.Picture(colour, depth)
report("composite(picture, mesh)", lambda: pellucid.composite(picture, speck, camera=camera, **options))
with pellucid.Compositor(picture, speck, camera=camera, **options) as shot:
    report("Compositor.run()", shot.run)
    line("Compositor.plan()", [timed(shot.plan)[0] for _ in range(repeats)])
