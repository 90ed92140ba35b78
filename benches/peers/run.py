#!/usr/bin/env python3
"""Other meshers beside trigrade on the same domains: quality and time, as a table.

    python3 benches/peers/run.py --trigrade target/release/trigrade [DOMAIN.poly ...]

Needs the Python packages gmsh, netgen-mesher and triangle; one that is missing is left out and said
so. Domains are Triangle's .poly files of closed rings with hole points; without any, the golden ones
are taken. Every mesher keeps the boundary as it is; sizes inside are each mesher's own from the
boundary. Times are those of the meshing call alone, for trigrade front and improvement.
"""

import argparse
import json
import math
import pathlib
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def read_poly(path):
    """Points, segments and hole points of a .poly file."""
    lines = [line.split("#")[0].split() for line in path.read_text().splitlines()]
    lines = iter([line for line in lines if line])
    count = int(next(lines)[0])
    points, number = [], {}
    for _ in range(count):
        line = next(lines)
        number[int(line[0])] = len(points)
        points.append((float(line[1]), float(line[2])))
    head = next(lines)
    segments = []
    for _ in range(int(head[0])):
        line = next(lines)
        segments.append((number[int(line[1])], number[int(line[2])]))
    holes = []
    for _ in range(int(next(lines)[0])):
        line = next(lines)
        holes.append((float(line[1]), float(line[2])))
    return points, segments, holes


def rings_of(segments):
    """Closed rings of the segments, each as a list of points; None where they are no rings."""
    after = {}
    for a, b in segments:
        after.setdefault(a, []).append(b)
        after.setdefault(b, []).append(a)
    if any(len(ends) != 2 for ends in after.values()):
        return None
    rings, left = [], set(after)
    while left:
        start = min(left)
        ring, before, at = [start], None, start
        while True:
            left.discard(at)
            first, second = after[at]
            before, at = at, second if first == before else first
            if at == start:
                break
            ring.append(at)
        rings.append(ring)
    return rings


def area(points, ring):
    pairs = zip(ring, ring[1:] + ring[:1])
    return 0.5 * sum(points[a][0] * points[b][1] - points[b][0] * points[a][1] for a, b in pairs)


def figures(points, triangles):
    """Mean, 99th percentile and largest R/(2r), smallest angle, 99th percentile of area ratios."""
    ratios, angle, areas, sides = [], math.inf, [], {}
    for index, (i, j, k) in enumerate(triangles):
        p, q, r = points[i], points[j], points[k]
        a, b, c = math.dist(q, r), math.dist(r, p), math.dist(p, q)
        twice = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        areas.append(abs(twice))
        product = (b + c - a) * (c + a - b) * (a + b - c)
        ratios.append(a * b * c / product if product > 0 else math.inf)
        for x, y, z in ((a, b, c), (b, c, a), (c, a, b)):
            cosine = max(-1.0, min(1.0, (y * y + z * z - x * x) / (2 * y * z)))
            angle = min(angle, math.degrees(math.acos(cosine)))
        for side in ((i, j), (j, k), (k, i)):
            sides.setdefault(frozenset(side), []).append(index)
    neighbours = [areas[s[0]] / areas[s[1]] for s in sides.values() if len(s) == 2]
    neighbours = sorted(max(ratio, 1 / ratio) for ratio in neighbours)
    ratios.sort()
    at = lambda values: values[(len(values) - 1) * 99 // 100]
    return sum(ratios) / len(ratios), at(ratios), ratios[-1], angle, at(neighbours)


def lost_edges(segments, triangles):
    """Boundary segments that are no edges of the mesh."""
    edges = {frozenset(pair) for t in triangles for pair in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
    return sum(frozenset(segment) not in edges for segment in segments)


def with_gmsh(points, segments, holes):
    import gmsh

    rings = rings_of(segments)
    if rings is None:
        raise ValueError("the segments are no rings")
    outer = max(rings, key=lambda ring: abs(area(points, ring)))
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.Algorithm", 6)
        gmsh.model.add("domain")
        for i, (x, y) in enumerate(points):
            gmsh.model.geo.addPoint(x, y, 0, tag=i + 1)
        loops = []
        for ring in [outer] + [ring for ring in rings if ring is not outer]:
            lines = []
            for a, b in zip(ring, ring[1:] + ring[:1]):
                line = gmsh.model.geo.addLine(a + 1, b + 1)
                gmsh.model.geo.mesh.setTransfiniteCurve(line, 2)
                lines.append(line)
            loops.append(gmsh.model.geo.addCurveLoop(lines))
        gmsh.model.geo.addPlaneSurface(loops)
        gmsh.model.geo.synchronize()
        start = time.perf_counter()
        gmsh.model.mesh.generate(2)
        seconds = time.perf_counter() - start
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        place = {int(tag): i for i, tag in enumerate(tags)}
        nodes = [(coordinates[3 * i], coordinates[3 * i + 1]) for i in range(len(tags))]
        corners = gmsh.model.mesh.getElementsByType(2)[1]
        corners = [place[int(tag)] for tag in corners]
        triangles = [tuple(corners[i : i + 3]) for i in range(0, len(corners), 3)]
        return nodes, triangles, seconds
    finally:
        gmsh.finalize()


def with_netgen(points, segments, holes):
    from netgen.geom2d import SplineGeometry

    rings = rings_of(segments)
    if rings is None:
        raise ValueError("the segments are no rings")
    outer = max(rings, key=lambda ring: abs(area(points, ring)))
    geometry = SplineGeometry()
    for x, y in points:
        geometry.AppendPoint(x, y)
    largest = 0.0
    for ring in rings:
        left = (area(points, ring) > 0) == (ring is outer)
        for a, b in zip(ring, ring[1:] + ring[:1]):
            length = math.dist(points[a], points[b])
            largest = max(largest, length)
            inside = (1, 0) if left else (0, 1)
            geometry.Append(["line", a, b], leftdomain=inside[0], rightdomain=inside[1], maxh=length * 1.001)
    start = time.perf_counter()
    mesh = geometry.GenerateMesh(maxh=largest * 1.001, grading=0.25)
    seconds = time.perf_counter() - start
    nodes = [(p.p[0], p.p[1]) for p in mesh.Points()]
    triangles = [tuple(v.nr - 1 for v in element.vertices) for element in mesh.Elements2D()]
    return nodes, triangles, seconds


def with_triangle(points, segments, holes):
    import triangle

    plc = {"vertices": points, "segments": segments}
    if holes:
        plc["holes"] = holes
    start = time.perf_counter()
    # Y: no new points on the boundary.
    mesh = triangle.triangulate(plc, "pYYq33")
    seconds = time.perf_counter() - start
    nodes = [tuple(p) for p in mesh["vertices"].tolist()]
    return nodes, [tuple(t) for t in mesh["triangles"].tolist()], seconds


def with_trigrade(program, options):
    def run(path):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "mesh.off"
            command = [program, "mesh", str(path), "-o", str(out), "--json", *options]
            answer = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
            lines = iter(out.read_text().split("\n")[1:])
            counts = [int(n) for n in next(lines).split()]
            nodes = [tuple(map(float, next(lines).split()[:2])) for _ in range(counts[0])]
            triangles = [tuple(map(int, next(lines).split()[1:4])) for _ in range(counts[1])]
            seconds = answer["seconds"]
            return nodes, triangles, seconds["front"] + seconds["improve"]

    return run


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--trigrade", default=str(ROOT / "target/release/trigrade"))
    parser.add_argument("domains", nargs="*", type=pathlib.Path)
    arguments = parser.parse_args()
    golden = ROOT / "tests/golden"
    names = ["airfoil", "three_element", "l_shape", "narrow_channel", "spiral", "comb", "jump"]
    domains = arguments.domains or [golden / f"{name}.poly" for name in names]
    ours = {
        "trigrade": with_trigrade(arguments.trigrade, []),
        "trigrade -O2": with_trigrade(arguments.trigrade, ["--optimize", "2"]),
    }
    peers = {"gmsh frontal": with_gmsh, "netgen": with_netgen, "triangle q33": with_triangle}
    print(f"{'domain':20} {'mesher':14} {'triangles':>9} {'mean':>7} {'99 %':>7} {'max':>8} "
          f"{'angle':>6} {'area99':>7} {'k/s':>7}  boundary")
    for path in domains:
        points, segments, holes = read_poly(path)
        for name, mesher in [*ours.items(), *peers.items()]:
            try:
                if name in ours:
                    nodes, triangles, seconds = mesher(path)
                else:
                    nodes, triangles, seconds = mesher(points, segments, holes)
                mean, p99, worst, angle, neighbours = figures(nodes, triangles)
            except Exception as error:  # a peer's failure is a row of the table
                print(f"{path.stem:20} {name:14} failed: {type(error).__name__}: {str(error)[:60]}")
                continue
            place = {p: i for i, p in enumerate(nodes)}
            try:
                kept = [(place[points[a]], place[points[b]]) for a, b in segments]
                lost = lost_edges(kept, triangles)
                boundary = "kept" if lost == 0 else f"{lost} of {len(segments)} edges lost"
            except KeyError:
                boundary = "points moved"
            print(f"{path.stem:20} {name:14} {len(triangles):9} {mean:7.4f} {p99:7.3f} {worst:8.3f} "
                  f"{angle:6.1f} {neighbours:7.2f} {len(triangles) / seconds / 1e3:7.0f}  {boundary}")


if __name__ == "__main__":
    main()
