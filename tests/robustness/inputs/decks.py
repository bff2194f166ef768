"""Input decks mutated by meaning, by their number, and the judgement that nothing of them is lost in silence."""

import tempfile
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from softway.errors import InputError
from softway.meshes.files.mesh_files import FileMesh, read_file

Rng = np.random.Generator
Sign = Callable[[FileMesh], bool]
"""Test that a mesh or its list holds what a mutation added."""
IGNORED = (
    "MATERIAL, NAME=Steel", "ELASTIC", "DENSITY", "BOUNDARY", "CLOAD", "DLOAD", "STEP", "STATIC", "TIE, NAME=T",
    "CONTACT PAIR, INTERACTION=I", "SURFACE INTERACTION, NAME=I", "EQUATION", "MPC", "RIGID BODY", "COUPLING",
    "AMPLITUDE, NAME=A", "INITIAL CONDITIONS, TYPE=TEMPERATURE", "ORIENTATION, NAME=O", "TRANSFORM", "XYZZY", "HEADING",
    "NODE PRINT, NSET=N", "EL FILE", "RESTART", "PREPRINT", "ELEMENT OUTPUT", "NODE  RESPONSE", "N SET", "NODES",
)  # fmt: skip
FOREIGN = (
    "SPRINGA",
    "MASS",
    "DASHPOT1",
    "D",
    "B31",
    "S4R",
    "M3D4",
    "R3D4",
    "GAPUNI",
    "U1",
    "CONN3D2",
    "F3D8",
    "Q" * 300,
)
NAMES = ("x" * 1000, "ALL", "Surface", "1", "a.b", "ä", "NSET=A", '"with blanks"', "-1", "left")
ODD = ("nan", "1e999", "-3", "0", "9" * 5000, "", "x", "1.5", "1.D0", "4294967296", "*", ",,")


@dataclass(slots=True)
class Deck:
    """Files of a deck by name, ``deck.inp`` is the deck itself, and the signs of what was added to it.

    Parameters
    ----------
    nodes, elements, rest
        Cards with nodes, cards with elements, and the cards after them.
    files
        Texts of further files by name.
    signs
        Description of an addition, and the test that it is in the mesh or in the list.
    wrap
        Cards of two parts around the others, which ``@`` stands for; empty without parts.
    cells
        Number of cells that the mesh is to have.
    first
        Label of the first node.
    """

    nodes: list[str]
    elements: list[str]
    rest: list[str] = field(default_factory=list)
    files: dict[str, str] = field(default_factory=dict)
    signs: list[tuple[str, Sign]] = field(default_factory=list)
    wrap: str = ""
    cells: int = 0
    first: int = 1

    @property
    def text(self) -> str:
        """Text of ``deck.inp``."""
        inner = "".join([*self.nodes, *self.elements, *self.rest])
        return self.wrap.replace("@", inner) if self.wrap else inner


def listed(start: str) -> Sign:
    """Sign: an entry of the list starts with a text, in any case."""
    return lambda mesh: any(card.card.upper().startswith(start.upper()) for card in mesh.left_out)


def tagged(name: str) -> Sign:
    """Sign: a tag has the name, alone, after the name of an instance, or after the kind of the set."""
    plain = name.strip('"').upper()
    return lambda mesh: (
        any(tag.upper() == plain or tag.upper().endswith((f".{plain}", f"={plain}")) for tag in mesh.mesh.tags)
        or any(plain[:40] in str(card).upper() for card in mesh.left_out)
    )


def deck(number: int) -> Deck:
    """The mutated deck of a number.

    Examples
    --------
    >>> deck(7).text == deck(7).text
    True
    """
    rng = np.random.default_rng([11, number])
    made = _grid(rng)
    for _ in range(rng.integers(1, 5)):
        MUTATIONS[rng.integers(len(MUTATIONS))](made, rng)
    if rng.random() < 0.2:
        made.nodes, made.elements, made.rest = (
            [card.swapcase() if "INPUT" not in card else card for card in cards]
            for cards in (made.nodes, made.elements, made.rest)
        )
    return made


def judged_deck(number: int) -> str:
    """Verdict on a deck: ``ok``, ``refused``, or a defect in words: a traceback, a refusal without remedy, a loss."""
    given = deck(number)
    with tempfile.TemporaryDirectory() as place:
        for name, text in {**given.files, "deck.inp": given.text}.items():
            Path(place, name).write_text(text, encoding="utf-8")
        try:
            read = read_file(Path(place, "deck.inp"))
        except InputError as error:
            return "refused" if error.remedy and error.where else f"no remedy: {error}"
        except Exception as error:
            where = traceback.extract_tb(error.__traceback__)[-1]
            return f"traceback: {type(error).__name__}: {str(error)[:80]} at {Path(where.filename).name}:{where.lineno}"
    lost = [what for what, sign in given.signs if not sign(read)]
    if read.mesh.n_cells != given.cells:
        lost.append(f"{read.mesh.n_cells} cells of {given.cells}")
    return f"lost: {', '.join(lost)}" if lost else "ok"


def _grid(rng: Rng) -> Deck:
    """A row of bricks, or of plane cells, with its nodes and elements numbered from anywhere."""
    count, start, flat = int(rng.integers(1, 4)), int(rng.integers(1, 10**6)), rng.random() < 0.3
    layers = ((0.0, 0.0), (0.0, 1.0)) if flat else ((0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0))
    width = len(layers)
    rows = [f"{start + i * width + k}, {i}, {y}, {z}\n" for i in range(count + 1) for k, (z, y) in enumerate(layers)]
    local = [0, width, width + 1, 1] if flat else [0, 4, 5, 1, 2, 6, 7, 3]
    cells = [", ".join(map(str, [i + 1, *(start + i * width + k for k in local)])) + "\n" for i in range(count)]
    kind = rng.choice(["CPE4", "CPS4R"] if flat else ["C3D8", "C3D8R", "C3D8I"])
    nodes = ["*NODE, NSET=N\n" + "".join(rows)]
    return Deck(nodes, [f"*ELEMENT, TYPE={kind}, ELSET=E\n" + "".join(cells)], cells=count, first=start)


def _ignored(made: Deck, rng: Rng) -> None:
    """Cards that are not honoured."""
    head = str(rng.choice(IGNORED))
    made.rest.append(f"*{head}\n1, 1, 1\n" * int(rng.integers(1, 3)))
    title = "*" + " ".join(head.partition(",")[0].split())
    if "".join(title.split()) != "*NSET":
        made.signs.append((title, listed(title)))


def _foreign(made: Deck, rng: Rng) -> None:
    """Elements that are no cells of a body."""
    kind, first = str(rng.choice(FOREIGN)), made.first
    made.elements.append(
        f"*ELEMENT, TYPE={kind}, ELSET=Other\n"
        f"{7000 + len(made.elements)}, {first}, {first + 1}, {first + 2}, {first + 3}\n"
    )
    made.signs.append((kind[:9], listed(f"*ELEMENT, TYPE={kind[:40]}")))


def _set(made: Deck, rng: Rng) -> None:
    """Sets with any name, with labels that exist or do not, and with sets in them."""
    kind, name = ("NSET", "ELSET")[rng.integers(2)], str(rng.choice(NAMES))
    first = made.first if kind == "NSET" else 1
    rows = [f"{first}", f"{first + 10**7}", f"{first}, {first}", "N, E", name, f"{first},", "None"][rng.integers(7)]
    generate = rng.random() < 0.3
    rows = rng.choice([f"{first}, {first + 10**9}", f"{first}, {first}, 1"]) if generate else rows
    made.rest.append(f"*{kind}, {kind}={name}{', GENERATE' if generate else ''}\n{rows}\n")
    made.signs.append((f"{kind} {name[:9]}", tagged(name)))


def _surface(made: Deck, rng: Rng) -> None:
    """Surfaces of faces and of nodes."""
    kind, name = rng.choice(["ELEMENT", "NODE", "CUTTING SURFACE"], p=[0.7, 0.2, 0.1]), f"F{len(made.rest)}"
    row = f"E, {rng.choice(['S1', 'S4', 'S9', 'SPOS', ''])}" if kind == "ELEMENT" else "N"
    made.rest.append(f"*SURFACE, NAME={name}, TYPE={kind}\n{row}\n")
    made.signs.append((f"surface {name}", tagged(name)))


def _header(made: Deck, rng: Rng) -> None:
    """Headers without lines, repeated or at the end, and the same lines once more."""
    kind = made.elements[0].split("\n")[0] + "\n"
    match rng.integers(4):
        case 0:
            made.elements[0] = kind + made.elements[0]
        case 1:
            made.rest.append("*NODE, NSET=Late\n")
            made.signs.append(("*NODE, NSET=Late", tagged("Late")))
        case 2:
            made.elements.append(made.elements[0])
        case _:
            made.nodes.append(made.nodes[0])


def _alike(made: Deck, rng: Rng) -> None:
    """Another part with the same numbers at another place: to be refused."""
    moved = [f"{made.first}, 50, 50, 50\n"]
    made.nodes.append("*NODE\n" + "".join(moved))
    made.signs.append(("a node at two places", lambda mesh: False))


def _ids(made: Deck, rng: Rng) -> None:
    """An element that names a node that is not there: to be refused."""
    made.elements[0] += (
        ", ".join(["9999", *[str(10**8 + k) for k in range(8 if "C3D8" in made.elements[0] else 4)]]) + "\n"
    )
    made.signs.append(("an element without nodes", lambda mesh: False))


def _include(made: Deck, rng: Rng) -> None:
    """Cards in included files, in a chain, a loop, or a tree without end."""
    name = f"inc{len(made.files)}.inp"
    match rng.integers(4):
        case 0:
            made.files[name] = made.elements[-1]
            made.elements[-1] = f"*INCLUDE, INPUT={name}\n"
        case 1:
            made.files[name] = made.nodes[0].partition("\n")[2]
            made.rest.append(f"*NODE, NSET=Again, INPUT={name}\n")
            made.signs.append(("Again", tagged("Again")))
        case 2:
            made.rest.append("*INCLUDE, INPUT=deck.inp\n")
            made.signs.append(("a loop", lambda mesh: False))
        case _:
            made.files |= {f"{name}{k}": f"*INCLUDE, INPUT={name}{k + 1}\n" * 9 for k in range(6)}
            made.files[f"{name}6"] = "** leaf\n"
            made.rest.append(f"*INCLUDE, INPUT={name}0\n")
            made.signs.append(("a tree", lambda mesh: False))


def _parts(made: Deck, rng: Rng) -> None:
    """Two parts numbered alike, with instances or without."""
    if made.wrap:
        return
    made.wrap = "*PART, NAME=P\n@*END PART\n*PART, NAME=Q\n@*END PART\n"
    made.cells *= 2
    if rng.random() < 0.7:
        made.wrap += "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=p\n*END INSTANCE\n"
        made.wrap += "*INSTANCE, NAME=J, PART=Q\n100, 0, 0\n*END INSTANCE\n*END ASSEMBLY\n"
        made.signs.append(("the offset of J", lambda mesh: mesh.mesh.points[:, 0].max() >= 100))
        made.signs.append(("the set of J", tagged("J.N")))


def _generated(made: Deck, rng: Rng) -> None:
    """Nodes by ``*NGEN``, ``*NCOPY`` and ``*NFILL``, also with parameters that are not honoured."""
    first, up = made.first, 2 * 10**6 + 10**5 * len(made.rest)
    match rng.integers(5):
        case 0:
            made.rest.append(
                f"*NGEN, NSET=G\n{first}, {first + 1}\n*NODE\n{up}, 9,9,9\n*NGEN, NSET=H\n{first}, {up}, {up - first}\n"
            )
            made.signs += [("*NGEN G", tagged("G")), ("*NGEN H", tagged("H"))]
        case 1:
            made.rest.append(f"*NCOPY, CHANGE NUMBER={up}, OLD SET=N, NEW SET=C, SHIFT\n0,0,{up}\n")
            made.signs += [("*NCOPY", tagged("C")), ("unused nodes", listed("*NODE"))]
        case 2:
            made.rest.append("*NFILL, SINGULAR=1\nN, N, 3, 1\n")
            made.signs.append(("*NFILL", listed("*NFILL, SINGULAR")))
        case 3:
            made.elements.append(f"*ELCOPY, ELEMENT SHIFT={up}, OLD SET=E, SHIFT NODES=0, NEW SET=EC\n")
            made.cells *= 2
            made.signs.append(("*ELCOPY", tagged("EC")))
        case _:
            made.rest.append(f"*ELGEN, ELSET=EG\n1, {rng.choice([1, 2, 10**9])}, 1, {up}\n")
            made.signs.append(("*ELGEN", tagged("EG")))


def _system(made: Deck, rng: Rng) -> None:
    """Nodes in another system of coordinates."""
    up = 3 * 10**6 + 10**5 * len(made.rest)
    system = str(rng.choice(["C", "S", "R", "X"]))
    made.rest.append(f"*SYSTEM\n0,0,50, 1,0,50\n*NODE, SYSTEM={system}, NSET=Y{system}\n{up}, 3, 90, 7\n*SYSTEM\n")
    made.signs += [("*NODE, SYSTEM", listed("*NODE")), (f"Y{system}", tagged(f"Y{system}"))]


def _option(made: Deck, rng: Rng) -> None:
    """A parameter that nobody knows."""
    head, _, rows = made.nodes[0].partition("\n")
    made.nodes[0] = f"{head}, FUZZ=1\n{rows}"
    made.signs.append(("FUZZ", listed("*NODE, FUZZ")))


def _odd(made: Deck, rng: Rng) -> None:
    """An entry of a line replaced by an odd one: to be refused, or to mean the same."""
    cards = made.nodes if rng.random() < 0.5 else made.elements
    lines = cards[0].split("\n")
    k = int(rng.integers(1, max(2, len(lines) - 1)))
    entries = lines[k].split(", ")
    j = int(rng.integers(len(entries)))
    old, entries[j] = entries[j], str(rng.choice(ODD))
    lines[k] = ", ".join(entries)
    cards[0] = "\n".join(lines)
    made.signs.append((f"{old} -> {entries[j][:9]}", lambda mesh: _same(old, entries[j])))


def _same(old: str, new: str) -> bool:
    """True if two entries are coordinates, which may lie anywhere; labels must not change."""
    return "." in old or new.strip() == old.strip() or old.strip() in ("0", "1", "2", "3")


MUTATIONS = (
    _ignored, _ignored, _foreign, _set, _set, _surface, _header, _alike, _ids, _include, _parts, _parts, _generated,
    _generated, _system, _option, _odd,
)  # fmt: skip
