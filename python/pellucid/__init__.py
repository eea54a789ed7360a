"""Composites glass, smoke, fog, particles and foliage onto renders you already have.

>>> import pellucid
>>> result = pellucid.composite("shot.exr", "glass.glb", "out.exr", aa=8)
>>> result.picture.shape
(1080, 1920, 4)

The opaque picture is a file, or a `Picture` of NumPy arrays; transparent things are glTF, GLB and deep EXR files, or
a `Mesh` of arrays. Every flag of the program is a keyword: ``--weight-range 0.1:100`` is ``weight_range=(0.1, 100)``.
`options("composite")` lists them, with the program's own help. Pictures have the bits of the program's.

Threads: every function may be called from any thread, and releases Python's lock while it works. A `Compositor` is
used by one thread at a time; the others wait. ``threads=N`` bounds the threads of the whole process while the call runs.
"""

from ._mesh import Mesh
from ._pellucid import Error, InputError, MeaningError, ResourceError, UsageError, __version__
from ._picture import Camera, Picture
from ._results import Comparison, Flat, Resolved, Result, Study, Sums
from ._verbs import Compositor, accumulate, compare, composite, flatten, resolve, study
from ._words import options

__all__ = [
    "Camera", "Comparison", "Compositor", "Error", "Flat", "InputError", "MeaningError", "Mesh", "Picture",
    "Resolved", "ResourceError", "Result", "Study", "Sums", "UsageError", "accumulate", "compare", "composite",
    "flatten", "options", "resolve", "study",
]
