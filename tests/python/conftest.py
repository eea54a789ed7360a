"""A small shot as arrays and as files, and the program to hold the module against."""

import os
import subprocess
import types

import numpy
import pytest

import pellucid

WIDTH, HEIGHT = 96, 48

# Both matrices are exact as the floats of a file, so that both routes have the same camera to the bit: at the origin,
# looking down -z; the picture is as high as it is far.
CAMERA = pellucid.Camera(numpy.eye(4), [[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, -1, -0.2], [0, 0, -1, 0]])


def pane(z, colour, name, **material):
    """A pane as wide as half the picture at 4 m."""
    corners = [[-2, -1, z], [2, -1, z - 0.4], [2, 1, z - 0.4], [-2, 1, z]]
    material = {"pbrMetallicRoughness": {"baseColorFactor": colour, "metallicFactor": 0}, "doubleSided": True, **material}
    return pellucid.Mesh(corners, [[0, 1, 2], [0, 2, 3]], material=material, name=name)


def panes():
    glass = {"alphaMode": "BLEND"}
    return [pane(-3, [0.9, 0.2, 0.1, 0.5], "red", **glass), pane(-4, [0.1, 0.6, 0.9, 0.3], "blue", **glass),
            pane(-5, [0.2, 0.9, 0.3, 1.0], "green",
                 extensions={"KHR_materials_transmission": {"transmissionFactor": 0.8}})]


def arrays(width=WIDTH, height=HEIGHT):
    """Colours that differ everywhere, and a slope before nothing."""
    y, x = numpy.mgrid[0:height, 0:width].astype(numpy.float32)
    colour = numpy.stack([x / width, y / height, 0.5 + 0.25 * numpy.sin(x), numpy.ones_like(x)], axis=2)
    depth = numpy.where(x < 0.8 * width, 3.5 + 2 * y / height, numpy.inf)
    return colour.astype(numpy.float32), depth.astype(numpy.float32)


@pytest.fixture
def shot(tmp_path):
    """picture, camera and meshes in memory; opaque and scenes as files of the same."""
    colour, depth = arrays()
    picture, meshes = pellucid.Picture(colour, depth), panes()
    opaque = str(tmp_path / "opaque.exr")
    behind = pane(4, [1, 1, 1, 0.5], "behind", alphaMode="BLEND")  # changes no pixel: the file holds the arrays
    pellucid.composite(picture, behind, opaque, camera=CAMERA, aa=1, environment=(0, 0, 0))
    return types.SimpleNamespace(picture=picture, camera=CAMERA, meshes=meshes, opaque=opaque,
                                 scenes=[mesh.path for mesh in meshes], folder=tmp_path)


@pytest.fixture
def program():
    """Runs the program; returns its exit code, stdout and stderr."""
    path = os.environ.get("PELLUCID_PROGRAM")
    if not path:
        pytest.skip("PELLUCID_PROGRAM does not say where the program is")

    def run(*words):
        ended = subprocess.run([path, *map(str, words)], capture_output=True, text=True, check=False)
        return types.SimpleNamespace(code=ended.returncode, out=ended.stdout, err=ended.stderr)

    return run
