"""What must pass through every change of the meshes of a march."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.adaptivity.balances import spin
from softway.meshes.adaptive.refinement import refined


def finest(scene: sw.Scene, levels: int, *names: str) -> sw.Scene:
    """The scene with some solids on their finest cells everywhere."""
    bodies = dict(scene.bodies)
    for name in names:
        mesh = bodies[name].mesh
        bodies[name] = replace(bodies[name], mesh=refined(mesh, np.full(mesh.n_cells, levels)).mesh)
    return replace(scene, bodies=bodies)


def begins_as_it_ended(last: sw.Step, taken: sw.Step) -> None:
    """A slab begins with the momentum, the spin and, less what the change of the mesh took, the energy of the end of
    the last one.
    """
    model, before, ledger = taken.model, taken.before, last.ledger
    displacement, velocity = (model.join(field) for field in (before.displacement, before.velocity))
    momenta = model.mass @ velocity
    energy = 0.5 * float((velocity * momenta).sum()) + float(model.energy_and_force(displacement)[0].sum())
    scale = ledger.energy_kinetic + ledger.energy_strain
    assert momenta.sum(axis=0) == pytest.approx(ledger.momentum[: model.shape[1]], abs=1e-12 * abs(momenta).sum())
    assert spin(model.points + displacement, momenta) == pytest.approx(ledger.spin, abs=1e-12 * abs(momenta).sum())
    took = taken.ledger.remeshing - ledger.remeshing
    assert energy == pytest.approx(scale - took, abs=1e-12 * scale)


def keeps_its_balances(steps: Sequence[sw.Step], around: bool = False) -> int:
    """Momentum and spin of each slab begin as the last one ended, to rounding; only the momentum along the axis where
    bodies are ``around`` one; the energy of the whole march is in its ledger, to what iterates at their tolerance
    leave.  Number of the changes.
    """
    ledgers = [taken.ledger for taken in steps]
    energy = max(ledger.energy_kinetic + ledger.energy_strain for ledger in ledgers)
    for last, taken in zip(steps[:-1], steps[1:], strict=True):
        model, before, ledger = taken.model, taken.before, last.ledger
        u, v = (model.join(field) for field in (before.displacement, before.velocity))
        momenta = model.mass @ v
        scale = float(abs(momenta).sum())
        axes = slice(1 if around else 0, model.shape[1])
        assert momenta.sum(axis=0)[axes] == pytest.approx(ledger.momentum[axes], abs=1e-12 * scale)
        if not around:
            assert spin(model.points + u, momenta) == pytest.approx(ledger.spin, abs=1e-12 * scale)
        assert abs(taken.ledger.energy_error - ledgers[0].energy_error) < 1e-11 * energy
    return sum(bool(taken.transfers) for taken in steps)
