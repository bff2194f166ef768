"""Energy account of a run as its audit follows it, slab by slab."""

from collections.abc import Iterator
from dataclasses import dataclass

from softway.marching.results.finding import DISSIPATION, ENERGY, finding
from softway.marching.results.step import Event, Ledger

GIVEN_BACK = 1e-12
"""Dissipation of a slab, relative to the energies, below whose negative it is a finding."""
MISSED = 1e-2
"""Error of the energy balance since the start, relative to the energies that took part, above which it is a finding."""
ENERGIES = ("energy_kinetic", "energy_strain", "work_external", "dissipation", "energy_error")
"""Energies that an audit follows, by their names in the ledger and in the history."""
RECEIVED = "heat.received"
"""Column of the heat that the motion gave, in histories of solids with a temperature."""


@dataclass(frozen=True, slots=True)
class Miss:
    """Error of the balance at a ``time`` [s], and the ``scale`` of the energies that took part [J]."""

    time: float
    error: float
    scale: float


def received(ledger: Ledger) -> float:
    """Heat that the motion gave to solids with a temperature [J]; zero without."""
    return 0.0 if ledger.heat is None else ledger.heat.received


class EnergyWatch:
    """Greatest energy, dissipation and error of the balance so far.

    Parameters
    ----------
    energy
        Energy at the start [J].
    rounding
        Energy of strains that are rounding errors [J].

    Examples
    --------
    >>> watch = EnergyWatch(100.0)
    >>> watch.took(0.1, 60.0, 42.0, 0.0, 0.0, 2.0), watch.took(0.2, 60.0, 40.0, 0.0, 1.0, 1.0)
    (0.0, 1.0)
    >>> watch.looked(), watch.looked()
    (Miss(time=0.1, error=2.0, scale=102.0), None)
    """

    __slots__ = ("_dissipation", "_energy", "_received", "_work", "_worst", "rounding")

    def __init__(self, energy: float, rounding: float = 0.0) -> None:
        self._energy, self.rounding = energy, rounding
        self._work = self._dissipation = self._received = 0.0
        self._worst: Miss | None = None

    @property
    def level(self) -> float:
        """Greatest energy of the bodies so far, and what was dissipated or given to their heat [J]."""
        return self._energy + abs(self._dissipation) + self._received

    @property
    def scale(self) -> float:
        """Greatest energy of the bodies so far, the work of loads, supports and tools, and what heat received [J]."""
        return self._energy + abs(self._work) + self._received

    def took(
        self,
        time: float,
        kinetic: float,
        strain: float,
        work: float,
        dissipation: float,
        error: float,
        *,
        received: float = 0.0,
    ) -> float:
        """Energy dissipated in a slab [J], from the energies of the ledger at its end.

        What the heat of solids has ``received`` is none of it: it may come back.
        """
        strain, dissipation = strain + received, dissipation - received
        self._received = max(self._received, abs(received))
        gained = dissipation - self._dissipation
        self._energy, self._work, self._dissipation = max(self._energy, kinetic + strain), work, dissipation
        if not abs(error) <= MISSED * self.scale + self.rounding:
            now = Miss(time, error, self.scale)
            if self._worst is None or abs(error) * self._worst.scale > abs(self._worst.error) * now.scale:
                self._worst = now
        return gained

    def looked(self) -> Miss | None:
        """Worst of the balances that missed since the last call; None if none did."""
        worst, self._worst = self._worst, None
        return worst


def given_back(watch: EnergyWatch, gained: float, time: float, span: float) -> Iterator[Event]:
    """Finding on a slab of length ``span`` [s] that dissipated the energy ``gained`` [J], if that is negative."""
    if gained < -GIVEN_BACK * watch.level - watch.rounding:
        text = f"friction and material gave {-gained:.3g} J back in the slab of {span:.3g} s"
        yield finding(time, DISSIPATION, ("all",), text)


def missed(watch: EnergyWatch) -> Iterator[Event]:
    """Finding on the worst balance since the last call, if it missed."""
    worst = watch.looked()
    if worst is not None:
        text = f"the energy balance misses {worst.error:.3g} J of {worst.scale:.3g} J since the start"
        yield finding(worst.time, ENERGY, ("all",), text)
