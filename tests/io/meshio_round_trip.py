# SPDX-License-Identifier: Apache-2.0
"""Reads with meshio what write_samples wrote, and compares every array bit by bit."""
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import meshio
import numpy as np


def same(what, got, expected):
    got = np.asarray(got)
    if got.shape != expected.shape or not np.array_equal(got.astype(expected.dtype), expected):
        sys.exit(f"{what}: read\n{got}\nwritten\n{expected}")
    if got.dtype.kind == "f" and got.dtype.itemsize < expected.dtype.itemsize:
        sys.exit(f"{what}: lost precision: {got.dtype}")


def tets_of(mesh):
    return np.concatenate([block.data for block in mesh.cells if block.type == "tetra"])


def cell_data(mesh, name):
    return np.concatenate(mesh.cell_data[name])


def vtp_arrays(path):
    """All arrays of a .vtp with appended raw data (meshio does not read .vtp)."""
    content = open(path, "rb").read()
    start = content.index(b'<AppendedData encoding="raw">')
    data = content[content.index(b"_", start) + 1:]
    root = ElementTree.fromstring(content[:start] + b"</VTKFile>")
    types = {"Float32": "<f4", "Int32": "<i4", "Int64": "<i8"}
    arrays = {}
    for array in root.iter("DataArray"):
        offset = int(array.get("offset"))
        size = int(np.frombuffer(data, "<u8", 1, offset)[0])
        values = np.frombuffer(data[offset + 8:offset + 8 + size], types[array.get("type")])
        width = int(array.get("NumberOfComponents", "1"))
        arrays[array.get("Name")] = values.reshape(-1, width) if width > 1 else values
    return arrays, root.find(".//Piece")


def obj_corners(path):
    """Positions, normals and the numbers of both at each corner (meshio takes as many normals as points only)."""
    rows = {"v": [], "vn": [], "f": []}
    for line in open(path):
        word, *rest = line.split()
        rows[word].append(rest)
    corners = np.array([[corner.split("//") for corner in face] for face in rows["f"]], dtype="i4") - 1
    return np.array(rows["v"], "f4"), np.array(rows["vn"], "f4"), corners[:, :, 0], corners[:, :, 1]


def check_surfaces(folder, array, read):
    position, normal = array("surface.position", "f4", 3), array("surface.normal", "f4", 3)
    triangles, point = array("surface.triangle", "i4", 3), array("surface.point", "i4")
    vertex = np.sort(np.unique(point, return_index=True)[1])  # the first of each point, in their order
    number = {at: i for i, at in enumerate(point[vertex])}
    welded = np.array([number[at] for at in point], "i4")[triangles]

    points, normals, corner_points, corner_normals = obj_corners(os.path.join(folder, "surface.obj"))
    same("obj positions", points, position[vertex])
    same("obj normals", normals, normal)
    same("obj triangles", corner_points, welded)
    same("obj normals of corners", corner_normals, triangles)
    same("ply positions", read("surface.ply").points, position[vertex])
    same("ply triangles", read("surface.ply").cells[0].data, welded)
    same("rest obj", read("surface_rest.obj").points, array("surface.rest", "f4", 3)[vertex])
    same("rest obj triangles", read("surface_rest.obj").cells[0].data, welded)
    stl = read("surface.stl")
    same("stl corners", stl.points[stl.cells[0].data], position[triangles])
    for ending in ("obj", "ply"):
        split = read(f"split.{ending}")
        same(f"split {ending} positions", split.points, position)
        same(f"split {ending} triangles", split.cells[0].data, triangles)
    same("split obj normals", read("split.obj").point_data["obj:vn"], normal)
    same("split ply normals", read("split.ply").point_data["nx"], normal[:, 0])

    arrays, piece = vtp_arrays(os.path.join(folder, "surface.vtp"))
    same("vtp counts", [int(piece.get("NumberOfPoints")), int(piece.get("NumberOfPolys"))], np.array([4, 4]))
    same("vtp points", arrays["Points"], position[vertex])
    same("vtp rest", arrays["rest"], array("surface.rest", "f4", 3)[vertex])
    same("vtp triangles", arrays["connectivity"].reshape(-1, 3), welded)
    same("vtp offsets", arrays["offsets"], np.array([3, 6, 9, 12]))
    same("vtp normals", arrays["corner_normals"].reshape(-1, 3, 3), normal[triangles])
    for name in ("face", "piece"):
        same(f"vtp {name}", arrays[name], array(f"surface.{name}", "i4"))


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, folder], check=True)
        check(folder)


def check(folder):
    def array(name, kind, width=1):
        values = np.fromfile(os.path.join(folder, name), kind)
        return values.reshape(-1, width) if width > 1 else values

    def read(name):
        return meshio.read(os.path.join(folder, name))

    for ending in ("vtu", "vtk", "msh"):
        body = read(f"body.{ending}")
        same(f"body.{ending} nodes", body.points, array("body.nodes", "f8", 3))
        same(f"body.{ending} tets", tets_of(body), array("body.tets", "i4", 4))
    body = read("body.vtu")
    same("region", cell_data(body, "region"), array("body.region", "i4"))
    same("left", np.flatnonzero(body.point_data["left"]), np.array([0, 3, 6, 9]))
    same("low", np.flatnonzero(body.point_data["low & <near>"]), np.array([0, 1, 2]))
    body = read("body.msh")
    groups = {name: tag for name, (tag, _) in body.field_data.items()}
    points = np.concatenate([block.data for block in body.cells if block.type == "vertex"]).ravel()
    tags = np.concatenate([data for block, data in zip(body.cells, body.cell_data["gmsh:physical"])
                           if block.type == "vertex"])
    same("left in msh", points[tags == groups["left"]], np.array([0, 3, 6, 9]))
    same("low in msh", points[tags == groups["low & <near>"]], np.array([0, 1, 2]))

    check_surfaces(folder, array, read)

    copies = read("copies.vtu")
    same("copies rest", copies.points, array("copies.rest", "f4", 3))
    same("copies node", tets_of(copies), array("copies.node", "i4", 4))
    for name in ("displacement", "velocity"):
        same(name, copies.point_data[name], array(f"copies.{name}", "f4", 3))
    for name, kind in (("mass", "f4"), ("fixed", "u1"), ("reference_node", "i4")):
        same(name, copies.point_data[name], array(f"copies.{name}", kind))
    for name, kind in (("fraction", "f8"), ("element", "i4"), ("piece", "i4"), ("von_mises", "f8")):
        same(name, cell_data(copies, name), array(f"copies.{name}", kind))

    series = ElementTree.parse(os.path.join(folder, "series.pvd")).getroot()
    entries = [(float(entry.get("timestep")), entry.get("file")) for entry in series.iter("DataSet")]
    if entries != [(0.0, "copies.vtu"), (1 / 60, "a&b.vtu")]:
        sys.exit(f"series: {entries}")


if __name__ == "__main__":
    main(sys.argv[1])
