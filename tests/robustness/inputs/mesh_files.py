"""Mesh files mutated by meaning, by their number, and the judgement that nothing of them is lost in silence."""

import tempfile
from pathlib import Path

import numpy as np

from inputs.command import traced
from inputs.msh import SIZES, Element, Msh, Sign, grid
from inputs.surfaces import judged_surface
from softway.errors import InputError
from softway.meshes.element import element
from softway.meshes.files.mesh_files import FileMesh, read_file

Rng = np.random.Generator
NAMES = ("x" * 3000, "all", "surface", "1", "a.b", "ä", "with blanks", "", "part", "left", "[b]", "a,b", "SURFACE=left")
SECTIONS = {
    "Periodic": "0\n",
    "NodeData": '1\n"T"\n1\n0.0\n3\n0\n1\n1\n1 0.5\n',
    "ElementData": '1\n"T"\n1\n0.0\n3\n0\n1\n1\n1 0.5\n',
    "Parametrizations": "0 0\n",
    "GhostElements": "0\n",
    "Xyzzy": "anything\n$at all\n",
}


def judged_mesh(number: int) -> str:
    """Verdict on a mutated mesh file: ``ok``, ``refused``, or a defect in words."""
    if number % 3 == 2:
        return judged_surface(number)
    made = msh(number)
    with tempfile.TemporaryDirectory() as place:
        file = Path(place, "a.msh")
        file.write_bytes(made.data)
        try:
            read = read_file(file)
        except InputError as error:
            return "refused" if error.remedy and error.where else f"no remedy: {error}"
        except Exception as error:
            return traced(error)
    lost = [what for what, sign in made.signs if not sign(read)]
    lost += _missing(made, read)
    return f"lost: {', '.join(lost)}" if lost else "ok"


def msh(number: int) -> Msh:
    """The mutated Gmsh file of a number."""
    rng = np.random.default_rng([17, number])
    made = grid(rng)
    for _ in range(int(rng.integers(1, 4))):
        MUTATIONS[rng.integers(len(MUTATIONS))](made, rng)
    return made


def _missing(made: Msh, read: FileMesh) -> list[str]:
    """Cells, volume and groups of a file that its mesh does not hold."""
    cells = [e for e in made.elements if e.dim == made.dim]
    found = []
    if read.mesh.n_cells != len(cells):
        found.append(f"{read.mesh.n_cells} cells of {len(cells)}")
    place = dict(made.nodes)
    size = sum(_size(np.array([place.get(n, (np.nan,) * 3) for n in e.nodes]), e.kind) for e in cells)
    if read.mesh.edge() > 0.0 and not np.isclose(_volume(read), size, rtol=1e-9):
        found.append(f"volume {_volume(read):g} of {size:g}")
    named = {(d, n): name for d, n, name in made.names}
    for (dim, entity), groups in made.groups.items():
        nodes = {n for e in made.elements if (e.dim, e.entity) == (dim, entity) for n in e.nodes}
        for group in groups if nodes else ():
            name = named.get((dim, group), str(group))
            if not _holds(read, name, dim, [place[n] for n in nodes]):
                found.append(f"group {dim} {name[:30]!r}")
    return found


def _holds(read: FileMesh, name: str, dim: int, places: list[tuple[float, float, float]]) -> bool:
    """True if a tag has all nodes of a group, or if the list names the group."""
    kind = ("POINT", "CURVE", "SURFACE", "VOLUME")[dim]
    told = [str(entry) for entry in read.left_out]
    if any(name[:50] in text for text in told if name):
        return True
    tags = [read.mesh.tags[t] for t in (name, f"{kind}={name}") if t in read.mesh.tags]
    points = [{tuple(np.round(x, 9)) for x in read.mesh.points[nodes]} for nodes in tags]
    wanted = {tuple(np.round(x, 9)[: read.mesh.dim]) for x in places}
    return any(wanted <= held for held in points)


def _volume(read: FileMesh) -> float:
    """Volume of all cells of a mesh."""
    total = 0.0
    for name, cells in read.mesh.blocks.items():
        rule = element(name)
        jacobian = np.einsum("eai,qar->eqir", read.mesh.points[cells], rule.dN)
        square = jacobian.shape[-1] == jacobian.shape[-2]
        det = np.linalg.det(jacobian) if square else np.sqrt(np.linalg.det(jacobian.swapaxes(-1, -2) @ jacobian))
        total += float((np.abs(det) * rule.weights).sum())
    return total


def _size(x: np.ndarray, kind: int) -> float:
    """Area or volume of an element with straight edges and parallel sides, from its corners."""
    arms = x[1:] - x[0]
    if kind in (2, 3):
        area = np.linalg.norm(np.cross(arms[0], arms[1])) / 2
        return float(area if kind == 2 else area + np.linalg.norm(np.cross(arms[1], arms[2])) / 2)
    if kind == 4:
        return float(abs(np.linalg.det(arms[:3])) / 6)
    if kind == 5:
        return float(sum(abs(np.linalg.det(arms[np.array(t) - 1])) / 6 for t in _HEX))
    return 0.0


_HEX = ((1, 2, 6), (1, 6, 5), (3, 6, 2), (3, 7, 6), (4, 5, 6), (4, 6, 7))


def _listed(text: str) -> Sign:
    return lambda read: any(text in str(entry) for entry in read.left_out)


def _never(read: FileMesh) -> bool:
    return False


def _relabelled(made: Msh, rng: Rng) -> None:
    """Labels of the nodes with gaps, in another order, huge or negative."""
    base, step = [(100, 1), (7, 13), (10**6, 1), (1, 2)][rng.integers(4)]
    if rng.random() < 0.1:
        base = int(rng.choice([2**31 - 40, -500, 0, 10**12]))
        made.binary = made.binary and abs(base) < 2**30
    labels = {
        old: base + step * k for k, old in enumerate(rng.permutation([label for label, _ in made.nodes]).tolist())
    }
    made.nodes = [(labels[label], x) for label, x in made.nodes]
    for e in made.elements:
        e.nodes = [labels.get(n, n) for n in e.nodes]
    if rng.random() < 0.5:
        made.nodes = [made.nodes[k] for k in rng.permutation(len(made.nodes))]


def _wrong_node(made: Msh, rng: Rng) -> None:
    """An element that names a node that is not there: to be refused."""
    one = made.elements[rng.integers(len(made.elements))]
    one.nodes[int(rng.integers(len(one.nodes)))] = int(rng.choice([-1, 123456789]))
    made.signs.append(("an element without its node", _never))


def _same_label(made: Msh, rng: Rng) -> None:
    """A label of a node twice, at another place: to be refused."""
    made.nodes.append((made.nodes[int(rng.integers(len(made.nodes)))][0], (5.0, 5.0, 0.0)))
    made.signs.append(("a node at two places", _never))


def _orphan(made: Msh, rng: Rng) -> None:
    """Nodes of no element."""
    top = max(label for label, _ in made.nodes)
    made.nodes += [(top + k + 1, (9.0, 9.0, 0.0)) for k in range(int(rng.integers(1, 4)))]
    made.signs.append(("nodes of no element", _listed("$Nodes")))


def _again(made: Msh, rng: Rng) -> None:
    """A cell twice, under another label: to be refused."""
    one = made.elements[0]
    made.elements.append(Element(_next(made), one.kind, one.dim, one.entity, list(one.nodes)))
    made.signs.append(("a cell twice", _never))


def _turned(made: Msh, rng: Rng) -> None:
    """A cell with its nodes in the other order: to be refused, or mended."""
    one = made.elements[0]
    one.nodes = one.nodes[::-1] if rng.random() < 0.5 else [one.nodes[1], one.nodes[0], *one.nodes[2:]]


def _collapsed(made: Msh, rng: Rng) -> None:
    """A cell with one node twice: to be refused, by ``check`` for its edge without length."""
    one = made.elements[0]
    one.nodes = [one.nodes[1], *one.nodes[1:]]
    made.signs.append(("a collapsed cell", lambda read: not read.mesh.edge() > 0.0))


def _second_part(made: Msh, rng: Rng) -> None:
    """All cells once more at another place, in an entity and group of their own."""
    top = max(label for label, _ in made.nodes)
    low = min(label for label, _ in made.nodes)
    shift = top - low + 1
    made.nodes += [(label + shift, (x[0] + 20.0, x[1], x[2])) for label, x in made.nodes]
    entity = max(e.entity for e in made.elements) + 1
    for e in [e for e in made.elements if e.dim == made.dim]:
        made.elements.append(Element(_next(made), e.kind, e.dim, entity, [n + shift for n in e.nodes]))
    made.groups[made.dim, entity] = [int(rng.choice([1, 9, 2]))]


def _named(made: Msh, rng: Rng) -> None:
    """Another name of a group: huge, odd, of another group, or on nothing."""
    name = str(rng.choice(NAMES))
    if rng.random() < 0.3:
        made.names.append((int(rng.integers(0, 4)), 77, name))
        made.signs.append((f"a name on nothing {name[:9]!r}", _listed("$PhysicalNames")))
    elif made.names:
        k = int(rng.integers(len(made.names)))
        made.names[k] = (made.names[k][0], made.names[k][1], name)


def _second_name(made: Msh, rng: Rng) -> None:
    """Two names of one group: to be refused."""
    if made.names:
        made.names.append((made.names[0][0], made.names[0][1], "second"))
        made.signs.append(("two names", lambda read: "second" in read.mesh.tags and made.names[0][2] in read.mesh.tags))


def _several_groups(made: Msh, rng: Rng) -> None:
    """An entity in more than one group, or in none."""
    entity = list(made.groups)[int(rng.integers(len(made.groups)))]
    made.groups[entity] = [[], [*made.groups[entity], 41], [42, *made.groups[entity], 43]][int(rng.integers(3))]


def _mixed(made: Msh, rng: Rng) -> None:
    """Elements of another type: points, lines, a wedge."""
    nodes = [label for label, _ in made.nodes]
    kind = int(rng.choice([15, 1, 6, 26, 140]))
    dim, size = {15: 0, 1: 1, 6: 3, 26: 1, 140: 3}[kind], {**SIZES, 26: 4, 140: 3}[kind]
    chosen = [nodes[k % len(nodes)] for k in range(size)]
    if kind in (6, 140):
        made.signs.append(("cells without counterpart", _never))
    entity = 50 + kind
    made.elements.append(Element(_next(made), kind, dim, entity, chosen))
    if rng.random() < 0.5:
        made.groups[dim, entity] = [60]
    else:
        made.signs.append(("elements in no group", _listed("$Elements")))


def _section(made: Msh, rng: Rng) -> None:
    """A section that is not honoured."""
    name = str(rng.choice(list(SECTIONS)))
    made.sections.append(f"${name}\n{SECTIONS[name]}$End{name}\n")
    made.signs.append((name, _listed(f"${name}")))


def _twice(made: Msh, rng: Rng) -> None:
    """A section once more: to be refused."""
    name = str(rng.choice(["Nodes", "Elements", "PhysicalNames"]))
    made.sections.append(f"${name}\n0\n$End{name}\n" if made.version == "2.2" else f"${name}\n0 0 0 0\n$End{name}\n")
    made.signs.append((f"${name} twice", lambda read: name == "PhysicalNames" and not made.names))


def _counted(made: Msh, rng: Rng) -> None:
    """Another number of nodes or elements than announced: to be refused."""
    change = int(rng.choice([-1, 1, -2, 10**9]))
    made.counts = (change, 0) if rng.random() < 0.5 else (0, change)
    made.signs.append(("wrong count", _never))


def _next(made: Msh) -> int:
    return max(e.label for e in made.elements) + 1


MUTATIONS = (
    _relabelled, _relabelled, _relabelled, _wrong_node, _same_label, _orphan, _again, _turned, _collapsed,
    _second_part, _second_part, _named, _named, _second_name, _several_groups, _several_groups, _mixed, _mixed,
    _section, _twice, _counted,
)  # fmt: skip
