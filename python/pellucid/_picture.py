"""The opaque picture and its camera as NumPy arrays."""

import numpy

from . import _pellucid


class Camera:
    """Where a picture was taken from, as matrices of column vectors (``p' = M @ p``).

    view_from_world: (4, 4), a rotation and a translation in metres; view space is right-handed, y up, and looks
        down -z, as in glTF and OpenGL.
    clip_from_view: (4, 4), perspective with the last row 0 0 -1 0, or orthographic with 0 0 0 1. Its row of depth is
        not read.

    Raises UsageError for a scale, a shear, a mirror, or a number that is not finite.
    """

    def __init__(self, view_from_world, clip_from_view):
        self.view_from_world = numpy.array(view_from_world, dtype=numpy.float64)
        self.clip_from_view = numpy.array(clip_from_view, dtype=numpy.float64)
        self._native = _pellucid.camera(self.view_from_world, self.clip_from_view)


def _floats(array):
    """The array itself where it is float32, row by row; else a converted copy. Raises TypeError for complex numbers."""
    array = numpy.asarray(array).astype(numpy.float32, order="C", casting="same_kind", copy=False)
    return numpy.require(array, requirements="A")


class Picture:
    """An opaque picture in memory, in place of a file.

    colour: (height, width, 4) or (height, width, 3), scene-linear, premultiplied by the fourth channel.
    depth: (height, width), planar metres along the view axis, above 0 and below 1e9; +inf where nothing was hit.
    normals: (height, width, 3), in world space; they are brought to unit length.
    occlusion: (height, width), ambient occlusion from 0 to 1, 1 where nothing occludes.
    origin: x, y of the first pixel in the display window, y down.
    display: width, height of the display window, which cameras refer to; the array's own size without it.
    pixel_aspect: width over height of a pixel.

    Row 0 is the top of the picture. Colours of four channels and depths are not copied where they are C-contiguous
    float32, read-only and memory-mapped arrays included: `colour` and `depth` of the object are those arrays, which
    live as long as it does, and every call reads them where they lie. Do not write into them while a call runs or a
    `Compositor` holds the picture. Any other type or layout, and colours of three channels, are converted into arrays
    of the picture's own, once. Normals and occlusion are copied whenever a shot is loaded.

    Raises UsageError for shapes that do not fit; a call raises it for depths that are none.
    """

    def __init__(self, colour, depth, *, normals=None, occlusion=None, origin=(0, 0), display=None, pixel_aspect=1.0):
        colour, depth = numpy.asarray(colour), numpy.asarray(depth)
        if colour.ndim != 3 or colour.shape[2] not in (3, 4):
            raise _pellucid.UsageError(
                f"colour: found the shape {colour.shape}, expected (height, width, 3) or (height, width, 4)")
        if depth.shape != colour.shape[:2]:
            raise _pellucid.UsageError(
                f"depth: found the shape {depth.shape}, expected {colour.shape[:2]} as the colours have")
        alpha = colour.shape[2] == 4
        if not alpha:
            opaque = numpy.ones(colour.shape[:2] + (4,), numpy.float32)
            numpy.copyto(opaque[:, :, :3], colour, casting="same_kind")
            colour = opaque
        self._make(_floats(colour), _floats(depth), alpha, normals, occlusion, origin, display, pixel_aspect)

    @classmethod
    def empty(cls, height, width, *, alpha=True, normals=None, occlusion=None, origin=(0, 0), display=None,
              pixel_aspect=1.0):
        """A black picture with nothing in it, whose `colour` and `depth` are there to be rendered into.

        alpha: whether the fourth channel is one of the picture; else it is 1.
        """
        height, width = int(height), int(width)
        if height < 1 or width < 1:
            raise _pellucid.UsageError(f"picture: found {width}x{height} pixels, expected positive sizes")
        picture = cls.__new__(cls)
        colour = numpy.zeros((height, width, 4), numpy.float32)
        colour[:, :, 3] = 1
        depth = numpy.full((height, width), numpy.inf, numpy.float32)
        picture._make(colour, depth, bool(alpha), normals, occlusion, origin, display, pixel_aspect)
        return picture

    def _make(self, colour, depth, alpha, normals, occlusion, origin, display, pixel_aspect):
        height, width = depth.shape
        self._native = _pellucid.Picture(colour, depth, alpha, normals, occlusion, tuple(origin),
                                         (width, height) if display is None else tuple(display), float(pixel_aspect))
        self.colour = colour  # (height, width, 4) float32
        self.depth = depth  # (height, width) float32
