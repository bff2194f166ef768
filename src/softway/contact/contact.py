"""The declaration of a contact: who may touch whom, how the surfaces meet, and by which rule."""

from dataclasses import dataclass
from typing import Literal

from softway.contact.timing import Energy, Timing
from softway.laws.friction import Frictionless
from softway.laws.friction_law import FrictionLaw


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeToSurface:
    """Nodes of one surface against the faces of the other.

    Parameters
    ----------
    nodes
        ``finer``: the nodes of the finer surface against the faces of the coarser one; ``both``: the nodes of either
        against the faces of the other.

    Examples
    --------
    >>> NodeToSurface().nodes
    'finer'
    """

    nodes: Literal["finer", "both"] = "finer"


@dataclass(frozen=True, slots=True, kw_only=True)
class DualMortar:
    """Mean gaps over the finer surface, weighted by dual shape functions: passes the patch test.

    Sharp corners and edges, which a mean gap does not see, have rows of their own.

    Examples
    --------
    >>> DualMortar()
    DualMortar()
    """


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact:
    """Unilateral contact of the surface of a solid with a tool or with another solid.

    Parameters
    ----------
    between
        ``("body.tag", "tool")`` or ``("body.tag", "other.tag")``; without a tag the whole surface.
    name
        Used in the columns of the history; by default ``body.tag-tool``.
    timing
        What a touch does to the slab: :class:`Energy`, :class:`Impulse` or :class:`Paper`.
    method
        How two solids meet; by default :class:`DualMortar`, between bars and under the rules that locate instants
        (Paper, Impulse) :class:`NodeToSurface`.  Nodes meet tools.
    friction
        Law of the tangential traction; by default there is none.
    start
        ``apart``: bodies that overlap at the start are an error; ``fit``: they are pressed apart into static
        equilibrium first (a press fit).

    Examples
    --------
    >>> Contact(between=("bar.right", "wall")).label
    'bar.right-wall'
    """

    between: tuple[str, str]
    name: str = ""
    timing: Timing = Energy()
    method: DualMortar | NodeToSurface | None = None
    friction: FrictionLaw = Frictionless()
    start: Literal["apart", "fit"] = "apart"

    @property
    def label(self) -> str:
        """Name of the contact in records."""
        return self.name or f"{self.between[0]}-{self.between[1]}"

    @property
    def body(self) -> str:
        """Name of the deformable body."""
        return self.between[0].partition(".")[0]

    @property
    def tag(self) -> str:
        """Tag of the candidate nodes; the whole surface when none is given."""
        return self.between[0].partition(".")[2] or "surface"

    @property
    def opponent(self) -> str:
        """Name of the tool or of the other solid."""
        return self.between[1].partition(".")[0]

    @property
    def opponent_tag(self) -> str:
        """Tag of the other solid's surface; the whole one when none is given."""
        return self.between[1].partition(".")[2] or "surface"
