"""Columns of history.csv: their names, units and values; a new column is one more line of ``EXTRA``."""

from collections.abc import Callable
from dataclasses import dataclass
from math import nan
from operator import attrgetter
from typing import Any

from softway.marching.results.step import Ledger
from softway.record.storage import table
from softway.record.write.recorder import RunStart


def nothing(start: RunStart) -> float:
    """Value of a column in the line of the initial state where nothing has happened yet."""
    return 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Column:
    """A column of the history.

    Parameters
    ----------
    name, unit
        Name and unit of the values.
    value
        Value after a step, or the values (k,) of the numbers of k slabs; one value if all are the same.
    initial
        Value in the line of the initial state.
    """

    name: str
    unit: str
    value: Callable[[Any], Any]
    initial: Callable[[RunStart], float] = nothing


def of_ledger(name: str, unit: str, read: Callable[[Ledger], float]) -> Column:
    """Column of a number of the ledger."""
    return Column(name, unit, lambda step: read(step.ledger), lambda start: float(read(start.ledger)))


def of_energy(name: str) -> Column:
    """Column of an energy or a work of the ledger."""
    return Column(name, "J", attrgetter(f"ledger.{name}"), attrgetter(f"ledger.{name}"))


def of_certificate(name: str, unit: str) -> Column:
    """Column of a number of the certificate; zero at the start."""
    return Column(f"certificate.{name}", unit, attrgetter(f"certificate.{name}"))


def of_contact(label: str) -> tuple[Column, ...]:
    """Columns of a contact."""
    return tuple(Column(f"contact.{label}.{name}", unit, *_number(label, name)) for name, unit in CONTACT)


def of_tie(label: str) -> tuple[Column, ...]:
    """Columns of a tie that breaks."""
    return tuple(of_ledger(f"tie.{label}.{name}", unit, _of_tie(label, name)) for name, unit in TIE)


def _of_tie(label: str, name: str) -> Callable[[Ledger], float]:
    return lambda ledger: float(getattr(ledger.ties[label], name))


def _number(label: str, name: str) -> tuple[Callable[[Any], Any], Callable[[RunStart], float]]:
    """Number of a contact after a step, and at the start of a run."""
    read = attrgetter(name)
    return lambda step: read(step.ledger.contacts[label]), lambda start: read(start.ledger.contacts[label])


CONTACT = (("force_n", "N"), ("force_t", "N"), ("min_gap", "m"), ("power_residual", "J"))
OF_HEAT = (
    *((name, "J") for name in ("content", "brought", "received", "reversible", "friction", "cold_work", "error")),
    ("entropy", "J/K"),
)
THROUGH, LIQUID, RIGID = "heat.through.", "liquid.", "temperature."
"""Beginnings of the names of the columns of heat that passed contacts, of liquid volumes, and of the temperatures of
rigid bodies.
"""
TIE = (("broken", table.RATIO), ("opening", "m"), ("dissipated", "J"))
COLUMNS = (
    Column("time", "s", attrgetter("slab.end"), lambda start: start.initial.time),
    Column("h", "s", attrgetter("slab.span")),
    Column("iterations", table.COUNT, attrgetter("report.iterations"), lambda start: 0),
    Column("pairs", table.COUNT, attrgetter("report.pairs"), lambda start: 0),
    Column("contraction", table.RATIO, attrgetter("report.contraction")),
    of_energy("energy_kinetic"),
    of_energy("energy_strain"),
    of_energy("work_external"),
    of_energy("dissipation"),
    of_energy("energy_error"),
    of_ledger("momentum_x", "kg m/s", lambda ledger: ledger.momentum[0]),
    of_ledger("momentum_y", "kg m/s", lambda ledger: ledger.momentum[1]),
    of_ledger("momentum_z", "kg m/s", lambda ledger: ledger.momentum[2]),
    of_ledger("spin_x", "kg m^2/s", lambda ledger: ledger.spin[0]),
    of_ledger("spin_y", "kg m^2/s", lambda ledger: ledger.spin[1]),
    of_ledger("spin_z", "kg m^2/s", lambda ledger: ledger.spin[2]),
)
"""Columns of every run; a file without one of them is refused."""
CERTIFICATE = (
    Column(
        "certificate.min_gap",
        "m",
        attrgetter("certificate.min_gap"),
        lambda start: min((c.min_gap for c in start.ledger.contacts.values()), default=float("inf")),
    ),
    of_certificate("min_force", "N"),
    of_certificate("complementarity", "J"),
    of_certificate("power_residual", "J"),
    of_certificate("momentum_error", "kg m/s"),
    of_certificate("energy_error", "J"),
)
EXTRA: tuple[Column, ...] = (
    Column("certificate.gap_nodes", "m", attrgetter("certificate.gap_nodes"), lambda start: nan),
    Column("certificate.gap_between", "m", attrgetter("certificate.gap_between"), lambda start: nan),
    Column("certificate.shape", table.RATIO, attrgetter("certificate.shape"), lambda start: nan),
)
"""Columns after those of the certificate; files of earlier versions lack them."""


def _through(number: int) -> Callable[[Ledger], float]:
    return lambda ledger: float("nan") if ledger.heat is None else ledger.heat.through[number]


def _liquid(name: str) -> Callable[[Ledger], float]:
    return lambda ledger: float("nan") if ledger.heat is None else ledger.heat.liquid[name]


def _of_rigid(name: str) -> Callable[[Ledger], float]:
    return lambda ledger: float("nan") if ledger.heat is None else ledger.heat.rigid[name]


def _of_heat(name: str) -> Callable[[Ledger], float]:
    return lambda ledger: float(getattr(ledger.heat, name))


REMESHING = of_energy("remeshing")
NODES = Column(
    "mesh.nodes",
    table.COUNT,
    lambda step: len(step.model.points),
    lambda start: sum(mesh.n_nodes for mesh in start.meshes.values()),
)
"""Columns of runs in which meshes change: energy that these changes took, and number of the nodes of all solids."""
HEAT = tuple(of_ledger(f"heat.{name}", unit, _of_heat(name)) for name, unit in OF_HEAT)
"""Columns of runs in which solids have a temperature."""


def columns(
    contacts: tuple[str, ...],
    ties: tuple[str, ...] = (),
    heat: tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]] | None = None,
    adapts: bool = False,
) -> tuple[Column, ...]:
    """Columns of a run with some contacts, ties that break, ``heat`` of solids: the contacts that it passes, in order,
    the solids that melt, and the rigid bodies with a temperature; and with meshes that change, ``adapts``; without its
    probes.
    """
    each = (column for label in contacts for column in of_contact(label))
    glued = (column for label in ties for column in of_tie(label))
    heated, changed = () if heat is None else of_heat(*heat), (REMESHING, NODES) if adapts else ()
    return (*COLUMNS, *each, *CERTIFICATE, *EXTRA, *glued, *heated, *changed)


def of_heat(passing: tuple[str, ...], melting: tuple[str, ...], rigid: tuple[str, ...]) -> tuple[Column, ...]:
    """Columns of the heat of solids."""
    through = (of_ledger(f"{THROUGH}{label}", "J", _through(k)) for k, label in enumerate(passing))
    liquid = (of_ledger(f"{LIQUID}{name}", "m^3", _liquid(name)) for name in melting)
    temperatures = (of_ledger(f"{RIGID}{name}", "K", _of_rigid(name)) for name in rigid)
    return (*HEAT, *through, *liquid, *temperatures)
