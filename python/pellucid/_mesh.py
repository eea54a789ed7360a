"""Transparent meshes as arrays: a glTF of one mesh, read by the very loader that reads files."""

import json
import os
import struct
import tempfile

import numpy

from . import _pellucid

_FLOAT, _UINT = 5126, 5125  # glTF's component types


class _Buffer:
    """The binary chunk of a GLB, and what lies where in it."""

    def __init__(self):
        self.bytes = bytearray()
        self.views = []
        self.accessors = []

    def add(self, array, kind, **more):
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": array.nbytes})
        self.bytes += array.tobytes()
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        component = _UINT if array.dtype == numpy.uint32 else _FLOAT
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component, "count": len(array),
                               "type": kind, **more})
        return len(self.accessors) - 1


def _rows(array, widths, name, count=None):
    rows = numpy.ascontiguousarray(array, dtype=numpy.float32)
    if rows.ndim != 2 or rows.shape[1] not in widths or (count is not None and len(rows) != count):
        wanted = " or ".join(f"({'n' if count is None else count}, {width})" for width in widths)
        raise _pellucid.UsageError(f"mesh: {name}: found the shape {rows.shape}, expected {wanted}")
    return rows


def _chunk(kind, data, fill):
    data = bytes(data) + fill * (-len(data) % 4)
    return struct.pack("<II", len(data), kind) + data


class Mesh:
    """Triangles as arrays, with a material of glTF 2.0.

    positions: (n, 3), metres, object space with y up.
    indices: (m, 3) or (3 m,), counter-clockwise from the front; without them every three vertices are a triangle.
    normals: (n, 3), unit; without them triangles are flat.
    texcoords: (n, 2).
    colours: (n, 3) or (n, 4), linear, multiplied with the base colour.
    material: a dict as glTF has it, such as ``{"alphaMode": "BLEND", "pbrMetallicRoughness": {...}}`` with
        ``extensions`` and ``extras``. What the glTF specification calls opaque does not go onto the picture.
    transform: (4, 4), world from object, of column vectors.
    name: of the node and the material, for ``set={"NAME.key": value}`` and messages.

    The arrays are copied into a temporary file of the mesh, which goes with the object. Raises UsageError for shapes
    that do not fit.
    """

    def __init__(self, positions, indices=None, *, normals=None, texcoords=None, colours=None, material=None,
                 transform=None, name="mesh"):
        positions = _rows(positions, (3,), "positions")
        buffer = _Buffer()
        least, most = (positions.min(0), positions.max(0)) if len(positions) else (numpy.zeros(3), numpy.zeros(3))
        attributes = {"POSITION": buffer.add(positions, "VEC3", min=least.tolist(), max=most.tolist())}
        count = len(positions)
        if normals is not None:
            attributes["NORMAL"] = buffer.add(_rows(normals, (3,), "normals", count), "VEC3")
        if texcoords is not None:
            attributes["TEXCOORD_0"] = buffer.add(_rows(texcoords, (2,), "texcoords", count), "VEC2")
        if colours is not None:
            rows = _rows(colours, (3, 4), "colours", count)
            attributes["COLOR_0"] = buffer.add(rows, f"VEC{rows.shape[1]}")
        primitive = {"attributes": attributes, "material": 0}
        if indices is not None:
            primitive["indices"] = buffer.add(self._indices(indices, count), "SCALAR")
        self.name = str(name)
        self._file = self._written(buffer, primitive, dict(material or {}), transform)

    @property
    def path(self):
        """The GLB file that holds the mesh while this object lives."""
        return self._file.name

    @staticmethod
    def _indices(indices, count):
        flat = numpy.asarray(indices).reshape(-1)
        if flat.size % 3 or (flat.size and not numpy.issubdtype(flat.dtype, numpy.integer)):
            raise _pellucid.UsageError(f"mesh: indices: found {flat.size} of {flat.dtype}, expected integers by threes")
        if flat.size and (flat.min() < 0 or flat.max() >= count):
            raise _pellucid.UsageError(
                f"mesh: indices: found {flat.min()} to {flat.max()}, expected 0 to {count - 1}")
        return flat.astype(numpy.uint32)

    def _written(self, buffer, primitive, material, transform):
        node = {"mesh": 0, "name": self.name}
        if transform is not None:
            matrix = numpy.asarray(transform, dtype=numpy.float64)
            if matrix.shape != (4, 4):
                raise _pellucid.UsageError(f"mesh: transform: found the shape {matrix.shape}, expected (4, 4)")
            node["matrix"] = matrix.T.reshape(-1).tolist()
        material.setdefault("name", self.name)
        gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [node],
                "meshes": [{"name": self.name, "primitives": [primitive]}], "materials": [material],
                "buffers": [{"byteLength": len(buffer.bytes)}], "bufferViews": buffer.views,
                "accessors": buffer.accessors}
        if material.get("extensions"):
            gltf["extensionsUsed"] = sorted(material["extensions"])
        chunks = _chunk(0x4E4F534A, json.dumps(gltf).encode(), b" ") + _chunk(0x004E4942, buffer.bytes, b"\0")
        file = tempfile.NamedTemporaryFile(prefix="pellucid-", suffix=".glb")
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
        file.flush()
        return file


def paths_of(scenes):
    """The files of one scene or several."""
    if isinstance(scenes, (str, os.PathLike, Mesh)):
        scenes = [scenes]
    return [scene.path if isinstance(scene, Mesh) else os.fspath(scene) for scene in scenes]
