"""Packs the built module as a wheel, with nothing but Python's own library.

    python3 python/wheel.py build/python build/lib/pellucid dist      # dist/pellucid-VERSION-cp311-cp311-linux_x86_64.whl
"""

import base64
import hashlib
import pathlib
import sys
import sysconfig
import zipfile

FIRST_YEAR = (1980, 1, 1, 0, 0, 0)  # of every entry, so that the same files make the same wheel


def tag():
    python = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{python}-{python}-{platform}"


def metadata(version):
    return (f"Metadata-Version: 2.1\nName: pellucid\nVersion: {version}\n"
            "Summary: Composites glass, smoke, fog, particles and foliage onto renders\n"
            f"License: BSD-3-Clause\nRequires-Python: =={sys.version_info[0]}.{sys.version_info[1]}.*\n"
            "Requires-Dist: numpy\n")


def main(built, parts, folder):
    sys.path.insert(0, built)
    import pellucid  # the one that was built

    version = pellucid.__version__
    info = f"pellucid-{version}.dist-info"
    package = pathlib.Path(built) / "pellucid"
    files = {f"pellucid/{path.name}": path.read_bytes()
             for path in sorted(package.iterdir()) if path.is_file()}
    files.update({f"pellucid/parts/{path.name}": path.read_bytes() for path in sorted(pathlib.Path(parts).glob("*.so"))})
    files[f"{info}/METADATA"] = metadata(version).encode()
    files[f"{info}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: python/wheel.py\nRoot-Is-Purelib: false\nTag: {tag()}\n"
                              ).encode()
    record = ""
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    path = pathlib.Path(folder) / f"pellucid-{version}-{tag()}.whl"
    path.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, FIRST_YEAR)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            wheel.writestr(entry, data)
    print(path)


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    main(*sys.argv[1:])
