#!/usr/bin/env python3
"""Surface patches meshed by trigrade and by Gmsh (frontal), side by side on the same shapes.

    pip install gmsh numpy
    cargo build --release
    python benches/peers/surfaces.py [target/release/trigrade] [TRIANGLES]

For each shape: triangles, R/2r in space (mean, 99 %, max), folded edges (neighbours whose normals
differ by more than 90 degrees), and triangles per second of processor time of one thread: of Gmsh
for `generate` alone, of trigrade for the whole program, reading and writing included. Gmsh is asked
for curves and surfaces of its own that have the same shape, with one spacing everywhere; on the last
shape the boundary alone says how large triangles are.
"""
import json
import multiprocessing
import pathlib
import resource
import subprocess
import sys
import tempfile

import gmsh
import numpy

HERE = pathlib.Path(__file__).resolve().parents[2]
MODELS = HERE / "examples/models"
SHEARED = [
    [[0, 0, 0], [10, 0.2, 0.3], [20, 0.4, 0]],
    [[1, 0.1, 0.2], [11, 0.3, -0.3], [21, 0.5, 0.2]],
    [[2, 0.2, 0], [12, 0.4, 0.2], [22, 0.6, 0]],
]


def cpu(who=resource.RUSAGE_SELF):
    use = resource.getrusage(who)
    return use.ru_utime + use.ru_stime


def model(name):
    return json.loads((MODELS / (name + ".json")).read_text())


def quality(points, triangles):
    """R/2r of each triangle, and the number of folded edges."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    sides = [numpy.linalg.norm(q - p, axis=1) for p, q in ((a, b), (b, c), (c, a))]
    normal = numpy.cross(b - a, c - a)
    area = 0.5 * numpy.linalg.norm(normal, axis=1)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        ratio = sides[0] * sides[1] * sides[2] * sum(sides) / (16 * area**2)
    beside = {}
    folds = 0
    for t, (i, j, k) in enumerate(triangles):
        for edge in ((i, j), (j, k), (k, i)):
            other = beside.setdefault((min(edge), max(edge)), t)
            folds += other != t and normal[other] @ normal[t] < 0
    return ratio, folds


def spline_surface(net, degree):
    rows, columns = len(net), len(net[0])
    # u runs fastest in Gmsh's list.
    tags = [gmsh.model.occ.addPoint(*net[i][j]) for j in range(columns) for i in range(rows)]
    def knots(count):
        inner = count - degree
        return list(range(inner + 1)), [degree + 1] + [1] * (inner - 1) + [degree + 1]
    (ku, mu), (kv, mv) = knots(rows), knots(columns)
    gmsh.model.occ.addBSplineSurface(
        tags, rows, degreeU=degree, degreeV=degree, knotsU=ku, knotsV=kv, multiplicitiesU=mu, multiplicitiesV=mv
    )
    gmsh.model.occ.synchronize()


def wave():
    spline_surface(model("wave")["patches"][0]["net"], 3)


def sheared():
    spline_surface(SHEARED, 2)


def torus():
    gmsh.model.occ.addTorus(0, 0, 0, 2, 0.5)
    gmsh.model.occ.synchronize()


def vase():
    points = model("vase")["patches"][0]["profile"]["points"]
    count = len(points)
    tags = [gmsh.model.occ.addPoint(*p) for p in points]
    knots = list(range(count - 2))
    curve = gmsh.model.occ.addBSpline(tags, degree=3, knots=knots, multiplicities=[4] + [1] * (count - 4) + [4])
    gmsh.model.occ.revolve([(1, curve)], 0, 0, 0, 0, 0, 1, 2 * numpy.pi)
    gmsh.model.occ.synchronize()


def coons():
    """Both patches; Gmsh's surface filling between four curves is the same transfinite map."""
    text = model("two_coons")
    ends, curves = {}, {}
    for curve in text["curves"]:
        points = [tuple(p) for p in curve["points"]]
        tags = [ends.setdefault(p, None) or gmsh.model.geo.addPoint(*p) for p in (points[0], points[-1])]
        ends[points[0]], ends[points[-1]] = tags
        inner = [gmsh.model.geo.addPoint(*p) for p in points[1:-1]]
        curves[curve["name"]] = gmsh.model.geo.addBezier([tags[0], *inner, tags[1]])
    for patch in text["patches"]:
        signed = {side: (-1 if name[0] == "-" else 1) * curves[name.lstrip("-")] for side, name in patch["sides"].items()}
        loop = [signed["south"], signed["east"], -signed["north"], -signed["west"]]
        gmsh.model.geo.addSurfaceFilling([gmsh.model.geo.addCurveLoop(loop)])
    gmsh.model.geo.synchronize()


GRADED_CORNERS = [(0, 0, 0), (3, 0, 0), (3, 3, 1), (0, 3, 0)]
GRADED_ENDS = (0.0005, 0.47)


def graded_model():
    """A bilinear patch whose boundary edges grow from 0.0005 to 0.47, 940 to 1."""
    names = ["south", "east", "north", "west"]
    sw, se, ne, nw = (list(p) for p in GRADED_CORNERS)
    curves = []
    for name, points in zip(names, [[sw, se], [se, ne], [nw, ne], [sw, nw]]):
        low = GRADED_ENDS[0] if name in ("south", "west") else GRADED_ENDS[1]
        curves.append({"name": name, "kind": "polyline", "points": points, "graded": [low, GRADED_ENDS[1]]})
    sides = {name: name for name in names}
    return {"curves": curves, "patches": [{"kind": "coons", "sides": sides}]}


def graded():
    """The same boundary nodes' spacings for Gmsh: sizes at the corners, none but the boundary's inside."""
    sizes = [GRADED_ENDS[0]] + 3 * [GRADED_ENDS[1]]
    tags = [gmsh.model.geo.addPoint(*p, size) for p, size in zip(GRADED_CORNERS, sizes)]
    lines = [gmsh.model.geo.addLine(tags[i], tags[(i + 1) % 4]) for i in range(4)]
    gmsh.model.geo.addSurfaceFilling([gmsh.model.geo.addCurveLoop(lines)])
    gmsh.model.geo.synchronize()


def by_gmsh(build, spacing):
    gmsh.initialize(["-nt", "1"])
    gmsh.option.setNumber("General.Verbosity", 0)
    gmsh.option.setNumber("Mesh.Algorithm", 6)
    if spacing:
        gmsh.option.setNumber("Mesh.MeshSizeMin", spacing)
        gmsh.option.setNumber("Mesh.MeshSizeMax", spacing)
    build()
    start = cpu()
    gmsh.model.mesh.generate(2)
    seconds = cpu() - start
    tags, at, _ = gmsh.model.mesh.getNodes()
    index = numpy.zeros(int(tags.max()) + 1, dtype=int)
    index[tags] = numpy.arange(len(tags))
    points = at.reshape(-1, 3)
    _, corners = gmsh.model.mesh.getElementsByType(2)
    gmsh.finalize()
    return points, index[corners].reshape(-1, 3), seconds


def in_time(build, spacing):
    """The same in a process of its own, which has LIMIT seconds by the clock."""
    with multiprocessing.get_context("fork").Pool(1) as pool:
        return pool.apply_async(by_gmsh, (build, spacing)).get(LIMIT)


def by_trigrade(program, path, spacing, folder):
    out = folder / "a.off"
    command = [program, "mesh", path, "-o", out, "--no-check", "--max-triangles", "50000000"]
    if spacing:
        command += ["--spacing", str(spacing)]
    start = cpu(resource.RUSAGE_CHILDREN)
    run = subprocess.run(command, capture_output=True, text=True, env={"RAYON_NUM_THREADS": "1"})
    seconds = cpu(resource.RUSAGE_CHILDREN) - start
    assert run.returncode == 0, run.stdout + run.stderr
    lines = out.read_text().splitlines()
    points, triangles = (int(x) for x in lines[1].split()[:2])
    at = numpy.array([line.split() for line in lines[2 : 2 + points]], dtype=float)
    corners = numpy.array([line.split()[1:4] for line in lines[2 + points : 2 + points + triangles]], dtype=int)
    return at, corners, seconds


LIMIT = 60
SHAPES = [
    ("Coons (two)", coons, "two_coons", 11.7),
    ("B-spline", wave, "wave", 45.0),
    ("torus", torus, "torus", 39.5),
    ("vase", vase, "vase", 20.5),
    ("sheared", sheared, None, 8.0),
    ("graded 940:1", graded, None, None),
]


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else HERE / "target/release/trigrade"
    wanted = float(sys.argv[2]) if len(sys.argv) > 2 else 50_000
    print("| shape | mesher | triangles | mean | 99 % | max | folds | thousand/s |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for shape, build, example, area in SHAPES:
            spacing = area and round((area / (0.433 * wanted)) ** 0.5, 5)
            text = model(example) if example else {"patches": [{"kind": "bezier", "net": SHEARED}]}
            if build is graded:
                text = graded_model()
            for curve in text.get("curves", []):
                curve.pop("count", None)
            for patch in text["patches"]:
                if patch["kind"] != "coons":
                    patch.pop("sides", None)
            path = folder / "model.json"
            path.write_text(json.dumps(text))
            runs = [("trigrade", lambda: by_trigrade(program, path, spacing, folder)), ("Gmsh", lambda: in_time(build, spacing))]
            for mesher, run in runs:
                try:
                    points, triangles, seconds = run()
                except Exception as error:  # Gmsh raises Exception itself
                    said = str(error).splitlines() or [f"not done after {LIMIT} s"]
                    print(f"| {shape} | {mesher} | {said[-1]} | | | | | |", flush=True)
                    continue
                ratio, folds = quality(points, triangles)
                print(f"| {shape} | {mesher} | {len(triangles):,} | {ratio.mean():.4f} | {numpy.percentile(ratio, 99):.3f} | {ratio.max():.3f} | {folds} | {len(triangles) / seconds / 1e3:.0f} |", flush=True)


if __name__ == "__main__":
    main()
