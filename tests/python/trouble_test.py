"""Trouble is an exception of its kind with the program's sentence."""

import os

import numpy
import pytest

import pellucid
from conftest import CAMERA, arrays, panes


def refusal(kind, *arguments, call=pellucid.composite, **options):
    with pytest.raises(kind) as raised:
        call(*arguments, **options)
    assert type(raised.value) is kind and isinstance(raised.value, pellucid.Error)
    return str(raised.value)


def test_kinds():
    codes = {pellucid.UsageError: 2, pellucid.InputError: 3, pellucid.MeaningError: 4, pellucid.ResourceError: 6}
    for kind, code in codes.items():
        assert issubclass(kind, pellucid.Error) and kind.exit_code == code
    assert issubclass(pellucid.UsageError, ValueError) and issubclass(pellucid.MeaningError, ValueError)


@pytest.mark.parametrize("kind, code, options, flags", [
    (pellucid.UsageError, 2, {"method": "over", "weight": "eq7"}, ["--method", "over", "--weight", "eq7"]),
    (pellucid.UsageError, 2, {"environment": "1,2"}, ["--environment", "1,2"]),
    (pellucid.MeaningError, 4, {"depth": "none.Z"}, ["--depth", "none.Z"]),
    (pellucid.InputError, 3, {"environment": "missing.exr"}, ["--environment", "missing.exr"]),
])
def test_the_sentence_is_the_programs(shot, program, kind, code, options, flags):
    ended = program("composite", shot.opaque, *shot.scenes, "-o", shot.folder / "out.exr", *flags)
    assert ended.code == code, ended.err
    sentence = ended.err.strip().splitlines()[-1].removeprefix("pellucid: error: ")
    assert refusal(kind, shot.opaque, shot.scenes, **options) == sentence


def test_files(shot):
    assert "missing.exr" in refusal(pellucid.InputError, "missing.exr", shot.scenes)
    assert "missing.glb" in refusal(pellucid.InputError, shot.opaque, "missing.glb")
    damaged = shot.folder / "damaged.exr"
    damaged.write_bytes(b"v/1\x01 and no more")
    assert "damaged.exr" in refusal(pellucid.InputError, damaged, shot.scenes)


def test_outputs_are_checked_before_any_work(shot):
    assert ".exr" in refusal(pellucid.UsageError, "missing.exr", shot.scenes, "out.png")
    assert "nowhere" in refusal(pellucid.ResourceError, "missing.exr", shot.scenes, shot.folder / "nowhere" / "o.exr")
    assert refusal(pellucid.UsageError, shot.opaque, shot.scenes, shot.opaque)
    assert os.path.exists(shot.opaque)


@pytest.mark.parametrize("value", [-1.0, 0.0, numpy.nan, -numpy.inf, 1e9])
def test_depths_that_are_none(value):
    colour, depth = arrays()
    depth[7, 5] = value
    sentence = refusal(pellucid.UsageError, pellucid.Picture(colour, depth), panes(), camera=CAMERA)
    assert "picture in memory: depth: found" in sentence and "at (5, 7)" in sentence


def test_flags_of_files_with_a_picture_in_memory():
    picture = pellucid.Picture(*arrays())
    for options in ({"depth": "Z"}, {"depth_kind": "ray"}, {"unit": 0.01}, {"far": 100}, {"beauty": "Combined"},
                    {"view": "left"}, {"preset": "blender"}, {"aov": "N=n.exr"}):
        flag = "--" + next(iter(options)).replace("_", "-")
        sentence = refusal(pellucid.UsageError, picture, panes(), camera=CAMERA, **options)
        assert sentence.startswith(flag + ": found it with a picture in memory"), sentence


def test_shapes():
    colour, depth = arrays()
    assert "colour: found the shape" in refusal(pellucid.UsageError, depth, depth, call=pellucid.Picture)
    assert "depth: found the shape" in refusal(pellucid.UsageError, colour, depth[1:], call=pellucid.Picture)
    assert "normals" in refusal(pellucid.UsageError, colour, depth, call=pellucid.Picture, normals=depth)
    with pytest.raises(TypeError):
        pellucid.Picture(colour.astype(complex), depth)


def test_meshes_that_are_none():
    corners = numpy.zeros((3, 3))
    for arguments, name in [(([[1, 2]],), "positions"), ((corners, [[0, 1, 3]]), "indices"), ((corners, [0, 1]), "indices"),
                            ((corners, [[0.5, 1, 2]]), "indices")]:
        assert name in refusal(pellucid.UsageError, *arguments, call=pellucid.Mesh)
    assert "normals" in refusal(pellucid.UsageError, corners, call=pellucid.Mesh, normals=numpy.zeros((2, 3)))
    assert "transform" in refusal(pellucid.UsageError, corners, call=pellucid.Mesh, transform=numpy.eye(3))


def test_cameras_that_are_none():
    eye, lens = numpy.eye(4), CAMERA.clip_from_view
    rolled = lens.copy()
    rolled[0, 1] = 0.5
    for view, clip, word in [(2 * eye, lens, "a scale"), (eye, eye * 0, "last row"), (eye[:3], lens, "4x4"),
                             (numpy.full((4, 4), numpy.nan), lens, "not finite"), (eye, rolled, "a roll")]:
        assert word in refusal(pellucid.UsageError, view, clip, call=pellucid.Camera)


def test_without_a_camera_one_is_named():
    sentence = refusal(pellucid.MeaningError, pellucid.Picture(*arrays()), panes())
    assert "no camera" in sentence and "--camera fit" in sentence and "eye=" in sentence


def test_a_closed_compositor():
    shot = pellucid.Compositor(pellucid.Picture(*arrays()), panes(), camera=CAMERA)
    shot.close()
    shot.close()
    with pytest.raises(ValueError, match="closed"):
        shot.run()
