"""The wheel holds the module, and its record is true."""

import base64
import hashlib
import os
import pathlib
import subprocess
import sys
import zipfile

import pellucid

BUILT = pathlib.Path(pellucid.__file__).parent.parent
PACKER = pathlib.Path(__file__).parents[2] / "python" / "wheel.py"


def packed(folder):
    ended = subprocess.run([sys.executable, PACKER, BUILT, BUILT.parent / "lib" / "pellucid", folder], capture_output=True, text=True, check=True)
    return pathlib.Path(ended.stdout.strip())


def test_the_wheel(tmp_path):
    wheel = packed(tmp_path / "one")
    assert wheel.name.startswith(f"pellucid-{pellucid.__version__}-cp3") and wheel.suffix == ".whl"
    assert packed(tmp_path / "two").read_bytes() == wheel.read_bytes(), "the same files make the same wheel"
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        record = archive.read(f"pellucid-{pellucid.__version__}.dist-info/RECORD").decode().splitlines()
        for line in record[:-1]:
            name, digest, size = line.split(",")
            data = archive.read(name)
            sum_ = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            assert digest == f"sha256={sum_}" and int(size) == len(data), name
        archive.extractall(tmp_path / "site")
    assert len(record) == len(names)
    assert {"pellucid/__init__.py", "pellucid/__init__.pyi", "pellucid/py.typed"} <= set(names)
    ended = subprocess.run([sys.executable, "-c", "import pellucid; print(pellucid.__file__, pellucid.options()['aa']['flag'])"],
                           capture_output=True, text=True, check=True, cwd=tmp_path,
                           env={**os.environ, "PYTHONPATH": str(tmp_path / "site")})
    assert ended.stdout.split() == [str(tmp_path / "site" / "pellucid" / "__init__.py"), "--aa"]
