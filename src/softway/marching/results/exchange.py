"""What the new mesh of a solid has changed."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Exchange:
    """What the new mesh of a solid has changed.

    Parameters
    ----------
    reason
        The measure that asked for it.
    nodes, cells
        Numbers of its nodes and cells.
    quality
        Least scaled Jacobian before and after.
    volume
        Change of the volume, relative to it.
    energy
        Energy that the solid has lost, which the ledger has as ``remeshing`` [J].
    """

    reason: str
    nodes: int
    cells: int
    quality: tuple[float, float]
    volume: float
    energy: float
