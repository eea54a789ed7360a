"""Writes the type stubs of the module: its functions with every keyword, from the program's own table of flags.

    PYTHONPATH=build/python python3 python/stubs.py build/python/pellucid/__init__.pyi
"""

import os
import re
import sys

# The sources lie beside this file, and the module that was built does not.
sys.path = [path for path in sys.path if os.path.abspath(path) != os.path.dirname(os.path.abspath(__file__))]

import pellucid  # noqa: E402

HEAD = '''# Made by python/stubs.py from the flags of the program.
import os
from typing import Any, Dict, List, Literal, Mapping, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import ArrayLike

from ._mesh import Mesh as Mesh
from ._pellucid import Error as Error, InputError as InputError, MeaningError as MeaningError
from ._pellucid import ResourceError as ResourceError, UsageError as UsageError
from ._picture import Camera as Camera, Picture as Picture
from ._results import Comparison as Comparison, Flat as Flat, Resolved as Resolved, Result as Result
from ._results import Study as Study, Sums as Sums

__version__: str
Path = Union[str, "os.PathLike[str]"]
Scenes = Union[Path, Mesh, Sequence[Union[Path, Mesh]]]

def options(verb: str = "composite") -> Dict[str, Dict[str, Any]]: ...
'''


def type_of(name, row):
    """What a keyword takes."""
    if row["switch"]:
        return "bool"
    choices = re.search(r"\{(.*)\}", row["type"])
    if choices:
        words = [word.strip() for word in choices.group(1).split(",")]
        numeric = all(re.fullmatch(r"-?\d+", word) for word in words)
        return "Literal[" + ", ".join(word if numeric else f'"{word}"' for word in words) + "]"
    simple = "int" if row["type"].startswith(("INT", "UINT")) else "float" if row["type"].startswith("FLOAT") else "str"
    if name == "camera":
        return "Union[str, Mapping[str, Any], Camera]"
    if row["many"]:
        return f"Union[{simple}, Sequence[{simple}], Mapping[str, Any]]"
    if simple == "str" and re.search(r"[,:x]", row["value"]):
        return "Union[str, Sequence[float], Mapping[str, Any]]"
    return "Union[str, Path]" if simple == "str" and "FILE" in row["value"] else simple


def keywords(verb):
    return "".join(f"    {name}: Optional[{type_of(name, row)}] = None,\n" for name, row in pellucid.options(verb).items())


def function(name, places, result):
    return f"def {name}(\n    {places},\n    *,\n{keywords(name)}) -> {result}: ...\n"


def main(path):
    opaque = "opaque: Union[Path, Picture],\n    scenes: Scenes,\n    output: Optional[Path] = None"
    file = "opaque: Path,\n    scenes: Scenes,\n    output: Optional[Path] = None"
    text = HEAD
    text += function("composite", opaque, "Result")
    text += function("accumulate", file, "Sums")
    text += function("resolve", "opaque: Path,\n    planes: Union[Path, Sequence[Path]],\n    output: Optional[Path] = None",
                     "Resolved")
    text += function("flatten", "files: Union[Path, Sequence[Path]],\n    output: Optional[Path] = None", "Flat")
    text += function("compare", "a: Path,\n    b: Path", "Comparison")
    text += function("study", file, "Study")
    indented = keywords("composite").replace("\n    ", "\n        ")
    text += (f"class Compositor:\n    def __init__(\n        self,\n        opaque: Union[Path, Picture],\n        scenes: Scenes,"
             f"\n        *,\n    {indented}    ) -> None: ...\n")
    text += f"    def run(\n        self,\n        output: Optional[Path] = None,\n        *,\n    {indented}    ) -> Result: ...\n"
    text += f"    def plan(\n        self,\n        *,\n    {indented}    ) -> Dict[str, Any]: ...\n"
    text += ("    @property\n    def loads(self) -> int: ...\n    @property\n    def addresses(self) -> Tuple[int, int]: ...\n"
             "    def close(self) -> None: ...\n    def __enter__(self) -> Compositor: ...\n"
             "    def __exit__(self, *trouble: Any) -> None: ...\n")
    compile(text, path, "exec")
    with open(path, "w", encoding="utf-8") as out:
        out.write(text)


if __name__ == "__main__":
    main(*sys.argv[1:])
