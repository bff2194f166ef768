"""Ledger of the heat: content against what came in and went out."""

from dataclasses import dataclass, replace

from softway.arrays import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class HeatLedger:
    """Heats at the end of a slab, sums since the start of the march.

    Parameters
    ----------
    heat_content
        Heat content of all bodies [J], counted from the solid at melting, or from 273.15 K where nothing melts.
    heat_in, heat_out
        Heat that loads brought, and that they took away, both positive [J].  The heat that a node needs to jump to a
        prescribed temperature is among them.
    error
        Content less that at the start, less ``heat_in``, plus ``heat_out`` [J].
    by_load
        (k,) heat that each load has brought [J]: first loads on surfaces, then sources, then prescribed temperatures,
        each in the order of the scene.
    by_contact
        (k,) heat that has passed each contact from its first to its second surface [J].

    Examples
    --------
    >>> ledger = HeatLedger(heat_content=3.0, heat_in=2.0, heat_out=0.0, error=0.0, by_load=(2.0,))
    >>> ledger.relative_error
    0.0
    """

    heat_content: float
    heat_in: float
    heat_out: float
    error: float
    by_load: tuple[float, ...] = ()
    by_contact: tuple[float, ...] = ()

    @property
    def relative_error(self) -> float:
        """Error relative to the heat that came in and went out; zero if there is none."""
        moved = self.heat_in + self.heat_out
        return abs(self.error) / moved if moved else 0.0


def opened(content: Array, loads: int, contacts: int = 0) -> HeatLedger:
    """Ledger at the start of a march, of contents (n,) [J] and numbers of loads and contacts."""
    zero = HeatLedger(heat_content=float(content.sum()), heat_in=0.0, heat_out=0.0, error=0.0)
    return replace(zero, by_load=(0.0,) * loads, by_contact=(0.0,) * contacts)


def booked(ledger: HeatLedger, content: Array, brought: Array, passed: Array | None = None) -> HeatLedger:
    """Ledger after heats that the loads ``brought`` (k,) and that ``passed`` the contacts [J], with the contents (n,)
    at the end [J].

    Examples
    --------
    >>> import numpy as np
    >>> after = booked(opened(np.array([1.0]), 2), np.array([1.5]), np.array([1.0, -0.5]))
    >>> after.heat_in, after.heat_out, after.error
    (1.0, 0.5, 0.0)
    """
    total = float(content.sum())
    gained, lost = float(brought[brought > 0.0].sum()), -float(brought[brought < 0.0].sum())
    return replace(
        ledger,
        heat_content=total,
        heat_in=ledger.heat_in + gained,
        heat_out=ledger.heat_out + lost,
        error=ledger.error + ((total - ledger.heat_content) - (gained - lost)),
        by_load=tuple(a + float(b) for a, b in zip(ledger.by_load, brought, strict=True)),
        by_contact=ledger.by_contact
        if passed is None
        else tuple(a + float(b) for a, b in zip(ledger.by_contact, passed, strict=True)),
    )
