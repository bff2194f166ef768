"""Audit of the heat of solids."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True, kw_only=True)
class HeatOfSolids:
    """Heat of the solids with a temperature at the end of a slab, and heats since the start of the march.

    Parameters
    ----------
    content
        Heat content [J]: with the kinetic and the strain energy of the ledger it is the whole energy of the solids.
    brought
        Heat that loads brought, less what they took away [J].
    received
        Heat that the motion gave: dissipated in the solids or by friction, or work against the thermal stress [J].
    reversible
        The part of ``received`` that nothing dissipated: work of the thermal stress and energy that the temperature
        takes from the strain energy, of either sign [J].
    friction
        Heat of friction in the solids and in rigid bodies with a temperature; what tools take is not in it [J].
    through
        Heat that passed each contact with heat, in the order of the scene: from the solid named first to the other one,
        with the heat of friction that a tool takes, but without that of a rigid body with a temperature, which is in
        ``friction`` [J].
    cold_work
        Energy that the material dissipated and that did not heat [J].
    entropy
        Entropy produced [J/K], with that of the heat which tools take at their temperatures; none of tools without.
    liquid
        Volume of the liquid of each solid that melts, measured in the reference configuration [m^3].
    rigid
        Temperature of each rigid body that has one [K].
    error
        Content less that at the start, ``brought`` and ``received`` [J].
    zero
        Part of the content that a state does not tell, since its meshes have another reference than those of the start
        of the march [J].
    produced, passed, rounding
        Entropy produced in this slab, the sum of the magnitudes of the entropies that took part in it, and the rounding
        of the first [J/K].

    Examples
    --------
    >>> HeatOfSolids(content=3.0).brought
    0.0
    """

    content: float
    brought: float = 0.0
    received: float = 0.0
    friction: float = 0.0
    reversible: float = 0.0
    through: tuple[float, ...] = ()
    cold_work: float = 0.0
    entropy: float = 0.0
    liquid: Mapping[str, float] = field(default_factory=dict)
    rigid: Mapping[str, float] = field(default_factory=dict)
    error: float = 0.0
    zero: float = 0.0
    produced: float = 0.0
    passed: float = 0.0
    rounding: float = 0.0
