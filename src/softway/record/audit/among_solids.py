"""Audit of the rigid bodies of a run with solids: ``rigid.csv`` against the joints, the stops and the history."""

from pathlib import Path

import numpy as np

from softway.arrays import Array
from softway.errors import InputError
from softway.model.model import Model
from softway.record.audit.mechanism import MechanismAudit, looked_at
from softway.record.audit.mechanism_energy import kinetic_energies, momenta
from softway.record.audit.placed_bodies import PlacedBodies
from softway.record.read.body_motion import motions_in
from softway.record.read.records import Records
from softway.record.storage import table
from softway.record.write.mechanism.rigid_table import FILE


def has_rigid_bodies(folder: Path) -> bool:
    """True for the folder of a run of solids with rigid bodies."""
    return (folder / FILE).is_file()


def audited_among_solids(run: Records, model: Model) -> MechanismAudit:
    """Audit the rigid bodies of a run with solids.

    Joints and stops are looked at in every line of ``rigid.csv``.  At the stored frames the energy and momenta of the
    rigid bodies and of the solids together have to be those of ``history.csv``; where meshes change the frames do not
    tell the masses of their nodes.

    Parameters
    ----------
    run
        The run.
    model
        The model that its scenario describes.

    Raises
    ------
    InputError
        If a table of the run is missing, damaged or empty, or does not belong to the model.
    """
    mechanism, motion = model.scene.mechanism, table.read(run.path / FILE, [("time", "s")])
    stays = not model.adapted
    if mechanism is None or (stays and len(run.fields.cells.reference) != len(model.points)):
        raise InputError(str(run.path), "is a run of other bodies", "the unchanged run folder")
    if not (motion.rows and run.history.rows):
        raise InputError(str(run.path), "holds no instant yet", "a run that has started to move")
    placed = PlacedBodies(mechanism=mechanism, motions=motions_in(motion, tuple(mechanism.bodies)))
    return looked_at(placed, _errors(run, model, placed, motion["time"]) if stays else {}, ())


def _errors(run: Records, model: Model, placed: PlacedBodies, time: Array) -> dict[str, float]:
    """Relative errors of the energy and momenta of the history at the frames."""
    history, rows, kinetic, linear, angular = run.history, [], [], [], []
    scale = {"momentum": 0.0, "spin": 0.0}
    for frame in run.fields:
        row = int(np.argmin(np.abs(time - frame.time)))
        if row >= history.rows:
            continue  # a killed run may have written one line more to one of the tables
        d = model.shape[1]
        own = np.zeros((len(frame.velocity), 3))
        own[:, :d] = model.mass @ frame.velocity[:, :d]
        rows.append(row)
        kinetic.append(0.5 * float((own * frame.velocity).sum()))
        linear.append(own.sum(axis=0))
        turning = np.cross(frame.points, own)
        angular.append(turning.sum(axis=0))
        scale["momentum"] = max(scale["momentum"], float(np.linalg.norm(own, axis=1).sum()))
        scale["spin"] = max(scale["spin"], float(np.linalg.norm(turning, axis=1).sum()))
    energy = float((history["energy_kinetic"] + history["energy_strain"] + np.abs(history["work_external"])).max())
    wrong = np.array(kinetic) + kinetic_energies(placed)[rows] - history["energy_kinetic"][rows]
    found = {"the kinetic energy": float(np.abs(wrong).max(initial=0.0)) / (energy or 1.0)}
    for (name, (rigid, size)), solids in zip(momenta(placed).items(), (linear, angular), strict=True):
        columns = np.stack([history[f"{name}_{a}"][rows] for a in "xyz"], axis=1)
        wrong = np.reshape(solids, (-1, 3)) + rigid[rows] - columns
        found[f"the {name}"] = float(np.abs(wrong).max(initial=0.0)) / (size + scale[name] or 1.0)
    return found
