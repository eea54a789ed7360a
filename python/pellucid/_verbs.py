"""The functions of the module: the program's verbs, and a shot that stays loaded."""

import logging
import os

from . import _pellucid
from ._mesh import paths_of
from ._picture import Camera, Picture
from ._results import Comparison, Flat, Resolved, Result, Study, Sums
from ._words import options, words

_log = logging.getLogger("pellucid")


def _told(kind, found):
    """The result, whose notes are logged as information."""
    for note in found.get("notes", ()):
        _log.info("%s", note)
    return kind(**found)


class Compositor:
    """A shot that stays loaded while options change.

    >>> with pellucid.Compositor("shot.exr", "glass.glb") as shot:
    ...     exact = shot.run()
    ...     sums = shot.run(method="phenomenological", measure=True)

    opaque: EXR file with colour and depth, or a `Picture`, whose arrays are read where they lie. They are kept alive
        until `close`, and the caller must not write into them until then.
    scenes: glTF, GLB or deep EXR file with the transparent things, a `Mesh`, or a list of these.
    options: keywords of every run, as `composite` takes them; ``camera`` may be a `Camera`, too.

    The files are read when the object is made, and again only when an option of a run asks it (`loads` counts it).
    Raises UsageError, InputError, MeaningError and ResourceError.
    """

    def __init__(self, opaque, scenes, **options):
        self._open(opaque, scenes, options)

    def _open(self, opaque, scenes, options, output=None):
        """Reads the files, once the options and the output, where one is known, have been checked."""
        self._options = dict(options)
        self._scenes = scenes if isinstance(scenes, (list, tuple)) else [scenes]  # meshes live as long as this does
        files = paths_of(scenes)
        self._picture = opaque if isinstance(opaque, Picture) else None
        self._files = files if self._picture else [os.fspath(opaque)] + files
        camera = self._options.get("camera")
        if isinstance(camera, Camera):
            del self._options["camera"]
        else:
            camera = None
        self._session = _pellucid.Session(self._words({}, output), self._picture._native if self._picture else None,
                                          camera._native if camera else None)

    def _words(self, more, output=None):
        return words("composite", {**self._options, **more}, self._files, output)

    def run(self, output=None, **options):
        """Composites, and writes the EXR `output` where one is named. Options add to those of the object, and replace
        them. Returns a `Result`."""
        return _told(Result, self._session.run(self._words(options, output)))

    def plan(self, **options):
        """What `run` would do, and why, as a dict; ``lines`` says it in sentences. Nothing is drawn."""
        return self._session.plan(self._words(options))

    @property
    def loads(self):
        """How often files were read."""
        return self._session.loads()

    @property
    def addresses(self):
        """Where the colours and the depths lie that a run reads: those of the `Picture`'s arrays."""
        return self._session.addresses()

    def close(self):
        """Gives the files, the scene, the GL context and the picture's arrays back, once runs in other threads have
        ended. Results stay."""
        self._session.close()
        self._picture = None

    def __enter__(self):
        return self

    def __exit__(self, *trouble):
        self.close()


def composite(opaque, scenes, output=None, **options):
    """Composites transparent things onto an opaque picture: exactly, unless ``method`` says otherwise.

    opaque: EXR file with colour and depth, or a `Picture` of arrays, which are read where they lie: the caller must not
        write into them until the call returns.
    scenes: glTF, GLB or deep EXR file with the transparent things, a `Mesh`, or a list of these.
    output: EXR file to write, or None.

    Returns a `Result`, whose picture has the bits of the program's. Raises UsageError for options that do not go
    together, InputError for a file that is missing or damaged, MeaningError for one that lacks what is needed, and
    ResourceError where disk, memory or the GL device runs out.
    """
    shot = Compositor.__new__(Compositor)
    shot._open(opaque, scenes, options, output)
    with shot:
        return shot.run(output)


def accumulate(opaque, scenes, output=None, **options):
    """The transparent pass alone: sums of the layers, for `resolve`.

    opaque: EXR file with colour and depth.
    scenes: as `composite` takes them.
    output: EXR file of planes to write, or None.

    Returns `Sums`. Raises what `composite` raises.
    """
    files = [os.fspath(opaque)] + paths_of(scenes)
    return _told(Sums, _pellucid.accumulate(words("accumulate", options, files, output)))


def resolve(opaque, planes, output=None, **options):
    """The compositing step alone: planes over an opaque picture.

    opaque: EXR file with colour and depth.
    planes: file of `accumulate`, or a list of them, which are added.
    output: EXR file to write, or None.

    Returns a `Resolved`. Raises what `composite` raises, MeaningError for planes of another picture.
    """
    files = [os.fspath(opaque)] + paths_of(planes)
    return _told(Resolved, _pellucid.resolve(words("resolve", options, files, output)))


def flatten(files, output=None, **options):
    """Merges deep EXR files and composites their samples, exactly.

    files: deep EXR file, or a list of them in any order.
    output: flat EXR file to write, or None.

    Returns a `Flat`. Raises what `composite` raises.
    """
    return _told(Flat, _pellucid.flatten(words("flatten", options, paths_of(files), output)))


def compare(a, b, **options):
    """A regression gate for two EXR files.

    Returns a `Comparison`; files that differ raise nothing. Raises InputError for a file that is missing or damaged,
    and UsageError for a layer that neither has.
    """
    return Comparison(**_pellucid.compare(words("compare", options, [os.fspath(a), os.fspath(b)])))


def study(opaque, scenes, output=None, **options):
    """Time of the exact picture of a shot, and error against time of the other methods.

    opaque: EXR file with colour and depth.
    scenes: as `composite` takes them.
    output: folder for study.txt, .csv, .json, .svg, .png and .html, or None.

    Returns a `Study`. Raises what `composite` raises.
    """
    files = [os.fspath(opaque)] + paths_of(scenes)
    return _told(Study, _pellucid.study(words("study", options, files, output)))


def _document(function):
    """Adds the keywords and their help to a function, from the program's table."""
    lines = [function.__doc__.rstrip(), "", "    Keywords, which are the program's flags:", ""]
    for name, row in options(function.__name__).items():
        lines.append(f"    {name}: {row['help']}")
    function.__doc__ = "\n".join(lines) + "\n"


for _function in (composite, accumulate, resolve, flatten, compare, study):
    _document(_function)
