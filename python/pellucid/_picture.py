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


class Picture:
    """An opaque picture in memory, in place of a file.

    colour: (height, width, 4) or (height, width, 3), scene-linear, premultiplied by the fourth channel.
    depth: (height, width), planar metres along the view axis, above 0 and below 1e9; +inf where nothing was hit.
    normals: (height, width, 3), in world space; they are brought to unit length.
    occlusion: (height, width), ambient occlusion from 0 to 1, 1 where nothing occludes.
    origin: x, y of the first pixel in the display window, y down.
    display: width, height of the display window, which cameras refer to; the array's own size without it.
    pixel_aspect: width over height of a pixel.

    Row 0 is the top of the picture. The arrays are copied once, into `colour` and `depth` of the object; every call
    reads those where they lie. A renderer that draws into them (`Picture.empty`) copies nothing. They must not change
    while a call runs or a `Compositor` holds them. Raises UsageError for shapes that do not fit; a call raises it for
    depths that are none.
    """

    def __init__(self, colour, depth, *, normals=None, occlusion=None, origin=(0, 0), display=None, pixel_aspect=1.0):
        colour, depth = numpy.asarray(colour), numpy.asarray(depth)
        if colour.ndim != 3 or colour.shape[2] not in (3, 4):
            raise _pellucid.UsageError(
                f"colour: found the shape {colour.shape}, expected (height, width, 3) or (height, width, 4)")
        if depth.shape != colour.shape[:2]:
            raise _pellucid.UsageError(
                f"depth: found the shape {depth.shape}, expected {colour.shape[:2]} as the colours have")
        self._make(colour.shape[:2], colour.shape[2] == 4, normals, occlusion, origin, display, pixel_aspect)
        numpy.copyto(self.colour[:, :, :colour.shape[2]], colour, casting="same_kind")
        numpy.copyto(self.depth, depth, casting="same_kind")

    @classmethod
    def empty(cls, height, width, *, alpha=True, normals=None, occlusion=None, origin=(0, 0), display=None,
              pixel_aspect=1.0):
        """A black picture with nothing in it, whose `colour` and `depth` are there to be rendered into.

        alpha: whether the fourth channel is one of the picture; else it is 1.
        """
        picture = cls.__new__(cls)
        picture._make((int(height), int(width)), bool(alpha), normals, occlusion, origin, display, pixel_aspect)
        return picture

    def _make(self, size, alpha, normals, occlusion, origin, display, pixel_aspect):
        height, width = size
        self._native = _pellucid.Picture((height, width), alpha, normals, occlusion, tuple(origin),
                                         (width, height) if display is None else tuple(display), float(pixel_aspect))
        self.colour = self._native.colour  # (height, width, 4) float32
        self.depth = self._native.depth  # (height, width) float32
