"""Arrays are composited onto where they lie: no copy of float32 colours and depths, on the way in or out."""

import gc
import os
import subprocess
import sys
import threading
import tracemalloc

import numpy
import pytest

import pellucid
from conftest import arrays, panes
from memory_test import OPTIONS, address, resident


def test_a_run_reads_the_callers_arrays():
    colour, depth = arrays()
    picture = pellucid.Picture(colour, depth)
    assert picture.colour is colour and picture.depth is depth
    before = colour.copy(), depth.copy()
    with pellucid.Compositor(picture, panes(), **OPTIONS) as shot:
        assert shot.addresses == (address(colour), address(depth))
        result = shot.run()
        assert shot.addresses == (address(colour), address(depth))
        result.picture[...] = -1
        result.front_depth[...] = -1
        assert not numpy.array_equal(shot.run().picture, result.picture), "results have memory of their own"
    assert numpy.array_equal(colour, before[0]) and numpy.array_equal(depth, before[1])


@pytest.mark.parametrize("options", [
    {}, {"aa": 4}, {"aa": 4, "method": "phenomenological", "measure": True}, {"method": "auto", "tolerance": 0.01},
    {"aa": 2, "method": "stochastic", "samples": 8}, {"aa": 2, "method": "weighted", "low_res": 2, "set": {"red": {"lowResolution": True}}},
    {"aa": 2, "fog": {"density": 0.1}}, {"aa": 2, "layers": ["transparent", "edges", "unseen"]},
    {"aa": 1, "occlusion": "inferred"}, {"aa": 2, "lens_radius": 0.05, "focus": 3},
])
def test_nobody_writes_into_them(tmp_path, options):
    """Whoever wrote into pages that are mapped to be read would end the process."""
    planes = []
    for name, plane in zip(("colour.raw", "depth.raw"), arrays()):
        plane.tofile(tmp_path / name)
        planes.append(numpy.memmap(tmp_path / name, numpy.float32, "r", 0, plane.shape))
    options = {**OPTIONS, **options}
    with pellucid.Compositor(pellucid.Picture(*planes), panes(), **options) as shot:
        assert shot.addresses == tuple(address(plane) for plane in planes)
        mapped = shot.run().picture
    assert numpy.array_equal(mapped, pellucid.composite(pellucid.Picture(*arrays()), panes(), **options).picture)


def unaligned(array):
    raw = numpy.zeros(array.nbytes + 1, numpy.uint8)[1:]
    raw[...] = numpy.frombuffer(array.tobytes(), numpy.uint8)
    return raw.view(numpy.float32).reshape(array.shape)


@pytest.mark.parametrize("other", [
    lambda array: array.astype(numpy.float64), numpy.asfortranarray, lambda array: array.astype(">f4"), unaligned,
    lambda array: numpy.ascontiguousarray(array[::-1])[::-1], lambda array: numpy.repeat(array, 2, axis=1)[:, ::2],
], ids=["double", "fortran", "big-endian", "unaligned", "upside-down", "every-other"])
def test_any_other_layout_is_converted_once(other):
    colour, depth = arrays()
    converted = pellucid.Picture(other(colour), other(depth))
    for plane, same in ((converted.colour, colour), (converted.depth, depth)):
        assert plane.dtype == numpy.float32 and plane.flags.c_contiguous and plane.flags.aligned
        assert numpy.array_equal(plane, same)
    with pellucid.Compositor(converted, panes(), **OPTIONS) as shot:
        assert shot.addresses == (address(converted.colour), address(converted.depth))
        assert numpy.array_equal(shot.run().picture,
                                 pellucid.composite(pellucid.Picture(colour, depth), panes(), **OPTIONS).picture)


def test_normals_and_occlusion_are_not_written():
    colour, depth = arrays()
    normals, occlusion = numpy.full(depth.shape + (3,), 2, numpy.float32), numpy.full(depth.shape, 1.5, numpy.float32)
    for array in (normals, occlusion):
        array.flags.writeable = False
    picture = pellucid.Picture(colour, depth, normals=normals, occlusion=occlusion)
    given = pellucid.composite(picture, panes(), **OPTIONS)
    picture = pellucid.Picture(colour, depth, normals=normals * 3, occlusion=occlusion * 0 + 1)
    scaled = pellucid.composite(picture, panes(), **OPTIONS)
    assert numpy.array_equal(given.picture, scaled.picture), "unit length, and at most 1"
    assert (normals == 2).all() and (occlusion == 1.5).all()


def test_arrays_are_let_go_of():
    colour, depth = arrays()
    before = sys.getrefcount(colour), sys.getrefcount(depth)
    picture = pellucid.Picture(colour, depth)
    with pellucid.Compositor(picture, panes(), **OPTIONS) as shot:
        del picture
        result = shot.run()
        assert sys.getrefcount(colour) > before[0], "held by the compositor"
    with pytest.raises(pellucid.UsageError):
        pellucid.composite(pellucid.Picture(colour, depth), panes(), **{**OPTIONS, "depth": "Z"})
    del shot
    gc.collect()
    assert (sys.getrefcount(colour), sys.getrefcount(depth)) == before
    assert result.picture.shape == colour.shape


def test_a_compositor_lets_go_on_any_thread():
    colour, depth = arrays()
    before = sys.getrefcount(colour)
    shots = [pellucid.Compositor(pellucid.Picture(colour, depth), panes(), **OPTIONS) for _ in range(4)]
    threads = [threading.Thread(target=shot.close) for shot in shots]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    del shots, threads
    gc.collect()
    assert sys.getrefcount(colour) == before


def test_two_threads_share_one_picture():
    picture, meshes = pellucid.Picture(*arrays()), panes()
    alone, found = pellucid.composite(picture, meshes, **OPTIONS).picture, []

    def work():
        with pellucid.Compositor(picture, meshes, **OPTIONS) as shot:
            assert shot.addresses == (address(picture.colour), address(picture.depth))
            found.extend(shot.run().picture for _ in range(5))

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 10 and all(numpy.array_equal(each, alone) for each in found)


def test_a_picture_that_is_kept_keeps_no_other_plane():
    picture, meshes, kept = pellucid.Picture(*arrays(384, 192)), panes(), []
    for _ in range(10):  # until the driver and the allocator have what they keep
        pellucid.composite(picture, meshes, **OPTIONS)
    before = resident()
    for _ in range(25):
        kept.append(pellucid.composite(picture, meshes, **OPTIONS).picture)
    # The other planes of a result have 1.8 times the bytes of its picture; the allocator's spread is far below half.
    assert resident() - before < 1.5 * sum(each.nbytes for each in kept)


def test_python_allocates_no_plane():
    colour, depth = arrays(384, 192)
    meshes = panes()
    pellucid.composite(pellucid.Picture(colour, depth), meshes, **OPTIONS)  # what is kept is there now
    tracemalloc.start()
    try:
        pellucid.composite(pellucid.Picture(colour, depth), meshes, **OPTIONS)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < depth.nbytes, "words, plan and statistics are small"


PEAKS_AT_4K = """
import numpy, pellucid
from conftest import CAMERA

def status(key):
    with open("/proc/self/status", encoding="ascii") as lines:
        return next(int(line.split()[1]) << 10 for line in lines if line.startswith(key + ":"))

def peak(work):
    # The most that was resident while it worked, above what was so before; 5 starts VmHWM anew.
    with open("/proc/self/clear_refs", "w", encoding="ascii") as peaks:
        peaks.write("5")
    before = status("VmRSS")
    made = work()
    print(status("VmHWM") - before)
    return made

speck = pellucid.Mesh([[0, 0, -3], [0.01, 0, -3], [0, 0.01, -3]], material={"alphaMode": "BLEND"})
options = {"camera": CAMERA, "aa": 1, "environment": (1, 1, 1), "method": "over"}
pellucid.composite(pellucid.Picture.empty(24, 48), speck, **options)  # code and threads are there
colour = numpy.full((2160, 3840, 4), 0.25, numpy.float32)
depth = numpy.full((2160, 3840), 9, numpy.float32)
picture = peak(lambda: pellucid.Picture(colour, depth))
shot = peak(lambda: pellucid.Compositor(picture, speck, **options))
first = shot.run()  # the device has what it keeps
result = peak(shot.run)
assert result.touched.any()
print(result.picture.nbytes + result.touched.nbytes)
"""


def test_memory_of_a_call_at_4k():
    """Colours have 133 MB here and depths 33 MB: a copy of either would show."""
    ended = subprocess.run([sys.executable, "-c", PEAKS_AT_4K], capture_output=True, text=True, check=False,
                           cwd=os.path.dirname(os.path.abspath(__file__)))
    if "PermissionError" in ended.stderr:
        pytest.skip("the system does not start peaks anew")
    assert ended.returncode == 0, ended.stderr
    picture, shot, run, made = map(int, ended.stdout.split())
    small = 8 << 20  # tables, and the allocator's and the threads' own; a quarter of the depths
    assert picture < small, "borrowed"
    assert shot < small, "loaded without a copy"
    assert run < made + small, "what is handed out is all that a run makes"
