"""What lies where: no copies, no growth, threads, and what outlives what."""

import gc
import os
import threading
import time

import numpy

import pellucid
from conftest import CAMERA, arrays, panes

OPTIONS = {"camera": CAMERA, "aa": 1, "environment": (0.4, 0.5, 0.6)}


def resident():
    with open("/proc/self/statm", encoding="ascii") as numbers:
        return int(numbers.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def address(array):
    return array.__array_interface__["data"][0]


def test_rendering_into_the_picture_is_the_same_as_handing_arrays_over():
    colour, depth = arrays()
    picture = pellucid.Picture.empty(*depth.shape)
    assert picture.colour.dtype == numpy.float32 and numpy.isinf(picture.depth).all()
    picture.colour[...] = colour
    picture.depth[...] = depth
    rendered = pellucid.composite(picture, panes(), **OPTIONS)
    handed = pellucid.composite(pellucid.Picture(colour, depth), panes(), **OPTIONS)
    assert numpy.array_equal(rendered.picture, handed.picture)


def test_a_picture_serves_several_compositors():
    picture = pellucid.Picture(*arrays())
    with pellucid.Compositor(picture, panes(), **OPTIONS) as first:
        with pellucid.Compositor(picture, panes(), **OPTIONS) as second:
            assert first.addresses == second.addresses == (address(picture.colour), address(picture.depth))
            assert numpy.array_equal(first.run().picture, second.run().picture)
        assert first.addresses == (address(picture.colour), address(picture.depth))


def test_results_show_memory_and_outlive_their_compositor():
    shot = pellucid.Compositor(pellucid.Picture(*arrays()), panes(), **OPTIONS)
    result = shot.run()
    for array in (result.picture, result.touched, result.light, result.transmission, result.front_depth):
        assert not array.flags.owndata
    kept, sums = result.picture, float(result.picture.sum(dtype=numpy.float64))
    shot.close()
    del result, shot
    gc.collect()
    pellucid.composite(pellucid.Picture(*arrays()), panes(), **OPTIONS)  # would reuse freed memory
    assert float(kept.sum(dtype=numpy.float64)) == sums


def test_arrays_outlive_their_picture():
    picture = pellucid.Picture(*arrays())
    colour, sums = picture.colour, float(picture.colour.sum(dtype=numpy.float64))
    with pellucid.Compositor(picture, panes(), **OPTIONS):
        del picture
        gc.collect()
        assert float(colour.sum(dtype=numpy.float64)) == sums
    gc.collect()
    assert float(colour.sum(dtype=numpy.float64)) == sums


def test_a_hundred_calls_do_not_grow():
    picture, meshes = pellucid.Picture(*arrays(384, 192)), panes()
    for _ in range(20):  # until the driver and the allocator have what they keep
        pellucid.composite(picture, meshes, **OPTIONS)
    gc.collect()
    before = resident()
    for _ in range(100):
        pellucid.composite(picture, meshes, **OPTIONS)
    gc.collect()
    # One picture kept by each call would be 118 MB; the allocator's own spread is below a tenth of that.
    assert resident() - before < 100 * picture.colour.nbytes / 10


def test_two_threads_at_once():
    alone = pellucid.composite(pellucid.Picture(*arrays()), panes(), **OPTIONS).picture
    found, trouble = [], []

    def work():
        try:
            for _ in range(5):
                found.append(pellucid.composite(pellucid.Picture(*arrays()), panes(), **OPTIONS).picture)
        except Exception as error:  # told by the assertion below
            trouble.append(error)

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not trouble
    assert len(found) == 10 and all(numpy.array_equal(picture, alone) for picture in found)


def test_a_compositor_goes_from_thread_to_thread():
    shot = pellucid.Compositor(pellucid.Picture(*arrays()), panes(), **OPTIONS)
    here = shot.run(method="phenomenological").picture
    found = []
    threads = [threading.Thread(target=lambda: found.append(shot.run(method="phenomenological").picture))
               for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    closing = threading.Thread(target=shot.close)
    closing.start()
    closing.join()
    assert len(found) == 3 and all(numpy.array_equal(picture, here) for picture in found)


def test_other_threads_run_meanwhile():
    """Python's lock is free while a picture is made: this thread counts on."""
    picture, meshes = pellucid.Picture(*arrays(768, 384)), panes()
    worker = threading.Thread(target=lambda: pellucid.composite(picture, meshes, **{**OPTIONS, "aa": 8}))
    worker.start()
    longest, last = 0.0, time.monotonic()
    began = last
    while worker.is_alive():
        time.sleep(0.001)
        longest, last = max(longest, time.monotonic() - last), time.monotonic()
    assert longest < 0.5 * (last - began), "held for most of the call"


def test_a_shot_stays_loaded():
    with pellucid.Compositor(pellucid.Picture(*arrays()), panes(), **OPTIONS) as shot:
        exact = shot.run()
        assert shot.loads == 1
        sums = shot.run(method="phenomenological", measure=True)
        assert shot.loads == 1 and sums.error["rmse"] > 0 and exact.error is None
        assert not numpy.array_equal(exact.picture, sums.picture)
        assert numpy.array_equal(shot.run().picture, exact.picture), "what ran before does not show"
        shot.run(scene_unit=0.5)
        assert shot.loads == 2, "another scene"
        shot.run(camera="eye=0,0,1;look=0,0,-4;fov=60")
        assert shot.loads == 3, "another camera"
