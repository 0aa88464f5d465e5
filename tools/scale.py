#!/usr/bin/env python3
"""Cleans meshes of 10,000 to 1,000,000 faces and prints the tables of docs/scale.md.

    cargo build --release --bins --example messy
    python3 tools/scale.py [--data DATA] [--preset fast] [--largest 1000000]

The meshes are those of `examples/messy.rs` (connected) and, with DATA, koala_im50k of that folder
1, 2, 6 and 20 times side by side. Run it on a machine that does nothing else: each mesh is cleaned
once with two threads, and one of them several times with one thread and with two, for what the second
one gains.
"""
import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

RELEASE = Path(__file__).resolve().parent.parent / "target" / "release"
SIZES = [10_000, 30_000, 100_000, 300_000, 1_000_000]
COPIES = [1, 2, 6, 20]
# Of these the phases are timed with one thread and with two.
PHASES = ["planning", "smoothing"]
PAIRS = 3


def generated(folder, program, faces):
    """A connected messy mesh and its reference."""
    mesh, reference = folder / f"messy{faces}.obj", folder / f"messy{faces}.ref.obj"
    subprocess.run(
        [program, "--faces", str(faces), "-o", mesh, "--reference", reference],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    return mesh, reference


def tiled(folder, data, copies):
    """The koala so many times side by side, and its reference."""
    made = []
    for name in ["koala_im50k.obj", "koala_im50k.ref.obj"]:
        points, faces = [], []
        for line in open(data / name):
            words = line.split()
            if line.startswith("v "):
                points.append([float(x) for x in words[1:4]])
            elif line.startswith("f "):
                faces.append([int(word.split("/")[0]) for word in words[1:]])
        if not made:
            width = 1.3 * (max(p[0] for p in points) - min(p[0] for p in points))
        path = folder / f"{copies}{name}"
        with open(path, "w") as out:
            for i in range(copies):
                out.writelines(f"v {x + i * width:.9g} {y:.9g} {z:.9g}\n" for x, y, z in points)
            for i in range(copies):
                first = i * len(points)
                out.writelines("f " + " ".join(str(v + first) for v in f) + "\n" for f in faces)
        made.append(path)
    return made


def clean(program, settings, mesh, reference, threads):
    """E, faces, inverted quads, seconds (of the clock, of processors, by phase), bytes at most."""
    report = mesh.with_suffix(".json")
    command = [program, "clean", mesh, "-r", reference, "-o", mesh.with_suffix(".out.obj")]
    command += ["--json", report, "-v", "-j", str(threads), *settings]
    with tempfile.TemporaryFile("w+") as told:
        began = time.time()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=told)
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.time() - began
        told.seek(0)
        text = told.read()
    if status:
        sys.exit(f"{mesh}: {text}")
    words = [line.split() for line in text.splitlines()]
    phases = {w[0]: float(w[1]) for w in words if len(w) == 3 and w[2] == "s" and w[0] in PHASES}
    told = json.loads(report.read_text())
    before, after = told["before"], told["after"]
    return {
        "faces": before["topology"]["F"],
        "e": [side["summary"]["irregular_elements"] for side in (before, after)],
        "inverted": after["quality"]["scaled_jacobian_quads"]["count_below_0"],
        "rms": after["reference"]["rms"] / before["reference"]["rms"],
        "hausdorff": after["reference"]["hausdorff"] / before["reference"]["hausdorff"],
        "wall": wall,
        "cpu": usage.ru_utime + usage.ru_stime,
        "bytes": 1024 * usage.ru_maxrss,
        "phases": phases,
    }


def table(title, runs):
    print(f"\n### {title}\n")
    print(
        "| faces | E | inverted quads | Hausdorff, RMS: after over before | time of the clock "
        "| of processors | exponent | largest size, GB | bytes a face |"
    )
    print("|---|---|---|---|---|---|---|---|---|")
    first = last = None
    for run in runs:
        first = first or run
        exponent = slope(last, run) if last else ""
        print(
            f"| {run['faces']:,} | {run['e'][0]:,} → {run['e'][1]:,} | {run['inverted']} "
            f"| {run['hausdorff']:.2f}, {run['rms']:.2f} | {run['wall'] / first['wall']:.1f} "
            f"| {run['cpu'] / first['cpu']:.1f} | {exponent} | {run['bytes'] / 1e9:.2f} "
            f"| {run['bytes'] / run['faces']:.0f} |",
            flush=True,
        )
        last = run
    print(
        f"\nOver the whole range the exponent is {slope(first, last)}; the last row took "
        f"{last['wall']:.0f} s of the clock and {last['cpu']:.0f} s of processors."
    )


def slope(a, b):
    """By which power of the number of faces the time of processors grows."""
    return f"{math.log(b['cpu'] / a['cpu']) / math.log(b['faces'] / a['faces']):.2f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, help="folder of koala_im50k.obj")
    parser.add_argument("--preset", default="fast")
    parser.add_argument("--release", type=Path, default=RELEASE, help="folder of the programs")
    parser.add_argument("--largest", type=int, default=SIZES[-1], help="faces of the largest mesh")
    options = parser.parse_args()
    program, settings = options.release / "quadmend", ["--preset", options.preset]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        sizes = [n for n in SIZES if n <= options.largest]
        make = options.release / "examples" / "messy"
        meshes = [generated(folder, make, n) for n in sizes]
        runs = (clean(program, settings, *mesh, 2) for mesh in meshes)
        table("Generated, connected", runs)
        if options.data:
            copies = [n for n in COPIES if 50_172 * n <= options.largest + 5_000]
            tiles = [tiled(folder, options.data, n) for n in copies]
            table("Koala, side by side", (clean(program, settings, *mesh, 2) for mesh in tiles))
            meshes = tiles
        speed_up(program, settings, meshes[-2 if len(meshes) > 1 else -1])


def speed_up(program, settings, mesh):
    """What a second thread gains, by the medians of several pairs of runs, one after the other."""
    runs = [[clean(program, settings, *mesh, threads) for threads in (1, 2)] for _ in range(PAIRS)]
    one, two = zip(*runs)
    gain = lambda seconds: statistics.median(map(seconds, one)) / statistics.median(map(seconds, two))
    gains = [f"{name} {gain(lambda run: run['phases'][name]):.2f}" for name in PHASES]
    gains.append(f"all {gain(lambda run: run['wall']):.2f}")
    print(f"\nA second thread on {one[0]['faces']:,} faces:", ", ".join(gains), "times as fast.")


if __name__ == "__main__":
    main()
