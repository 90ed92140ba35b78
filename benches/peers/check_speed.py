#!/usr/bin/env python3
"""How long checkers take on the same meshes: processor time of one thread, side by side.

    pip install gmsh triangle meshio pyvista shapely
    cargo build --release
    python benches/peers/check_speed.py SQUARE.json [target/release/trigrade]

SQUARE.json is any domain; it is meshed by trigrade. `triangle -rC` checks the consistency of its
own reconstruction and the Delaunay property; `gmsh -check` looks for degenerate elements and
duplicate vertices; shapely validates polygons and their coverage; pyvista runs `validate_mesh`.
Reading is left out where the program is called as a library and told apart where it is not.
"""
import json
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parents[2]


def cpu(who):
    use = resource.getrusage(who)
    return use.ru_utime + use.ru_stime


def command(*arguments):
    """Processor seconds of a command and what it said."""
    before = cpu(resource.RUSAGE_CHILDREN)
    run = subprocess.run(arguments, capture_output=True, text=True)
    return cpu(resource.RUSAGE_CHILDREN) - before, run.stdout + run.stderr


def library(code, path):
    """Processor seconds of the statement `work()` in a process of its own."""
    head = "import sys, resource, numpy\ndef cpu():\n u = resource.getrusage(resource.RUSAGE_SELF)\n return u.ru_utime + u.ru_stime\n"
    load = "import meshio\nm = meshio.read(sys.argv[1])\npoints = m.points\ntriangles = numpy.vstack([c.data for c in m.cells if c.type == 'triangle'])\n"
    tail = "t = cpu()\nwork()\nprint('SECONDS', cpu() - t)\n"
    _, said = command(sys.executable, "-c", head + load + code + tail, str(path))
    seconds = [line.split()[1] for line in said.splitlines() if line.startswith("SECONDS")]
    return float(seconds[0]) if seconds else None


PEERS = {
    "triangle -rC": "import triangle\nd = dict(vertices=points[:, :2], triangles=triangles.astype('int32'))\ndef work(): triangle.triangulate(d, 'rC')\n",
    "triangle -r (without the check)": "import triangle\nd = dict(vertices=points[:, :2], triangles=triangles.astype('int32'))\ndef work(): triangle.triangulate(d, 'r')\n",
    "shapely coverage": "import shapely\ndef work():\n r = points[:, :2][numpy.hstack([triangles, triangles[:, :1]])]\n p = shapely.polygons(r)\n assert shapely.is_valid(p).all() and shapely.coverage_is_valid(p)\n",
    "pyvista validate_mesh": "import pyvista\nf = numpy.hstack([numpy.full((len(triangles), 1), 3), triangles]).flatten()\nmesh = pyvista.PolyData(points, f)\ndef work(): mesh.validate_mesh()\n",
}


def main():
    domain = sys.argv[1]
    ours = sys.argv[2] if len(sys.argv) > 2 else str(HERE / "target/release/trigrade")
    with tempfile.TemporaryDirectory() as folder:
        ascii_mesh, binary = f"{folder}/a.vtu", f"{folder}/b.msh"
        _, said = command(ours, "mesh", domain, "--no-check", "--gradation", "uniform", "-o", ascii_mesh, "-o", binary)
        print(said.strip())
        rows = []
        for name, more in [("trigrade check", []), ("trigrade check, 2 threads", ["--threads", "2"])]:
            flags = more or ["--threads", "1"]
            start = time.time()
            total, said = command(ours, "check", binary, "--domain", domain, "--timings", *flags)
            laps = [line.strip() for line in said.splitlines() if line.strip().startswith("time")]
            rows.append((name, f"{total:.2f} with reading; {laps}; wall {time.time() - start:.2f}"))
        total, _ = command("gmsh", "-check", binary)
        rows.append(("gmsh -check", f"{total:.2f} with reading"))
        for name, code in PEERS.items():
            seconds = library(code, ascii_mesh)
            rows.append((name, "failed" if seconds is None else f"{seconds:.2f}"))
        for name, seconds in rows:
            print(f"{name:34}{seconds}")


if __name__ == "__main__":
    main()
