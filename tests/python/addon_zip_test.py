"""The add-on for Blender as it is packed, without Blender: ./dev test --blender runs it there."""

import ast
import json
import os
import pathlib
import subprocess
import sys
import zipfile

import pytest

ROOT = pathlib.Path(__file__).parents[2]


@pytest.fixture
def flags():
    """The program's table of flags, which pellucid_pages writes beside it."""
    path = pathlib.Path(os.environ.get("PELLUCID_PROGRAM", "")).parent.parent / "share/pellucid/flags.json"
    if not path.is_file():
        pytest.skip(f"{path} is not there: the target pellucid_pages makes it")
    return path


def packed(flags, folder):
    """The zip."""
    ended = subprocess.run([sys.executable, ROOT / "blender/pack.py", flags, folder], capture_output=True, text=True,
                           check=True)
    return pathlib.Path(ended.stdout.strip())


def test_the_zip_is_the_programs_version(flags, tmp_path, program):
    path = packed(flags, tmp_path / "one")
    version = program("--version").out.strip()
    assert path.name == f"pellucid-{version}.zip"
    assert path.read_bytes() == packed(flags, tmp_path / "two").read_bytes()
    with zipfile.ZipFile(path) as archive:
        names = set(archive.namelist())
        start = archive.read("pellucid/__init__.py").decode()
        assert json.loads(archive.read("pellucid/flags.json"))["version"] == version
        for name in names:
            if name.endswith(".py"):
                compile(archive.read(name), name, "exec")
    assert {f"pellucid/{source.name}" for source in (ROOT / "blender/pellucid").glob("*.py")} <= names
    assert f'"version": ({version.replace(".", ", ")}),' in start


def test_every_widget_is_a_flag(flags):
    tree = ast.parse((ROOT / "blender/pellucid/settings.py").read_text(encoding="utf-8"))
    widgets = next(ast.literal_eval(node.value) for node in tree.body
                   if isinstance(node, ast.Assign) and node.targets[0].id == "WIDGETS")
    rows = {row["flag"] for row in json.loads(flags.read_text(encoding="utf-8"))["verbs"]["composite"]}
    assert {"--" + name for name in widgets} <= rows and len(widgets) > 5
