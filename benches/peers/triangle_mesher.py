#!/usr/bin/env python3
"""Triangle as a command, for `trigrade torture`: reads a .poly, writes an OFF file.

    pip install triangle
    trigrade torture --mesher 'python3 benches/peers/triangle_mesher.py {in} {out} p' --form poly --answer off --plain

The last argument is Triangle's own switches; `p` keeps the boundary (without `Y` it may split it).
"""
import sys

from triangle import triangulate


def main():
    rows = (line.split("#")[0].split() for line in open(sys.argv[1]))
    rows = iter([row for row in rows if row])
    number, points = {}, []
    for _ in range(int(next(rows)[0])):
        row = next(rows)
        number[row[0]] = len(points)
        points.append([float(row[1]), float(row[2])])
    segments = []
    for _ in range(int(next(rows)[0])):
        row = next(rows)
        segments.append([number[row[1]], number[row[2]]])
    holes = []
    for _ in range(int(next(rows)[0])):
        row = next(rows)
        holes.append([float(row[1]), float(row[2])])
    domain = dict(vertices=points, segments=segments)
    if holes:
        domain["holes"] = holes
    mesh = triangulate(domain, sys.argv[3])
    triangles = mesh.get("triangles", [])
    with open(sys.argv[2], "w") as out:
        out.write(f"OFF\n{len(mesh['vertices'])} {len(triangles)} 0\n")
        for x, y in mesh["vertices"]:
            out.write(f"{float(x)!r} {float(y)!r} 0\n")
        for a, b, c in triangles:
            out.write(f"3 {a} {b} {c}\n")


if __name__ == "__main__":
    main()
