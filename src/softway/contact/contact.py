"""Declaration of a contact: its two bodies, contact method, impact rule and friction law."""

from dataclasses import dataclass
from typing import Literal

from softway.contact.impact_rule import Energy, ImpactRule
from softway.laws.friction import Frictionless
from softway.laws.friction_law import FrictionLaw


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeToSurface:
    """Nodes of one surface against the facets of the other.

    Parameters
    ----------
    nodes
        ``finer``: the nodes of the finer surface against the facets of the coarser one; ``both``: the nodes of either
        surface against the facets of the other.

    Examples
    --------
    >>> NodeToSurface().nodes
    'finer'
    """

    nodes: Literal["finer", "both"] = "finer"


@dataclass(frozen=True, slots=True, kw_only=True)
class DualMortar:
    """Mean gaps over the finer surface, weighted by dual shape functions: passes the patch test.

    A mean gap does not detect sharp corners and edges: they have contact rows of their own.

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
        Name in the columns of the history; by default ``body.tag-tool``.
    timing
        Impact rule: :class:`~softway.contact.Energy`, :class:`~softway.contact.Impulse` or
        :class:`~softway.contact.Paper`.
    method
        Contact method between two solids; by default :class:`~softway.contact.DualMortar`, or
        :class:`~softway.contact.NodeToSurface` between bars and
        with the rules Paper and Impulse.  Contact with a tool is always between nodes and the tool.
    friction
        Friction law; by default there is no friction.
    start
        ``apart``: an overlap of the bodies at the start is an error; ``fit``: overlapping bodies are first pressed
        apart into static equilibrium (press fit).

    Examples
    --------
    >>> Contact(between=("bar.right", "wall")).label
    'bar.right-wall'
    """

    between: tuple[str, str]
    name: str = ""
    timing: ImpactRule = Energy()
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
        """Tag of the contact nodes; the whole surface by default."""
        return self.between[0].partition(".")[2] or "surface"

    @property
    def opponent(self) -> str:
        """Name of the tool or of the other solid."""
        return self.between[1].partition(".")[0]

    @property
    def opponent_tag(self) -> str:
        """Tag of the surface of the other solid; its whole surface by default."""
        return self.between[1].partition(".")[2] or "surface"
