# SPDX-License-Identifier: Apache-2.0
"""Made the mesh files beside it: one block of 2 x 1 x 1 Kuhn cells in every format, by meshio and, where meshio
does not write a variant, from the format's text. Run it again only to add files: python3 make_meshes.py"""
import base64
import itertools
import os
import struct

import meshio
import numpy as np

here = os.path.dirname(os.path.abspath(__file__))
points = np.array([[0.1 * x, 0.1 * y, 0.1 * z] for z in range(2) for y in range(2) for x in range(3)])


def node(x, y, z):
    return x + 3 * (y + 2 * z)


tets = []
for cell in range(2):
    for order in itertools.permutations(range(3)):
        corner = [cell, 0, 0]
        tet = [node(*corner)]
        for axis in order:
            corner[axis] += 1
            tet.append(node(*corner))
        a, b, c, d = points[tet]
        if np.dot(np.cross(b - a, c - a), d - a) < 0:
            tet[2], tet[3] = tet[3], tet[2]
        tets.append(tet)
tets = np.array(tets)
left = np.array([[0, 3, 6], [3, 9, 6]])
velocity = np.arange(36, dtype=float).reshape(12, 3) / 7

cells = [("triangle", left), ("tetra", tets)]
tags = [np.array([7, 7]), np.array([1] * 12)]
mesh = meshio.Mesh(points, cells, cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
                   field_data={"left side": np.array([7, 2]), "tissue": np.array([1, 3])})
mesh.write(f"{here}/block_22.msh", file_format="gmsh22", binary=False)
meshio.Mesh(points, [("tetra", tets)]).write(f"{here}/block_41.msh", file_format="gmsh", binary=False)
plain = meshio.Mesh(points, cells, point_data={"velocity": velocity, "left": (points[:, 0] == 0).astype("u1")})
plain.write(f"{here}/block_42_ascii.vtk", file_format="vtk42", binary=False)
plain.write(f"{here}/block_42_binary.vtk", file_format="vtk42", binary=True)
meshio.vtk.write(f"{here}/block_51_ascii.vtk", plain, "5.1", binary=False)
meshio.vtk.write(f"{here}/block_51_binary.vtk", plain, "5.1", binary=True)
plain.write(f"{here}/block_ascii.vtu", binary=False)
plain.write(f"{here}/block_binary.vtu", binary=True, compression=None)
plain.write(f"{here}/block_zlib.vtu", binary=True, compression="zlib")


def write_appended(name, encoding, order, header):
    """From the text of the VTK XML format: other number types and byte orders than meshio writes."""
    swap = {"LittleEndian": "<", "BigEndian": ">"}[order]
    length = {"UInt32": "I", "UInt64": "Q"}[header]
    arrays, data = [], b""

    def add(array_name, vtk_type, kind, values, components=1):
        nonlocal data
        block = np.asarray(values).astype(swap + kind).tobytes()
        block = struct.pack(swap + length, len(block)) + block
        arrays.append(f'<DataArray type="{vtk_type}" Name="{array_name}" NumberOfComponents="{components}" '
                      f'format="appended" offset="{len(data)}"/>')
        data += block if encoding == "raw" else base64.b64encode(block)
        return arrays[-1]

    text = f'<VTKFile type="UnstructuredGrid" version="1.0" byte_order="{order}" header_type="{header}">\n' \
           f'<UnstructuredGrid><Piece NumberOfPoints="12" NumberOfCells="12"><Points>\n'
    text += add("Points", "Float32", "f4", points, 3)
    text += "</Points><Cells>\n" + add("connectivity", "Int16", "i2", tets)
    text += add("offsets", "UInt32", "u4", 4 * np.arange(1, 13)) + add("types", "Int8", "i1", [10] * 12)
    text += f'</Cells></Piece></UnstructuredGrid>\n<AppendedData encoding="{encoding}">\n_'
    with open(f"{here}/{name}", "wb") as file:
        file.write(text.encode() + data + b"\n</AppendedData>\n</VTKFile>\n")


write_appended("block_raw_big.vtu", "raw", "BigEndian", "UInt64")
write_appended("block_base64.vtu", "base64", "LittleEndian", "UInt32")
