"""history.csv: one line for each accepted slab, on the disk before the next slab starts."""

from dataclasses import dataclass
from pathlib import Path

from softway.march.step import Ledger, Step
from softway.record import table
from softway.record.probes import Reading
from softway.record.recorder import Opening
from softway.record.table import Lines

FILE = "history.csv"
COLUMNS = (
    ("time", "s"),
    ("h", "s"),
    ("iterations", table.COUNT),
    ("pairs", table.COUNT),
    ("contraction", table.RATIO),
    ("energy_kinetic", "J"),
    ("energy_strain", "J"),
    ("work_external", "J"),
    ("dissipation", "J"),
    ("energy_error", "J"),
    ("momentum_x", "kg m/s"),
    ("momentum_y", "kg m/s"),
    ("momentum_z", "kg m/s"),
    ("spin_x", "kg m^2/s"),
    ("spin_y", "kg m^2/s"),
    ("spin_z", "kg m^2/s"),
)
CERTIFICATE = (
    ("certificate.min_gap", "m"),
    ("certificate.min_force", "N"),
    ("certificate.complementarity", "J"),
    ("certificate.power_residual", "J"),
    ("certificate.momentum_error", "kg m/s"),
    ("certificate.energy_error", "J"),
)
CONTACT = (("force_n", "N"), ("force_t", "N"), ("min_gap", "m"), ("power_residual", "J"))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class History:
    """The open file; ``contacts`` and ``readings`` are its columns after those of ``COLUMNS``."""

    lines: Lines
    contacts: tuple[str, ...]
    readings: tuple[Reading, ...]

    def take(self, step: Step) -> None:
        """Write the line of one slab: its audit, and the probes at its end."""
        start = [step.after.time, step.slab.span, step.report.iterations, step.report.pairs, step.report.contraction]
        left = [float(getattr(step.certificate, name.partition(".")[2])) for name, _ in CERTIFICATE]
        probes = [r.value(step.after, step.reactions) for r in self.readings]
        self.lines.write([*start, *_audit(step.ledger, self.contacts), *left, *probes])

    @property
    def mark(self) -> int:
        """Length of the file [bytes]."""
        return self.lines.mark

    def sync(self) -> None:
        """Bring the lines to the disk."""
        self.lines.sync()

    def close(self) -> None:
        """Close the file."""
        self.lines.close()


def open_history(folder: Path, opening: Opening, mark: int | None = None) -> History:
    """Start ``history.csv``, or go on with it; its first line is the initial situation, with ``h = 0``."""
    contacts = tuple(c.label for c in opening.scene.contacts)
    rows = table.lines(folder / FILE, mark)
    if mark is None:
        _begin(rows, opening, contacts)
    return History(lines=rows, contacts=contacts, readings=opening.readings)


def _begin(rows: Lines, opening: Opening, contacts: tuple[str, ...]) -> None:
    """Write the heads of the columns and the initial situation."""
    columns = [*COLUMNS, *((f"contact.{c}.{name}", unit) for c in contacts for name, unit in CONTACT), *CERTIFICATE]
    rows.write(table.header([*columns, *((r.name, r.unit) for r in opening.readings)]))
    probes = [r.value(opening.initial, {}) for r in opening.readings]
    gaps = [c.min_gap for c in opening.ledger.contacts.values()]
    left = [min(gaps, default=float("inf")), *[0.0] * (len(CERTIFICATE) - 1)]
    rows.write([opening.initial.time, 0.0, 0, 0, 0.0, *_audit(opening.ledger, contacts), *left, *probes])


def _audit(ledger: Ledger, contacts: tuple[str, ...]) -> list[float]:
    energies = [getattr(ledger, name) for name, unit in COLUMNS if unit == "J"]
    rows = [[getattr(ledger.contacts[c], name) for name, _ in CONTACT] for c in contacts]
    return [float(x) for x in (*energies, *ledger.momentum, *ledger.spin, *(x for row in rows for x in row))]
