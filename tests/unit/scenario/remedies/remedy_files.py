"""Files of the scenarios whose remedies are tried."""

from pathlib import Path

import numpy as np
from try_it import PLANE

NODES = """*NODE
1, 0, 0
2, 1, 0
3, 2, 0
4, 0, 1
5, 1, 1
6, 2, 1
7, 0, 2
8, 1, 2
9, 2, 2
"""
CELLS = """*ELEMENT, TYPE=CPE4, ELSET=ALL
1, 1, 2, 5, 4
2, 2, 3, 6, 5
3, 4, 5, 8, 7
4, 5, 6, 9, 8
"""
SETS = """*NSET, NSET=CORNER
1
*NSET, NSET=BOTTOM
1, 2, 3
"""
DECKS = {
    "tagged": NODES + CELLS + SETS,
    "sheet": "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 1\n4, 0, 1, 1\n*ELEMENT, TYPE=S4\n1, 1, 2, 3, 4\n",
    "hanging": NODES + "*ELEMENT, TYPE=CPE4\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n*NODE\n10, 0, 3\n11, 2, 3\n12, 1, 1.5\n"
    "*ELEMENT, TYPE=CPE3\n3, 4, 6, 12\n",
    "overlapping": NODES + CELLS + "*NODE\n10, 0.5, 0.5\n11, 1.5, 0.5\n12, 1.5, 1.5\n13, 0.5, 1.5\n"
    "*ELEMENT, TYPE=CPE4\n5, 10, 11, 12, 13\n",
    "undefined": NODES + CELLS + "*ELEMENT, TYPE=CPE4\n9, 1, 2, 77, 4\n",
    "collapsed": NODES + "*NODE\n10, 1, 0\n*ELEMENT, TYPE=CPE4\n1, 1, 2, 10, 4\n",
    "wedge": "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, 1, 0, 1\n6, 0, 1, 1\n"
    "*ELEMENT, TYPE=C3D6\n1, 1, 2, 3, 4, 5, 6\n",
    "lost": NODES + CELLS + "*INCLUDE, INPUT=none.inc\n",
    "itself": NODES + CELLS + "*INCLUDE, INPUT=itself.inp\n",
    "no_input": NODES + CELLS + "*INCLUDE\n",
    "no_keyword": NODES + CELLS + "*, NSET=A\n",
    "no_instance": "*PART, NAME=P\n" + NODES + CELLS + "*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n"
    "*END INSTANCE\n*NSET, NSET=N, INSTANCE=J\n1\n*END ASSEMBLY\n",
    "marked": NODES + CELLS + "*ELEMENT, TYPE=T2D2, ELSET=EDGE\n9, 1, 2\n",
}
SQUARE = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
2 7 "steel"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
1
1 {cell}
$EndElements
"""
PENTAGON = """ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
2 0 0
2 2 0
1 3 0
0 2 0
5 0 1 2 3 4
"""
LAWS = """from dataclasses import dataclass
from softway.laws.bulk.linear_elastic import LinearElastic

@dataclass(frozen=True, kw_only=True)
class Law(LinearElastic):
    pass

@dataclass(frozen=True, kw_only=True)
class Fails(LinearElastic):
    def __post_init__(self):
        raise OSError("no table")

@dataclass(frozen=True, kw_only=True)
class Empty:
    pass

def distance(x):
    return x[:, 1]
"""


def write(folder: Path) -> None:
    """Write all files."""
    for name, text in DECKS.items():
        (folder / f"{name}.inp").write_text(text)
    for name, facets in surfaces().items():
        corners = ["\n".join("vertex {} {} {}".format(*p) for p in t) for t in facets.tolist()]
        loops = [f"facet normal 0 0 0\nouter loop\n{c}\nendloop\nendfacet" for c in corners]
        (folder / f"{name}.stl").write_text("\n".join(["solid s", *loops, "endsolid s", ""]))
    texts = {
        "empty.stl": "",
        "points.obj": "v 0 0 0\n",
        "pentagon.obj": "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3 1 2\n",
        "bad.obj": "hello",
        "flat.obj": "v 0 0\nv 1 0\nv 1 1\nf 1 2 3\n",
        "pentagon.ply": PENTAGON,
        "pieces.vtu": "<VTKFile><Piece /><Piece /></VTKFile>",
        "bad.stl": "hello",
        "bad.ply": "hello",
        "tool.step": "hello",
        "bad.msh": "hello",
        "points.msh": SQUARE.format(cell="15 2 0 1 1"),
        "lines.msh": SQUARE.replace("4 0 1 0", "4 0 1 1").format(cell="1 2 0 1 1 4"),
        "square.msh": SQUARE.format(cell="3 2 7 1 1 2 3 4"),
        "pyramid.msh": SQUARE.replace("4 0 1 0", "4 0 1 0\n5 0 0 1")
        .replace("\n4\n1 0", "\n5\n1 0")
        .format(cell="7 2 0 1 1 2 3 4 5"),
        "own_law.py": LAWS,
        "broken_law.py": "raise OSError('no table')",
        "needy_law.py": "import no_such_module",
        "json.py": LAWS,
        "plane.toml": PLANE,
        "syntax.toml": PLANE.replace('"Solid"', "Solid"),
    }
    for name, text in texts.items():
        (folder / name).write_text(text)
    (folder / "bytes.toml").write_bytes(b"\xff\xfe\xff")


def surfaces() -> dict[str, np.ndarray]:
    """Facets (f, 3, 3) by name of a file."""
    corners = np.array([[x, y, z] for z in (-1.0, 0.0) for y in (-1.0, 2.0) for x in (-1.0, 2.0)])
    quads = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
    box = corners[np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])]
    mixed = box.copy()
    mixed[3] = mixed[3, ::-1]
    line = np.array([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]])
    fin = np.array([[corners[4], corners[5], corners[5] + [0.0, 0.0, 1.0]]])
    top = box[[1, 7]]
    flat = np.array(
        [
            [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]],
            [[0.0, 0, 0], [0, 1, 0], [1, 1, 0]],
            [[1.0, 0, 0], [0, 0, 0], [1, 1, 0]],
            [[0.0, 1, 0], [1, 0, 0], [1, 1, 0]],
        ]
    )
    return {
        "box": box,
        "inside_out": box[:, ::-1],
        "mixed": mixed,
        "thin": np.concatenate([box, line]),
        "wall": np.concatenate([top, top[:, ::-1]]),
        "hollow": flat,
        "fin": np.concatenate([box, fin]),
    }
