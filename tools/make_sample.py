#!/usr/bin/env python3
"""Makes the sample mesh of `quadmend demo`: assets/bracket.ref.obj and assets/bracket.obj.

    pip install numpy pyinstantmeshes==1.0.0
    python3 tools/make_sample.py

The solid is a bored boss and a ring joined by an arm, written as a signed function: two smooth
blends, four sharp rims, genus 2. Dual contouring (Ju et al. 2002) turns it into the reference
surface, whose vertices lie on the sharp rims; Instant Meshes (Jakob et al. 2015) in its
quad-dominant mode turns that into the mesh to be cleaned. Running quadmend needs none of this.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np

ASSETS = Path(__file__).resolve().parent.parent / "assets"
LOW, HIGH = np.array([-0.8, -0.9, -0.7]), np.array([2.5, 0.9, 0.7])


def smooth_min(a, b, k):
    """The smaller of both, with a rounded transition where they differ by less than k."""
    h = np.clip(0.5 + 0.5 * (b - a) / k, 0.0, 1.0)
    return b + (a - b) * h - k * h * (1.0 - h)


def cylinder(p, radius, half_height):
    """An upright cylinder around the z axis: sharp rims."""
    return np.maximum(np.hypot(p[..., 0], p[..., 1]) - radius, np.abs(p[..., 2]) - half_height)


def capsule(p, a, b, radius):
    """All points within `radius` of the segment ab."""
    along = np.clip(((p - a) @ (b - a)) / ((b - a) @ (b - a)), 0.0, 1.0)
    return np.linalg.norm(p - a - along[..., None] * (b - a), axis=-1) - radius


def torus(p, centre, major, minor, tilt):
    """A torus whose axis is the z axis turned by `tilt` about the x axis."""
    x, y, z = np.moveaxis(p - centre, -1, 0)
    c, s = np.cos(tilt), np.sin(tilt)
    y, z = c * y + s * z, c * z - s * y
    return np.hypot(np.hypot(x, y) - major, z) - minor


def solid(p):
    """Negative inside."""
    boss = cylinder(p, 0.6, 0.45)
    arm = capsule(p, np.array([0.3, 0.0, 0.0]), np.array([1.25, 0.0, 0.08]), 0.2)
    ring = torus(p, np.array([1.75, 0.0, 0.08]), 0.45, 0.19, 0.6)
    body = smooth_min(smooth_min(arm, ring, 0.25), boss, 0.22)
    bore = cylinder(p - np.array([0.05, 0.0, 0.0]), 0.3, 9.0)
    return np.maximum(body, -bore)


def gradient(p, step=1e-5):
    """Unit normal of the level set through p, by central differences."""
    axes = np.eye(3) * step
    g = np.stack([solid(p + a) - solid(p - a) for a in axes], axis=-1)
    return g / np.linalg.norm(g, axis=-1, keepdims=True)


def crossings(grid, values, axis):
    """Grid edges along `axis` that cross the surface: low ends, points, and direction."""
    cut = [slice(None)] * 3
    cut[axis] = slice(None, -1)
    first = values[tuple(cut)]
    cut[axis] = slice(1, None)
    last = values[tuple(cut)]
    low = np.argwhere((first < 0) != (last < 0))
    step = np.eye(3, dtype=int)[axis]
    a, b = grid[tuple(low.T)], grid[tuple((low + step).T)]
    inside_first = solid(a) < 0
    for _ in range(50):
        middle = (a + b) / 2
        same = (solid(middle) < 0) == inside_first
        a, b = np.where(same[:, None], middle, a), np.where(same[:, None], b, middle)
    return low, (a + b) / 2, inside_first


def dual_contour(cell):
    """Vertices and quads of the surface: one vertex a cell, one quad a crossed grid edge."""
    counts = np.ceil((HIGH - LOW) / cell).astype(int)
    # The odd offset keeps grid planes off the planes of the solid.
    axes = [LOW[i] + (np.arange(counts[i] + 1) + 0.137) * cell for i in range(3)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    values = solid(grid)
    samples, quads = {}, []
    for axis in range(3):
        u, v = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
        low, points, inside_first = crossings(grid, values, axis)
        normals = gradient(points)
        for at, point, normal, outward in zip(low, points, normals, inside_first):
            ring = [tuple(at - u - v), tuple(at - v), tuple(at), tuple(at - u)]
            for box in ring:
                samples.setdefault(box, []).append((point, normal))
            quads.append(ring if outward else ring[::-1])
    cells = sorted(samples)
    number = {box: i for i, box in enumerate(cells)}
    vertices = np.array([vertex(samples[box]) for box in cells])
    return vertices, np.array([[number[box] for box in quad] for quad in quads])


def vertex(samples):
    """The point closest to the tangent planes of the samples, near their mean."""
    points, normals = (np.array(x) for x in zip(*samples))
    mean = points.mean(axis=0)
    shift = np.einsum("ij,ij->i", normals, points - mean)
    # Directions that the planes leave open stay at the mean.
    return mean + np.linalg.lstsq(normals, shift, rcond=0.1)[0]


def triangulate(vertices, quads):
    """Cuts each quad along its shorter diagonal."""
    a, b, c, d = (vertices[quads[:, i]] for i in range(4))
    short = np.linalg.norm(a - c, axis=1) <= np.linalg.norm(b - d, axis=1)
    turned = np.where(short[:, None], quads, np.roll(quads, -1, axis=1))
    return np.concatenate([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])


def read_faces(path):
    """Points and polygons of an OBJ file."""
    rows = [line.split() for line in Path(path).read_text().splitlines()]
    points = np.array([row[1:4] for row in rows if row[:1] == ["v"]], dtype=float)
    faces = [[int(c.split("/")[0]) - 1 for c in row[1:]] for row in rows if row[:1] == ["f"]]
    return points, faces


def write(path, points, faces, about):
    lines = [f"# {about}"]
    lines += ["v " + " ".join(f"{x:.5g}" for x in p) for p in points]
    lines += ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    print(f"{path}: {len(points)} vertices, {len(faces)} faces, {path.stat().st_size} bytes")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cell", type=float, default=0.055, help="grid cell of the reference")
    parser.add_argument("--faces", type=int, default=3500, help="faces asked of Instant Meshes")
    parser.add_argument("--crease", type=float, default=30.0, help="crease angle in degrees")
    parser.add_argument("--output", type=Path, default=ASSETS, help="folder for both files")
    options = parser.parse_args()

    import pyinstantmeshes

    vertices, quads = dual_contour(options.cell)
    reference = options.output / "bracket.ref.obj"
    about = "A bored boss and a ring joined by an arm; made by tools/make_sample.py"
    write(reference, vertices, triangulate(vertices, quads), about)
    with tempfile.TemporaryDirectory() as folder:
        remesh = str(Path(folder) / "remesh.obj")
        pyinstantmeshes.remesh_file(
            str(reference), remesh, target_face_count=options.faces,
            crease_angle=options.crease, extrinsic=True, deterministic=True,
        )
        points, faces = read_faces(remesh)
    about = "bracket.ref.obj remeshed by Instant Meshes, quad-dominant; made by tools/make_sample.py"
    write(options.output / "bracket.obj", points, faces, about)


if __name__ == "__main__":
    main()
