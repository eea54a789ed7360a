#!/usr/bin/python3
"""What a call of the Python module costs before the work in it, at 1080 lines.

  python_call.py [WIDTH HEIGHT REPEATS]        with the module on PYTHONPATH

Keywords become words, words become flags, the depths of the picture are checked, and the plan is made: that is what
`Compositor.plan` does, and nothing is drawn. What follows is the work, which the program has as well; its result is
handed over without a copy. The least of many repeats is what the call takes where nothing else runs; the median says
how busy the machine was.
"""
import statistics, sys, time

import numpy
import pellucid

width, height, repeats = (int(word) for word in sys.argv[1:4]) if len(sys.argv) > 3 else (1920, 1080, 40)
colour = numpy.full((height, width, 4), (0.2, 0.4, 0.6, 1.0), numpy.float32)
depth = numpy.full((height, width), 5.0, numpy.float32)
camera = pellucid.Camera(numpy.eye(4), [[height / width, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, -0.2], [0, 0, -1, 0]])
pane = pellucid.Mesh([[-1, -1, -3], [1, -1, -3], [1, 1, -3], [-1, 1, -3]], [[0, 1, 2], [0, 2, 3]], material={
    "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.1, 0.1, 0.5], "metallicFactor": 0}})


def report(what, work):
    times, processor = [], []
    for _ in range(repeats):
        start, spent = time.perf_counter(), time.process_time()
        work()
        times.append(1e3 * (time.perf_counter() - start))
        processor.append(1e3 * (time.process_time() - spent))
    print(f"{what:<58} {min(times):8.3f} {statistics.median(times):8.3f} {statistics.median(processor):8.3f}")


print(f"{width} x {height}, {repeats} repeats, milliseconds")
print(f"{'':<58} {'least':>8} {'median':>8} {'of cores':>8}")
report("Picture(colour, depth): both are copied once", lambda: pellucid.Picture(colour, depth))
picture = pellucid.Picture(colour, depth)
with pellucid.Compositor(picture, pane, camera=camera, environment=(1, 1, 1), aa=1) as shot:
    shot.run()
    report("Compositor.plan(): all of a call but its work", shot.plan)
