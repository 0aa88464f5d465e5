#!/usr/bin/env python3
"""Switches off one part of the automation after the other and prints what is left of it.

    python3 tools/ablation.py DATA [MESH ...] > docs/ablation.md

DATA is a folder with NAME.obj and NAME.ref.obj; without MESH, all of them. Runs the release
build (`cargo build --release`) with the default preset, one `--set` after the other. Figures are
sums of irregular elements, and geometric means of the ratio of two things after to before: the
angle deviation, and the mean distance of the creases of the reference to edges, if it has any.
"""
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM = Path(__file__).resolve().parent.parent / "target" / "release" / "quadmend"

# What is switched off, and the settings that do it.
VARIANTS = [
    ("nothing: the default", []),
    ("moves (reductions, walks, type changes)", ["plan.depth=0", "plan.reach=0"]),
    ("walks in the movement graph", ["plan.reach=0"]),
    ("type changes of T-junctions at the end", ["plan.lambda_types=0"]),
    ("refills and relocations", ["plan.patch_faces_first=0", "plan.patch_faces_last=0", "plan.relocations=0"]),
    ("relocations", ["plan.relocations=0"]),
    ("crossings of features", ["plan.crossings=0"]),
    ("sliding along features", ["plan.slides=0"]),
    ("crossings and sliding", ["plan.crossings=0", "plan.slides=0"]),
    ("settling on creases", ["plan.settles_edges=0"]),
    ("drawing edges to creases", ["plan.crease_worth=0"]),
    ("settling and drawing", ["plan.settles_edges=0", "plan.crease_worth=0"]),
    ("the global plan: greedy alone", ["plan.global=0"]),
    ("refills around neighbours: the global plan alone", ["plan.partners=0"]),
    ("global plan and neighbours", ["plan.global=0", "plan.partners=0"]),
    ("the budget of angles", ["gate.angles=100"]),
    ("large patches (all at most 60 faces)", ["plan.patch_faces_last=60"]),
    ("all fillings of a patch but the first", ["plan.fillings=1"]),
    ("stages (one, at the last exchange rate)", ["plan.stages=1", "plan.lambda_first=3500", "plan.patch_faces_first=2000"]),
    ("smoothing between stages", ["plan.smooth_between=0"]),
    ("relaxing before an edit is judged", ["gate.sweeps=1", "gate.refill_sweeps=1"]),
    ("cost of quads added or removed", ["cost.quads=0"]),
    ("cost of type changes", ["cost.type_change=0"]),
    ("cost of passing features", ["cost.near_feature=0"]),
    ("cost of edge lengths", ["cost.edge_length=0"]),
    ("cost of triple cancellations", ["cost.triple=0"]),
    ("nothing, and curvature costs 1", ["cost.curvature=1"]),
    ("nothing, and a face costs 100 more than a vertex", ["cost.face=100"]),
    ("nothing, and a face costs 100 less than a vertex", ["cost.face=-100"]),
]


def clean(data: Path, name: str, settings: list[str], folder: Path) -> dict:
    report = folder / "report.json"
    command = [PROGRAM, "clean", data / f"{name}.obj", "--reference", data / f"{name}.ref.obj"]
    command += ["--output", folder / "clean.obj", "--json", report, "--quiet", "--force"]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return json.loads(report.read_text())


def main() -> None:
    data = Path(sys.argv[1])
    names = sys.argv[2:] or sorted(p.name[: -len(".ref.obj")] for p in data.glob("*.ref.obj"))
    print("| switched off | " + " | ".join(names) + " | Σ E | angle ratio | crease ratio | T |")
    print("|---" * (len(names) + 5) + "|")
    for title, settings in VARIANTS:
        elements, angles, creases, hanging = [], [], [], 0
        with tempfile.TemporaryDirectory() as folder:
            for name in names:
                report = clean(data, name, settings, Path(folder))
                before, after = report["before"]["summary"], report["after"]["summary"]
                elements.append(after["irregular_elements"])
                angles.append(after["fig10_mean"] / before["fig10_mean"])
                near = [report[when]["reference"]["features"] for when in ("before", "after")]
                if near[0]["reference_edges"] > 0:
                    near = [n["to_any_mesh_edge"]["mean"] for n in near]
                    creases.append(near[1] / near[0])
                hanging += after["t_junctions"]
        ratios = [f"{statistics.geometric_mean(r):.3f}" if r else "" for r in (angles, creases)]
        cells = [title, *map(str, elements), str(sum(elements)), *ratios, str(hanging)]
        print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
