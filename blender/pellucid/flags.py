"""The flags of `pellucid composite`, from a table that the program made of its own registrations when the add-on was
packed: names, help, defaults and what exit codes mean."""

import json
import pathlib

_TABLE = json.loads((pathlib.Path(__file__).parent / "flags.json").read_text(encoding="utf-8"))
_ROWS = {row["names"][0]: row for row in _TABLE["verbs"]["composite"]}

VERSION = _TABLE["version"]  # of the program that made the table
METHODS = _TABLE["methods"]  # name and help of each


def row(name):
    """The row of a flag, such as "low-res"."""
    return _ROWS[name]


def exit_meaning(code):
    """A sentence; None for a code that the program does not document."""
    for codes, meaning in _TABLE["exits"].items():
        if str(code) in codes.split(", "):
            return meaning
    return None
