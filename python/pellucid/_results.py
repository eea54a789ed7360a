"""What the functions hand back. Each array has the memory that its image was made in: no copy is made of it."""

import dataclasses
import types
from typing import Any, Dict, List, Optional, Tuple

import numpy


@dataclasses.dataclass(frozen=True, repr=False)
class Resolved:
    """A composited picture. Arrays have the size of the data window; row 0 is its top. They are the caller's to keep
    and to write into, one without the others.

    picture: (height, width, 4) float32, scene-linear in `space`, premultiplied.
    touched: (height, width) uint8, 0 where the picture kept its bits.
    layers: {layer: {channel: (height, width) float32}}, those of ``layers=[...]`` and ``shadow``.
    window: x0, y0, x1, y1 of the data window, half open.
    space: name of the linear space that the colours are in.
    statistics: device, counts, and seconds of every stage, as ``--json --stats`` prints them.
    notes: what was inferred, left out or clamped, a sentence each.
    """

    picture: numpy.ndarray
    touched: numpy.ndarray
    veil: dataclasses.InitVar[Any]
    layers: Dict[str, Dict[str, numpy.ndarray]]
    window: Tuple[int, int, int, int]
    space: str
    statistics: Dict[str, Any]
    notes: List[str]

    def __post_init__(self, veil):
        object.__setattr__(self, "_veil", veil)

    @property
    def light(self) -> numpy.ndarray:
        """(height, width, 3) float32, radiance of the transparent things; means nothing where `touched` is 0."""
        return self._veil.light

    @property
    def transmission(self) -> numpy.ndarray:
        """(height, width, 3) float32, from 0 to 1, of what stands behind them; means nothing where `touched` is 0."""
        return self._veil.transmission

    @property
    def front_depth(self) -> numpy.ndarray:
        """(height, width) float32, planar metres of the nearest of them, +inf for none."""
        return self._veil.front_depth

    def __getstate__(self):
        """For pickle, and so for other processes: arrays in the veil's place."""
        veil = types.SimpleNamespace(light=self.light, transmission=self.transmission, front_depth=self.front_depth)
        return {**self.__dict__, "_veil": veil}

    def __repr__(self):
        height, width = self.touched.shape
        return f"<pellucid.{type(self).__name__} {width}x{height}, {self.space}>"


@dataclasses.dataclass(frozen=True, repr=False)
class Result(Resolved):
    """What `composite` makes: a `Resolved` picture, and how it was made.

    plan: what was done, as `Compositor.plan` says it.
    error: with ``measure=True`` the mean, rmse, p99, max and worst pixel of the error against the exact picture.
    tolerance: with ``tolerance=E`` how much was certified, how much composited exactly, and the bound that was met.
    """

    plan: Dict[str, Any]
    error: Optional[Dict[str, Any]]
    tolerance: Optional[Dict[str, Any]]


@dataclasses.dataclass(frozen=True)
class Sums:
    """Order-independent sums, as `accumulate` makes them.

    passes: a dict of arrays for each jittered pass: radiance, weight, opacity, depth, light and solid of
        (height, width, 4), front_depth of (height, width), and refraction, diffuse_depth and dispersion where layers
        scatter. gbuffer/accum.h says what they hold.
    method: that the sums are of.
    """

    passes: List[Dict[str, numpy.ndarray]]
    method: str
    statistics: Dict[str, Any]
    notes: List[str]


@dataclasses.dataclass(frozen=True)
class Flat:
    """Deep files, composited exactly.

    light: (height, width, 3) float32, premultiplied.
    opacity: (height, width, 4) float32, of red, green and blue, and their own alpha.
    front_depth: (height, width) float32, of the nearest sample, in the file's unit; +inf for none.
    window: x0, y0, x1, y1 of the data window, half open.
    samples: how many there were.
    """

    light: numpy.ndarray
    opacity: numpy.ndarray
    front_depth: numpy.ndarray
    window: Tuple[int, int, int, int]
    samples: int
    notes: List[str]


@dataclasses.dataclass(frozen=True)
class Comparison:
    """What `compare` finds.

    same: no layer is over its thresholds.
    verdict: same, warning or failure.
    structure, metadata: a sentence for everything that differs besides pixels.
    layers: a dict for each: name, channels, pixels, failing, warning, mean, rms and the worst value.
    """

    same: bool
    verdict: str
    structure: List[str]
    metadata: List[str]
    layers: List[Dict[str, Any]]


@dataclasses.dataclass(frozen=True)
class Study:
    """Error against cost.

    rows: a dict for each method and number of passes, as study.json holds them.
    pictures: (height, width, 3) float32 of each row.
    machine: the device and the threads that rows were timed on, and how.
    """

    rows: List[Dict[str, Any]]
    pictures: List[numpy.ndarray]
    machine: str
    notes: List[str]
