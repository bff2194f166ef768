"""Declaration of a contact: its two bodies, contact method, impact rule and friction law."""

from dataclasses import dataclass
from typing import Literal

from softway.contact.impact_rule import Energy, ImpactRule
from softway.laws.friction import Frictionless
from softway.laws.friction_law import FrictionLaw
from softway.laws.heat.contact_heat import ContactHeat


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
    """Unilateral contact of the surfaces of solids with each other and with tools.

    Parameters
    ----------
    between
        ``("body.tag", "tool")`` or ``("body.tag", "other.tag")``, without a tag the whole surface; a list of more than
        two: each with every other; a name that is given twice: this surface also with itself, ``("tube", "tube")``;
        ``"all"``: all surfaces with each other and themselves, and with all tools.  Surfaces that a contact of two
        names are left out of lists and of ``"all"``.
    name
        Name in the columns of the history; by default ``body.tag-tool``.
    timing
        Impact rule: :class:`~softway.contact.Energy`, :class:`~softway.contact.Impulse` or
        :class:`~softway.contact.Paper`.
    method
        Contact method between two solids; by default :class:`~softway.contact.DualMortar`, or
        :class:`~softway.contact.NodeToSurface` between bars, for lists, for bodies with themselves, and
        with the rules Paper and Impulse.  Two surfaces of one body may have mortar, if they have no node in common.
        Contact with a tool is always between nodes and the tool.
    friction
        Friction law; by default there is no friction.
    heat
        Heat across the contact, between solids with a temperature and with tools; by default none passes, and friction
        heats no body.
    start
        ``apart``: an overlap of the bodies at the start is an error; ``fit``: overlapping bodies are first pressed
        apart into static equilibrium (press fit).

    Examples
    --------
    >>> Contact(between=("bar.right", "wall")).label
    'bar.right-wall'
    >>> Contact(between=("tube", "tube")).many
    True
    """

    between: tuple[str, ...] | Literal["all"]
    name: str = ""
    timing: ImpactRule = Energy()
    method: DualMortar | NodeToSurface | None = None
    friction: FrictionLaw = Frictionless()
    heat: ContactHeat | None = None
    start: Literal["apart", "fit"] = "apart"

    @property
    def names(self) -> tuple[str, ...]:
        """Surfaces and tools in the order given; none for ``"all"``."""
        return () if self.between == "all" else tuple(self.between)

    @property
    def label(self) -> str:
        """Name of the contact in records."""
        return self.name or "-".join(self.names) or "all"

    @property
    def many(self) -> bool:
        """True for lists, bodies with themselves, and ``"all"``; not for mortar between two surfaces of one body."""
        mortar = isinstance(self.method, DualMortar) and len(self.surfaces) == 2
        return len(self.names) != 2 or (len(set(self.bodies)) == 1 and not mortar)

    @property
    def bodies(self) -> tuple[str, ...]:
        """Names of the bodies and tools in the order given."""
        return tuple(name.partition(".")[0] for name in self.names)

    @property
    def tags(self) -> tuple[str, ...]:
        """Tags in the order given; the whole surface by default."""
        return tuple(name.partition(".")[2] or "surface" for name in self.names)

    @property
    def surfaces(self) -> tuple[tuple[str, str], ...]:
        """Name and tag of each surface or tool, each once, in the order given."""
        return tuple(dict.fromkeys(zip(self.bodies, self.tags, strict=True)))

    @property
    def body(self) -> str:
        """Name of the first deformable body."""
        return self.bodies[0]

    @property
    def tag(self) -> str:
        """Tag of its contact nodes; the whole surface by default."""
        return self.tags[0]

    @property
    def opponent(self) -> str:
        """Name of the tool or of the other solid."""
        return self.bodies[1]

    @property
    def opponent_tag(self) -> str:
        """Tag of the surface of the other solid; its whole surface by default."""
        return self.tags[1]
