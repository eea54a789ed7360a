#!/usr/bin/python3
"""Which listed weight errs least where nothing can be fitted: what engines and planes are told to take.

  weights_table.py PELLUCID SAMPLES WORKDIR [HEIGHT]

Every sample is composited by the phenomenological sums with each listed weight at 10^-3, 1 and 10^3 times its size, and
with the fitted one. What the flags and the lamps say in metres grows along: how far diffusion spreads, intensities by
the square, and the unit of weights with the papers' constants (--weight-reference). Weights that read a range get that
of the scene's transparent things, as an engine's camera knows it, rounded out by a tenth. A row is the mean error over
that of the best listed weight on the same sample, size by size, as the geometric mean of all samples, and at worst; and
by how much it differs between the sizes of a sample at most, which is nothing for what has no length in it.
"""
import json, math, re, struct, subprocess, sys
from pathlib import Path

WEIGHTS = ["eq5", "eq7", "eq8", "eq9", "eq10", "eq7z", "eq8z", "eq9z", "eq10z", "uniform", "fig1", "fig6", "fig10:0.01",
           "linear"] + [f"power:{k}" for k in (1, 2, 3, 4, 6, 8, 12, 16, 32)]
SAMPLES = ["bars", "bottles", "smoke", "foliage", "frosted", "ball", "hair", "cad", "clouds", "street", "mixed",
           "smokeball", "shafts", "shadows", "chess"]
RANGED = {"eq5", "eq10", "eq10z", "linear"}
CONSTANTS = {"eq7", "eq8", "eq9", "eq7z", "eq8z", "eq9z", "fig1", "fig10:0.01"}
SIZES = [1e-3, 1.0, 1e3]
LEAST = 1e-6  # of an error: below it no weight is better than another


def lit_for(stem, size):
    """A copy of the sample whose lamps light things that are `size` times as far as they light it. Its path."""
    data = Path(f"{stem}.glb").read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    scene = json.loads(data[20 : 20 + length])
    for lamp in scene.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", []):
        if lamp["type"] != "directional":
            lamp["intensity"] = lamp.get("intensity", 1.0) * size * size
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    copy = Path(f"{stem}-lit.glb")
    copy.write_bytes(b"glTF" + struct.pack("<IIII", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest)
    return copy


def measured(program, stem, size, flags):
    words = [program, "composite", f"{stem}.exr", f"{stem}-lit.glb", "-o", f"{stem}-out.exr",
             "--method", "phenomenological", "--measure", "--aa", "1", "--unit", repr(size), "--scene-unit", repr(size),
             "--diffusion-scale", f"{0.3 * size!r}:{0.5 * size!r}", *flags]
    ended = subprocess.run(words, capture_output=True, text=True)
    if ended.returncode != 0:
        sys.exit(f"{' '.join(words)}: ended with {ended.returncode}: {ended.stderr}")
    return ended


def error_of(ended):
    return float(re.search(r"sorted over: mean ([0-9.e+-]+)", ended.stdout + ended.stderr).group(1))


def main():
    program, samples, folder = str(Path(sys.argv[1]).resolve()), sys.argv[2], Path(sys.argv[3])
    height = sys.argv[4] if len(sys.argv) > 4 else "135"
    folder.mkdir(parents=True, exist_ok=True)
    logs = {weight: [] for weight in ["auto"] + WEIGHTS}
    apart = {weight: 0.0 for weight in logs}
    for sample in SAMPLES:
        subprocess.run([samples, str(folder), sample, height], check=True, stdout=subprocess.DEVNULL)
        of_sizes = {weight: [] for weight in logs}
        for size in SIZES:
            lit_for(folder / sample, size)
            fitted = measured(program, folder / sample, size, ["--weight", "auto"])
            near, far = re.search(r"([0-9.e+-]+) to ([0-9.e+-]+) m away", fitted.stderr).groups()
            scale = ["--weight-range", f"{float(near) / 1.1!r}:{float(far) * 1.1!r}"]
            errors = {}
            for weight in WEIGHTS:
                flags = ["--weight", weight] + (scale if weight in RANGED else [])
                flags += ["--weight-reference", repr(size)] if weight in CONSTANTS else []
                errors[weight] = max(error_of(measured(program, folder / sample, size, flags)), LEAST)
            best = min(errors.values())
            errors["auto"] = max(error_of(fitted), LEAST)
            for weight, error in errors.items():
                logs[weight].append(math.log(error / best))
                of_sizes[weight].append(error)
        for weight, found in of_sizes.items():
            differ = max(found) / min(found) - 1.0
            if differ > 0.01:
                print(f"{sample}, {weight}: {', '.join(f'{error:.4g}' for error in found)}", file=sys.stderr)
            apart[weight] = max(apart[weight], differ)
    print("| weight | error over the best listed one's | at worst | sizes differ by |\n| --- | --- | --- | --- |")
    for weight, values in sorted(logs.items(), key=lambda row: sum(row[1])):
        print(f"| `{weight}` | {math.exp(sum(values) / len(values)):.2f} | {math.exp(max(values)):.2f} | {100.0 * apart[weight]:.2g}% |")


if __name__ == "__main__":
    main()
