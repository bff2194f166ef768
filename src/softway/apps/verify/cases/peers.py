"""Thrown cube, compared with other packages: 3000 unknowns, 100 slabs, defaults of softway."""

from time import perf_counter

import softway as sw
from softway.apps.verify.case import Beside, Outcome, sheet
from softway.apps.verify.scenes.cube import END, ENERGY, STEP, drop
from softway.record.view.plots.curves import Curve, Panel


def compute() -> Outcome:
    """Compute final energy, penetration, velocity of the centre of mass, and wall time."""
    begun = perf_counter()
    steps = list(sw.march(drop(9), until=END, step=STEP))
    wall = perf_counter() - begun
    last = steps[-1].ledger
    energy = (last.energy_kinetic + last.energy_strain) / ENERGY
    found = {
        "energy at the end over that at the start": energy,
        "mean velocity at the end": float(last.momentum[2]),
        "penetration": max(0.0, -min(step.certificate.min_gap for step in steps)),
    }
    known = sheet("peers")["reference"]
    mine = ("softway (this run)", f"{wall:.1f}", f"{energy:.3f}", f"{found['mean velocity at the end']:.3f}")
    table = Beside(
        title=known["caption"],
        heads=tuple(known["heads"]),
        rows=(*(tuple(row) for row in known["others"]), mine),
        note=known["note"],
    )
    times = [step.after.time for step in steps]
    curves = (Curve(x=times, y=[step.ledger.momentum[2] for step in steps], label="softway"),)
    panel = Panel(title="Velocity of the centre of mass", x="t", y="velocity", curves=curves)
    return Outcome(values=found, panels=(panel,), tables=(table,))
