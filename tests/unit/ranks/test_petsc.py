"""Multigrid of PETSc: its cycle, its march, and what is said without it (make test-mpi where petsc4py is installed)."""

import logging
import sys

import numpy as np
import pytest
import scipy.sparse as sp
from numpy.typing import NDArray

import softway as sw
from softway.cluster import own_gradients
from softway.cluster.march import march_on
from softway.cluster.own_gradients import declared, method_of_ranks
from softway.marching.results.step import Step
from softway.marching.state.march_state import Settings
from softway.marching.state.step_control import StepControl
from softway.model.time_weight import EndPeaks
from softway.ranks.alone import Alone
from softway.ranks.petsc import multigrid
from softway.ranks.threads import in_threads
from softway.solve import ConjugateGradients, Multigrid

MULTIGRID = sw.FixedPoint(operator=Multigrid(tolerance=1e-2))


@pytest.fixture
def petsc() -> None:
    """Skip where petsc4py is not installed."""
    pytest.importorskip("petsc4py", exc_type=(ImportError, RuntimeError))


def springs(n: int) -> tuple[sp.csr_array, NDArray[np.float64]]:
    """Matrix (2 n, 2 n) of a chain of n nodes in the plane with mass, and their places."""
    chain = sp.diags_array([-np.ones(n - 1), np.full(n, 2.01), -np.ones(n - 1)], offsets=(-1, 0, 1))
    return sp.csr_array(sp.kron(chain, sp.diags_array([1.0, 3.0]))), np.stack([np.arange(n), np.zeros(n)], axis=1) * 1.0


def marched(method: sw.FixedPoint) -> list[Step]:
    """Slabs of a supported block that a floor stops, on one rank."""
    block = sw.Solid(
        mesh=sw.meshes.Box(size=(1.0, 0.2, 0.2), cells=(10, 2, 2)),
        material=sw.NeoHookean(E=1e4, nu=0.3),
        density=1.0,
        supports=(sw.Fixed(on="left"),),
    )
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 0.0, -0.01), normal=(0.0, 0.0, 1.0)))
    scene = sw.Scene(
        bodies={"block": block, "floor": floor},
        contacts=(sw.Contact(between=("block.bottom", "floor")),),
        loads=(sw.Gravity(acceleration=(0.0, 0.0, -50.0)),),
    )
    settings = Settings(until=0.05, step=5e-3, weight=EndPeaks(), method=method, control=StepControl())
    return [step for step in march_on(Alone(), sw.build(scene), settings) if step is not None]


def test_the_cycle_is_symmetric_positive_and_reduces_the_error(petsc: None) -> None:
    """``a . P b = b . P a``, ``a . P a > 0``; the spectrum of P A lies in (0, 2)."""
    matrix, points = springs(40)
    cycle = multigrid(Alone(), matrix, np.arange(40), points)
    inverse = np.stack([cycle.applied(unit.reshape(40, 2)).ravel() for unit in np.eye(80)], axis=1)
    assert inverse == pytest.approx(inverse.T, abs=1e-12 * np.abs(inverse).max())
    spectrum = np.linalg.eigvals(inverse @ matrix.toarray())
    assert spectrum.real.min() > 0.05
    assert spectrum.real.max() < 2.0
    assert np.linalg.cond(matrix.toarray()) > 100.0


def test_a_march_has_the_motion_of_conjugate_gradients(petsc: None) -> None:
    """Equal displacements to 1e-12 and equal energies; the contact is closed in both."""
    one, other = (marched(sw.FixedPoint(operator=operator)) for operator in (ConjugateGradients(), Multigrid()))
    assert len(one) == len(other)
    for a, b in zip(one, other, strict=True):
        assert b.after.displacement["block"] == pytest.approx(a.after.displacement["block"], abs=1e-12)
        assert abs(b.ledger.energy_error) < 1e-11 * max(1.0, a.ledger.energy_strain)
    assert any(contact.count for step in one for contact in step.ledger.contacts.values())


def test_a_missing_petsc_is_said_and_conjugate_gradients_serve(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(own_gradients, "available", lambda: False)
    with caplog.at_level(logging.WARNING):
        method = method_of_ranks(MULTIGRID)
        steps = marched(MULTIGRID)
    assert isinstance(declared(method.operator), ConjugateGradients)  # type: ignore[arg-type]
    assert "petsc4py is not installed" in caplog.text
    assert "conda install petsc4py" in caplog.text
    assert steps[-1].after.time == pytest.approx(0.05)


def test_an_operator_of_ranks_is_recorded_as_declared(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(own_gradients, "available", lambda: True)
    assert declared(method_of_ranks(MULTIGRID).operator) == MULTIGRID.operator  # type: ignore[arg-type]


def test_a_library_that_does_not_load_is_an_error_with_a_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "petsc4py", None)
    matrix, points = springs(3)
    with pytest.raises(sw.InputError, match="petsc4py cannot be loaded") as told:
        multigrid(Alone(), matrix, np.arange(3), points)
    assert "python3-petsc4py" in str(told.value)


def test_threads_are_refused(petsc: None) -> None:
    matrix, points = springs(3)
    with pytest.raises(sw.InputError, match="PETSc over threads"):
        in_threads(1, lambda ranks: multigrid(ranks, matrix, np.arange(3), points))
