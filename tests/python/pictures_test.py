"""The module's pictures are the program's, bit for bit, from files and from arrays."""

import pickle

import numpy
import pytest

import pellucid

SURROUNDED = {"environment": (0.4, 0.5, 0.6)}


@pytest.mark.parametrize("options, flags", [
    ({"aa": 4}, ["--aa", "4"]),
    ({"aa": 2, "method": "phenomenological"}, ["--aa", "2", "--method", "phenomenological"]),
    ({"aa": 1, "method": "stochastic", "samples": 8}, ["--aa", "1", "--method", "stochastic", "--samples", "8"]),
    ({"aa": 1, "method": "weighted", "weight": "eq7", "precision": "exact"},
     ["--aa", "1", "--method", "weighted", "--weight", "eq7", "--precision", "exact"]),
    ({"aa": 1, "set": {"red": {"coverage": 0.5}}, "layers": ["transparent"]},
     ["--aa", "1", "--set", "red.coverage=0.5", "--layers", "transparent"]),
    ({"aa": 2, "fog": {"density": 0.1, "albedo": (0.9, 0.8, 0.7), "shafts": 0}},
     ["--aa", "2", "--fog", "density=0.1,albedo=0.9:0.8:0.7,shafts=0"]),
])
def test_files_arrays_and_program_agree(shot, program, options, flags):
    by_program, by_module, by_arrays = (str(shot.folder / name) for name in ("p.exr", "m.exr", "a.exr"))
    ended = program("composite", shot.opaque, *shot.scenes, "-o", by_program, "--environment", "0.4,0.5,0.6", *flags)
    assert ended.code == 0, ended.err
    of_files = pellucid.composite(shot.opaque, shot.scenes, by_module, **SURROUNDED, **options)
    of_arrays = pellucid.composite(shot.picture, shot.meshes, by_arrays, camera=shot.camera, **SURROUNDED, **options)
    assert of_files.touched.any()
    assert "fog" in options or not of_files.touched.all()
    for path in (by_module, by_arrays):
        report = pellucid.compare(by_program, path, fail=0, metadata="ignore")
        assert report.same and all(layer["worst"] is None for layer in report.layers), report
    assert numpy.array_equal(of_files.picture, of_arrays.picture)
    for name in ("touched", "light", "transmission", "front_depth"):
        assert numpy.array_equal(getattr(of_files, name), getattr(of_arrays, name)), name


def test_untouched_pixels_keep_their_bits(shot):
    result = pellucid.composite(shot.picture, shot.meshes, camera=shot.camera, aa=2, **SURROUNDED)
    untouched = result.touched == 0
    assert numpy.array_equal(result.picture[untouched], shot.picture.colour[untouched])


def test_one_pane_is_over(shot):
    """A flat unlit pane of coverage 0.25 and colour 1, 0, 0 over the picture."""
    material = {"alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}},
                "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.25]}}
    pane = pellucid.Mesh([[-9, -9, -3], [9, -9, -3], [0, 18, -3]], material=material)
    result = pellucid.composite(shot.picture, pane, camera=shot.camera, aa=1)
    expected = 0.75 * shot.picture.colour[:, :, :3] + numpy.float32([0.25, 0, 0])
    assert result.touched.all()
    assert abs(result.picture[:, :, :3] - expected).max() < 2e-7  # two roundings of float32 below 1
    assert abs(result.transmission - 0.75).max() < 1e-7 and abs(result.front_depth - 3).max() < 1e-6


def test_planes_have_the_size_of_the_picture(shot):
    """Whatever part of it was painted; what is over a pixel makes the picture of what is behind it."""
    small = pellucid.Mesh([[0.5, 0, -3], [1.5, 0, -3], [0.5, 0.5, -3]], material={
        "alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}},
        "pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0, 0.5]}})
    result = pellucid.composite(shot.picture, small, camera=shot.camera, aa=1, **SURROUNDED)
    size = shot.picture.depth.shape
    assert result.light.shape == result.transmission.shape == size + (3,) and result.front_depth.shape == size
    assert result.light is result.light, "made once"
    touched = result.touched > 0
    assert touched.any() and not touched.all()
    made = result.light + result.transmission * shot.picture.colour[:, :, :3]
    assert abs(made - result.picture[:, :, :3])[touched].max() < 2e-7  # two roundings of float32 below 1
    assert (result.light[~touched] == 0).all() and (result.transmission[~touched] == 1).all()
    assert numpy.isinf(result.front_depth[~touched]).all() and abs(result.front_depth[touched] - 3).max() < 1e-6
    again = pickle.loads(pickle.dumps(result))
    assert numpy.array_equal(again.light, result.light) and numpy.array_equal(again.picture, result.picture)


def test_colours_without_alpha(shot):
    colour, depth = shot.picture.colour[:, :, :3], shot.picture.depth
    three = pellucid.composite(pellucid.Picture(colour, depth), shot.meshes, camera=shot.camera, aa=1, **SURROUNDED)
    four = pellucid.composite(shot.picture, shot.meshes, camera=shot.camera, aa=1, **SURROUNDED)
    assert numpy.array_equal(three.picture[:, :, :3], four.picture[:, :, :3])


def test_a_window_within_the_display(shot):
    """A crop, told where it lies, has the pixels of the whole."""
    whole = pellucid.composite(shot.picture, shot.meshes, camera=shot.camera, aa=1, edges="off", **SURROUNDED)
    height, width = shot.picture.depth.shape
    crop = pellucid.Picture(shot.picture.colour[8:40, 16:80], shot.picture.depth[8:40, 16:80], origin=(16, 8),
                            display=(width, height))
    part = pellucid.composite(crop, shot.meshes, camera=shot.camera, aa=1, edges="off", **SURROUNDED)
    assert part.window == (16, 8, 80, 40)
    # Rasterised attributes are interpolated from another corner of the window.
    assert abs(part.picture - whole.picture[8:40, 16:80]).max() < 2e-5


def test_steps_make_the_same_picture(shot):
    planes = str(shot.folder / "planes.exr")
    sums = pellucid.accumulate(shot.opaque, shot.scenes, planes, **SURROUNDED)
    assert len(sums.passes) == 1 and sums.passes[0]["radiance"].shape == shot.picture.colour.shape
    resolved = pellucid.resolve(shot.opaque, planes)
    whole = pellucid.composite(shot.opaque, shot.scenes, aa=1, method="phenomenological", **SURROUNDED)
    assert numpy.array_equal(resolved.picture, whole.picture)


def test_flatten_is_the_programs(shot, program):
    deep, flat, by_module = (str(shot.folder / name) for name in ("deep.exr", "flat.exr", "module.exr"))
    assert program("fragments", shot.opaque, *shot.scenes, "-o", deep, "--environment", "1,1,1").code == 0
    assert program("flatten", deep, "-o", flat).code == 0
    result = pellucid.flatten(deep, by_module)
    assert result.samples > 0 and result.light.shape == shot.picture.depth.shape + (3,)
    report = pellucid.compare(flat, by_module, fail=0)
    assert report.same and all(layer["worst"] is None for layer in report.layers)


def test_study_finds_the_truth_at_zero(shot):
    folder = shot.folder / "study"
    study = pellucid.study(shot.opaque, shot.scenes, folder, methods=["over", "weighted"], **SURROUNDED)
    rows = {row["method"]: row for row in study.rows}
    assert rows["over"]["rmse"] == 0 and rows["weighted"]["rmse"] > 0
    assert len(study.pictures) == len(study.rows)
    assert (folder / "study.html").exists()


def test_compare_tells_pictures_apart(shot):
    other = str(shot.folder / "other.exr")
    pellucid.composite(shot.opaque, shot.scenes, other, aa=1, **SURROUNDED)
    report = pellucid.compare(shot.opaque, other, metadata="ignore")
    assert not report.same and report.verdict == "failure"
    assert pellucid.compare(other, other).same
