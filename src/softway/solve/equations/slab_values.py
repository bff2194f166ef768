"""Values at the start of a slab, and evaluation of its equations."""

from dataclasses import dataclass

from softway.arrays import Array
from softway.bodies.assembled.material_states import MaterialStates
from softway.contact.contact_rows import ContactRows
from softway.model.field import FieldSolution, FieldState


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SlabStart:
    """Values at t0: displacement, velocity, internal force (n, d) and stored energy (parts,); history variables of the
    solids, the viscous part of the force (n, d) from the mean rate of the previous slab, and the companion fields.
    """

    displacement: Array
    velocity: Array
    force: Array
    energy: Array
    states: MaterialStates = ()
    viscous: Array | None = None
    fields: tuple[FieldState, ...] = ()

    @property
    def force_of_solids(self) -> Array:
        """Internal force (n, d) without the parts of companion fields [N]."""
        return sum((-f.force for f in self.fields), self.force)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Evaluation:
    """Equations evaluated at q: residual, end values and mean force (n, d); for each solid (parts,) the scalar a and
    the relative missing work that it closes; ``clipped`` and ``bounded`` as in
    :class:`~softway.solve.equations.energy_balance.EnergyClosure`; the contact rows at the end; the energy dissipated
    by bulk viscosity or given to companion fields (parts,), and the solutions of these fields.
    """

    residual: Array
    displacement: Array
    force: Array
    energy: Array
    mean_force: Array
    scalar: Array
    missing_work: Array
    clipped: bool
    rows: ContactRows
    bounded: bool = False
    lost: Array | float = 0.0
    fields: tuple[FieldSolution, ...] = ()
