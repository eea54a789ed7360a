"""Packs the add-on, with the program's table of flags, as a zip that Blender installs. The same files give the same
bytes.

    pack.py FLAGS.json FOLDER      prints the path of FOLDER/pellucid-VERSION.zip
"""

import json
import pathlib
import re
import sys
import zipfile

_HERE = pathlib.Path(__file__).parent


def _versioned(text, version):
    """The text of __init__.py with the program's version, which Blender shows."""
    numbers = ", ".join(version.split("."))
    text, count = re.subn(r'"version": \(0, 0, 0\),.*', f'"version": ({numbers}),', text)
    assert count == 1, "__init__.py names its version once"
    return text


def _files(flags):
    for source in sorted((_HERE / "pellucid").glob("*.py")):
        text = source.read_text(encoding="utf-8")
        yield source.name, _versioned(text, json.loads(flags)["version"]) if source.name == "__init__.py" else text
    yield "flags.json", flags
    yield "LICENSE", (_HERE.parent / "LICENSE").read_text(encoding="utf-8")


def pack(flags, folder):
    """Writes the zip and returns its path."""
    path = folder / f"pellucid-{json.loads(flags)['version']}.zip"
    folder.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as out:
        for name, text in _files(flags):
            entry = zipfile.ZipInfo("pellucid/" + name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            out.writestr(entry, text)
    return path


if __name__ == "__main__":
    print(pack(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"), pathlib.Path(sys.argv[2])))
