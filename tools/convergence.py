#!/usr/bin/env python3
"""Draws how irregularity falls while meshes are cleaned: E against time, as SVG.

    python3 tools/convergence.py DATA MESH [MESH ...] > docs/convergence.svg

DATA is a folder with NAME.obj and NAME.ref.obj. Runs the release build with `--verbose`, which
tells when E (the sum of |4 - valence| over vertices and faces, boundaries and features by sector)
fell to what. Both axes are relative, since machines differ: E to that of the input, time to that
of the whole run, measuring and writing included.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM = Path(__file__).resolve().parent.parent / "target" / "release" / "quadmend"
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 720, 420, 60, 20, 160, 50
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]


def fall(data: Path, name: str) -> list[tuple[float, float]]:
    with tempfile.TemporaryDirectory() as folder:
        command = [PROGRAM, "clean", data / f"{name}.obj", "--reference", data / f"{name}.ref.obj"]
        command += ["--output", Path(folder) / "clean.obj", "--verbose"]
        told = subprocess.run(command, check=True, capture_output=True, text=True).stderr
    points = [(float(t), int(e)) for e, t in re.findall(r"^ *E (\d+) +([\d.]+) s$", told, re.M)]
    phases = re.findall(r"^ *(?:reading|reference|planning|smoothing|measuring|writing) +([\d.]+) s$", told, re.M)
    total = sum(map(float, phases))
    return [(t / total, e / points[0][1]) for t, e in points] + [(1.0, points[-1][1] / points[0][1])]


def main() -> None:
    data, names = Path(sys.argv[1]), sys.argv[2:]
    wide, high = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM

    def x(t: float) -> float:
        return LEFT + wide * t

    def y(e: float) -> float:
        return TOP + high * (1 - e)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="13">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>']
    for k in range(6):
        share = k / 5
        out.append(f'<path d="M{x(0):.1f} {y(share):.1f}H{x(1):.1f}" stroke="#ddd"/>')
        out.append(f'<text x="{LEFT - 8}" y="{y(share) + 4:.1f}" text-anchor="end">{share:.1f}</text>')
        out.append(f'<text x="{x(share):.1f}" y="{y(0) + 18:.1f}" text-anchor="middle">{share:.1f}</text>')
    out.append(f'<text x="{x(0.5):.1f}" y="{HEIGHT - 8}" text-anchor="middle">time, share of the whole run</text>')
    out.append(f'<text transform="translate(16 {y(0.5):.1f}) rotate(-90)" text-anchor="middle">E, share of the input</text>')
    for i, name in enumerate(names):
        colour, points = COLOURS[i % len(COLOURS)], fall(data, name)
        steps = f"M{x(0):.1f} {y(1):.1f}" + "".join(f"H{x(t):.1f}V{y(e):.1f}" for t, e in points)
        out.append(f'<path d="{steps}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out.append(f'<text x="{x(1) + 10}" y="{TOP + 16 + 20 * i}" fill="{colour}">{name}</text>')
    print("\n".join(out + ["</svg>"]))


if __name__ == "__main__":
    main()
