#!/usr/bin/python3
"""Error and time of VTK's weighted-blended pass beside ours, on the same quads: one table.

  vtk_table.py PELLUCID VTK_OIT.py WORKDIR [LAYERS,...] [WxH]

VTK_OIT.py draws the scene with VTK (Debian: python3-vtk9, xvfb); this file writes the same quads, from the same random
numbers, as a GLB and an opaque EXR. Errors are against an `over` in float64 that numpy computes.
"""
import json, math, os, struct, subprocess, sys
import numpy as np

NEAR, FAR, FOV = 1.0, 20.0, 30.0


def quads(layers, aspect):
    """Corners, linear RGBA: as vtk_oit.py --scene quads --seed 1 draws them."""
    rng = np.random.default_rng(1)
    z = np.linspace(NEAR * 2, FAR * 0.9, layers)
    rng.shuffle(z)
    rgba = np.concatenate([rng.integers(10, 245, (layers, 3)), rng.integers(13, 154, (layers, 1))], 1) / 255.0
    t = math.tan(math.radians(FOV / 2))
    corners = [[(-d * t * aspect * 1.1, -d * t * 1.1, -d), (d * t * aspect * 1.1, -d * t * 1.1, -d),
                (d * t * aspect * 1.1, d * t * 1.1, -d), (-d * t * aspect * 1.1, d * t * 1.1, -d)] for d in z]
    return z, np.array(corners, np.float32), rgba


def write_glb(path, corners, rgba):
    n = len(corners)
    blob = corners.tobytes() + np.array([0, 1, 2, 0, 2, 3], np.uint16).tobytes()
    doc = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(n + 1))}],
           "extensionsUsed": ["KHR_materials_unlit"], "buffers": [{"byteLength": len(blob)}],
           "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48 * n},
                           {"buffer": 0, "byteOffset": 48 * n, "byteLength": 12}],
           "accessors": [{"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
           "cameras": [{"type": "perspective", "perspective": {"yfov": math.radians(FOV), "znear": NEAR, "zfar": FAR}}],
           "materials": [], "meshes": [], "nodes": []}
    for i in range(n):
        doc["accessors"].append({"bufferView": 0, "byteOffset": 48 * i, "componentType": 5126, "count": 4, "type": "VEC3",
                                 "min": corners[i].min(0).tolist(), "max": corners[i].max(0).tolist()})
        doc["materials"].append({"alphaMode": "BLEND", "doubleSided": True, "extensions": {"KHR_materials_unlit": {}},
                                 "pbrMetallicRoughness": {"baseColorFactor": rgba[i].tolist()}})
        doc["meshes"].append({"primitives": [{"attributes": {"POSITION": i + 1}, "indices": 0, "material": i}]})
        doc["nodes"].append({"mesh": i})
    doc["nodes"].append({"camera": 0})
    text = json.dumps(doc).encode()
    text += b" " * (-len(text) % 4)
    blob += b"\0" * (-len(blob) % 4)
    with open(path, "wb") as out:
        out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(blob)))
        out.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(blob), b"BIN\0") + blob)


def ours(pellucid, work, flags, exact):
    """RMSE against exact, and the median seconds of three runs of the compositing itself."""
    seconds, out = [], work + "/ours.exr"
    for _ in range(3):
        run = subprocess.run([pellucid, "composite", work + "/wall.exr", work + "/quads.glb", "-o", out, "--aa", "1",
                              "--stats", "--json", *flags], check=True, capture_output=True, text=True)
        stages = json.loads(run.stdout)["statistics"]["seconds"]
        seconds.append(sum(s for name, s in stages.items() if name in (
            "transparent pass", "resolve", "lists and method", "lists and sort")))
    stats = subprocess.run(["oiiotool", "--stats", out], check=True, capture_output=True, text=True).stdout
    mean = next(line for line in stats.splitlines() if "Stats Avg" in line).split(":")[1].split("(")[0].split()
    error = np.array([float(v) for v in mean[:3]]) - exact
    return float(np.sqrt((error ** 2).mean())), sorted(seconds)[1]


def main():
    pellucid, vtk, work = sys.argv[1:4]
    counts = [int(n) for n in (sys.argv[4] if len(sys.argv) > 4 else "4,8,16,32").split(",")]
    size = sys.argv[5] if len(sys.argv) > 5 else "1920x1080"
    width, height = map(int, size.split("x"))
    os.makedirs(work, exist_ok=True)
    wall = np.array([200, 180, 160]) / 255.0
    subprocess.run(["oiiotool", "--pattern", "constant:color=%f,%f,%f,%f" % (*wall, FAR * 0.98), size, "4", "--chnames",
                    "R,G,B,Z", "-d", "float", "-o", work + "/wall.exr"], check=True)
    print("%-6s %-22s %10s %10s" % ("layers", "method", "RMSE", "seconds"))
    for layers in counts:
        z, corners, rgba = quads(layers, width / height)
        exact = wall.copy()
        for i in np.argsort(-z):
            exact = exact * (1 - rgba[i, 3]) + rgba[i, 3] * rgba[i, :3]
        write_glb(work + "/quads.glb", corners, rgba)
        run = subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 %dx%dx24 -noreset" % (width, height), "/usr/bin/python3", vtk,
                              "--scene", "quads", "--layers", str(layers), "--no-sphere", "--pass", "wboit", "--size", size,
                              "--out", work], check=True, capture_output=True, text=True)
        peer = json.loads(next(line for line in run.stdout.splitlines() if '"kind"' in line))
        print("%-6d %-22s %10.5f %10.4f" % (layers, "VTK weighted-blended", peer["rmse_vs_exact_float"], peer["median_s"]))
        for label, flags in (("weighted --weight auto", ["--weight", "auto"]), ("front+tail", ["--method", "front+tail"]),
                             ("over", ["--method", "over"])):
            error, seconds = ours(pellucid, work, flags, exact)
            print("%-6d %-22s %10.5f %10.4f" % (layers, label, error, seconds), flush=True)


if __name__ == "__main__":
    main()
