"""Short decks for the tests of the reader."""

from pathlib import Path

from softway.meshes.files.abaqus.assembly import deck_mesh
from softway.meshes.files.listed_mesh import ListedMesh

CUBE = """*NODE
1, 0,0,0
2, 1,0,0
3, 1,1,0
4, 0,1,0
5, 0,0,1
6, 1,0,1
7, 1,1,1
8, 0,1,1
*ELEMENT, TYPE=C3D8
1, 1,2,3,4,5,6,7,8
"""


def read(folder: Path, text: str, *, cells: tuple[str, ...] | None = None, only: tuple[str, ...] = ()) -> ListedMesh:
    """Mesh of a deck with this text."""
    (folder / "deck.inp").write_text(text)
    return deck_mesh(folder / "deck.inp", cells, only)


def listed(mesh: ListedMesh) -> dict[str, int]:
    """Cards that are left out and matter, with their numbers."""
    return {card.card: card.count for card in mesh.left_out if card.matters}
