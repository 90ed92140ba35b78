#!/usr/bin/env python3
"""Who notices what: other programs' mesh checks on the broken meshes of tests/vectors.

    pip install gmsh triangle meshio trimesh pyvista pymeshlab libigl shapely
    python benches/peers/check_vectors.py [TOOL ...]

Every case runs in a process of its own, so that a crash or a hang costs one case. A program
*notices* a defect when its own check says that something is wrong, whatever it calls it; it
*rejects* a valid mesh when it says so of one that has no defect. No program here but trigrade takes
a domain, so what only a domain can tell is out of their reach; it is listed all the same, because
that is what users rely on. What trigrade finds is asserted id by id by `cargo test --test vectors`.
"""
import collections
import json
import multiprocessing
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SECONDS = 20


def load():
    """All cases: (class, case), the class being the expected id or 'valid'."""
    for path in sorted((ROOT / "tests/vectors").glob("*.json")):
        for case in json.loads(path.read_text())["cases"]:
            expected = case["expected"]
            yield (expected[0] if expected else "valid"), case


def arrays(case):
    """Points (n, 3) and triangles (m, 3); raises what numpy raises on references it cannot hold."""
    import numpy

    points = [[float(c) for c in p] + [0.0] * (3 - len(p)) for p in case["mesh"]["points"]]
    return numpy.array(points, dtype=float).reshape(-1, 3), numpy.array(
        case["mesh"]["triangles"], dtype=numpy.int64
    ).reshape(-1, 3)


def write_msh(case, folder):
    """MSH 2.2 ASCII, references as they are (plus one)."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(case["mesh"]["points"]))]
    for i, p in enumerate(case["mesh"]["points"]):
        lines.append(" ".join([str(i + 1)] + [repr(float(c)) for c in p] + ["0"] * (3 - len(p))))
    triangles = case["mesh"]["triangles"]
    lines += ["$EndNodes", "$Elements", str(len(triangles))]
    for i, t in enumerate(triangles):
        lines.append(f"{i + 1} 2 2 1 1 " + " ".join(str(v + 1) for v in t))
    path = folder / "case.msh"
    path.write_text("\n".join(lines + ["$EndElements", ""]))
    return path


def gmsh(case, folder):
    """`gmsh -check`: a warning or an error, or an exit code."""
    run = subprocess.run(
        ["gmsh", "-check", str(write_msh(case, folder))],
        capture_output=True, text=True, timeout=SECONDS,
    )
    if run.returncode < 0:
        raise RuntimeError(f"signal {-run.returncode}")
    text = run.stdout + run.stderr
    said = [l for l in text.splitlines() if l.startswith(("Warning", "Error"))]
    return run.returncode != 0 or bool(said)


def triangle(case, folder):
    """`triangle -rC`: its internal consistency check, and whether it aborts."""
    code = (
        "import sys, json, numpy, triangle\n"
        "points, triangles = json.load(open(sys.argv[1]))\n"
        "triangle.triangulate(dict(vertices=numpy.array(points)[:, :2], triangles=numpy.array(triangles)), 'rC')\n"
    )
    points, triangles = arrays(case)
    path = folder / "case.json"
    path.write_text(json.dumps([points.tolist(), triangles.tolist()]))
    run = subprocess.run(
        [sys.executable, "-c", code, str(path)], capture_output=True, text=True, timeout=SECONDS
    )
    if run.returncode < 0:
        raise RuntimeError(f"signal {-run.returncode}")
    return run.returncode != 0 or "!!" in run.stdout or "Error" in run.stdout + run.stderr


def meshio(case, folder):
    """Reading alone is the check."""
    import meshio

    mesh = meshio.read(write_msh(case, folder))
    cells = [c for c in mesh.cells if c.type == "triangle"]
    return not all((c.data >= 0).all() and (c.data < len(mesh.points)).all() for c in cells)


def trimesh(case, folder):
    """All of its predicates that apply to an open surface."""
    import trimesh

    points, triangles = arrays(case)
    mesh = trimesh.Trimesh(points, triangles, process=False, validate=False)
    unused = len(set(triangles.flatten().tolist())) < len(points)
    merged = trimesh.Trimesh(points, triangles, process=True)
    return (
        not mesh.is_winding_consistent
        or not mesh.nondegenerate_faces().all()
        or not mesh.unique_faces().all()
        or unused
        or len(merged.vertices) < len(points)
        or (case.get("options", {}).get("closed", False) and not mesh.is_watertight)
    )


def pyvista(case, folder):
    """`validate_mesh`, all fields."""
    import numpy
    import pyvista

    points, triangles = arrays(case)
    faces = numpy.hstack([numpy.full((len(triangles), 1), 3), triangles]).flatten()
    mesh = pyvista.PolyData(points, faces)
    return not mesh.validate_mesh().is_valid


def pymeshlab(case, folder):
    """Topological measures, duplicates, self-intersections."""
    import pymeshlab

    points, triangles = arrays(case)
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(points, triangles.astype("int32")))
    facts = meshes.get_topological_measures()
    wrong = any(
        facts[k] > 0
        for k in ["non_two_manifold_edges", "non_two_manifold_vertices", "unreferenced_vertices"]
    )
    meshes.compute_selection_by_self_intersections_per_face()
    wrong |= meshes.current_mesh().selected_face_number() > 0
    before = (meshes.current_mesh().vertex_number(), meshes.current_mesh().face_number())
    meshes.meshing_remove_duplicate_vertices()
    meshes.meshing_remove_duplicate_faces()
    meshes.meshing_remove_null_faces()
    return wrong or before != (
        meshes.current_mesh().vertex_number(), meshes.current_mesh().face_number()
    )


def libigl(case, folder):
    """Manifold edges and vertices, duplicates, area."""
    import igl

    points, triangles = arrays(case)
    edges = igl.is_edge_manifold(triangles)
    edges = edges[0] if isinstance(edges, tuple) else edges
    vertices = igl.is_vertex_manifold(triangles)
    vertices = vertices[0] if isinstance(vertices, tuple) else vertices
    flat = (igl.doublearea(points, triangles) <= 0).any()
    vertices_ok = vertices.all() if hasattr(vertices, "all") else vertices
    return not edges or not vertices_ok or bool(flat)


def geos(case, folder):
    """Valid polygons that form a valid coverage (shapely)."""
    import numpy
    import shapely

    points, triangles = arrays(case)
    if (points[:, 2] != points[0, 2]).any():
        raise NotImplementedError("a plane coverage only")
    rings = points[:, :2][numpy.hstack([triangles, triangles[:, :1]])]
    polygons = shapely.polygons(rings)
    return not shapely.is_valid(polygons).all() or not shapely.coverage_is_valid(polygons)


TOOLS = dict(
    gmsh=gmsh, triangle=triangle, meshio=meshio, trimesh=trimesh, pyvista=pyvista,
    pymeshlab=pymeshlab, libigl=libigl, geos=geos,
)


def child(tool, case, pipe):
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    with tempfile.TemporaryDirectory() as folder:
        try:
            answer = "noticed" if TOOLS[tool](case, pathlib.Path(folder)) else "silent"
        except subprocess.TimeoutExpired:
            answer = "hang"
        except NotImplementedError:
            answer = "n/a"
        except RuntimeError as error:
            answer = "crash" if "signal" in str(error) else "noticed"
        except Exception:  # a refusal, whatever its kind, is a notice
            answer = "noticed"
    pipe.send(answer)


def judge(tool, case):
    """noticed, silent, crash, hang or n/a."""
    here, there = multiprocessing.Pipe()
    process = multiprocessing.Process(target=child, args=(tool, case, there))
    process.start()
    there.close()
    try:
        answer = here.recv() if here.poll(SECONDS + 5) else "hang"
    except EOFError:
        answer = "crash"
    process.kill()
    process.join()
    return answer


def main():
    multiprocessing.set_start_method("fork")
    tools = sys.argv[1:] or list(TOOLS)
    for tool in tools:  # imported once here, so that the children need not
        try:
            __import__({"geos": "shapely", "libigl": "igl"}.get(tool, tool))
        except ImportError:
            print(f"{tool} is not installed", file=sys.stderr)
    counts = collections.defaultdict(collections.Counter)
    totals = collections.Counter()
    for kind, case in load():
        totals[kind] += 1
        for tool in tools:
            counts[kind, tool][judge(tool, case)] += 1
    print("| id | cases | " + " | ".join(tools) + " |")
    print("|---|---|" + "---|" * len(tools))
    kinds = sorted(totals, key=lambda k: (k == "valid", int(k[1:]) if k[1:].isdigit() else 0))
    for kind in kinds:
        row = []
        for tool in tools:
            count = counts[kind, tool]
            extra = "".join(f" {count[w]} {w}" for w in ("crash", "hang", "n/a") if count[w])
            row.append(f"{count['noticed']}{extra}")
        print(f"| {kind} | {totals[kind]} | " + " | ".join(row) + " |")
    print("\nThe row `valid` counts valid meshes that were rejected.")


if __name__ == "__main__":
    main()
