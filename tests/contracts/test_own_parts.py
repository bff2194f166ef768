"""Parts of one's own take one file and no change of the package: a contact rule, an obstacle, a column of the history.

A law of one's own is the subject of ``docs/how-to/own_law.md``, whose page runs in ``tests/examples/test_own_law.py``.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

import softway as sw
from softway.marching.results.slab_result import SlabResult
from softway.marching.rules.equilibrated import EndForceContact, Equilibrated
from softway.marching.rules.slab_rule import Attempt, Method, SlabRule
from softway.model.model import Model
from softway.model.time_weight import TimeWeight
from softway.record.storage.table import RATIO
from softway.record.write import history_columns
from softway.solve.operators.operator_memory import OperatorMemory
from softway.testing import check_obstacle

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True, kw_only=True)
class Counting:
    """A rule that counts contact rows in touch and leaves the slab to the rule Energy."""

    massless: ClassVar[bool] = True

    spread: int = 5
    counts: list[int] = field(default_factory=list, compare=False)

    def slab_rule(self, model: Model, method: Method, weight: TimeWeight) -> SlabRule:
        """The slab rule of a model."""
        if isinstance(method, sw.Explicit):
            raise sw.InputError("solver", "Explicit with the rule Counting", "FixedPoint or Newton")
        return Counted(rule=Equilibrated(method=method, contact=EndForceContact()), counts=self.counts)


@dataclass(frozen=True)
class Counted:
    """Slabs of another rule, counted."""

    rule: SlabRule
    counts: list[int]

    def solve(
        self, model: Model, now: object, slab: object, memory: OperatorMemory, attempt: Attempt
    ) -> Iterator[tuple[SlabResult, OperatorMemory]]:
        """Solutions of the slab."""
        for out, after in self.rule.solve(model, now, slab, memory, attempt):
            self.counts.append(int(out.closed.sum()))
            yield out, after


@dataclass(frozen=True, kw_only=True)
class Slope:
    """The half-space under the line ``y = rise x``."""

    rise: float
    dim: ClassVar[int] = 2

    def gap(self, x: np.ndarray) -> np.ndarray:
        return (x[..., 1] - self.rise * x[..., 0]) / np.hypot(1.0, self.rise)

    def normal_at(self, x: np.ndarray) -> np.ndarray:
        return np.broadcast_to(np.array([-self.rise, 1.0]) / np.hypot(1.0, self.rise), x.shape).copy()


def scene(rule: object = sw.contact.Energy(), shape: object = None) -> sw.Scene:
    """A block thrown on an obstacle."""
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(3, 3)),
        material=sw.NeoHookean(E=100.0, nu=0.3),
        density=1.0,
        place=sw.bodies.Placement(translation=(0.0, 0.25)),
        velocity=sw.bodies.Uniform(value=(0.0, -1.0)),
    )
    floor = sw.Tool(shape=shape or sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(0.0, 1.0)))
    contact = sw.Contact(between=("block.bottom", "floor"), timing=rule)
    return sw.Scene(bodies={"block": block, "floor": floor}, contacts=(contact,))


def test_a_contact_rule_is_one_file() -> None:
    """It gives the results of the rule that it leaves its slabs to, and has seen every slab."""
    rule = Counting()
    ours = list(sw.march(scene(rule), until=0.6, step=0.02))
    theirs = list(sw.march(scene(), until=0.6, step=0.02))
    assert ours[-1].ledger.momentum[1] == theirs[-1].ledger.momentum[1] > 0.0
    assert max(abs(s.ledger.energy_error) for s in ours) < 1e-12
    assert len(rule.counts) >= len(ours) and max(rule.counts) == 4


def test_a_contact_rule_refuses_what_it_cannot_do() -> None:
    with pytest.raises(sw.InputError, match="Counting"):
        sw.march(scene(Counting()), until=0.6, step=0.02, method=sw.Explicit())


def test_an_obstacle_is_one_file() -> None:
    """The block leaves a slope at right angles to it, with its energy; a half-space does the same to it."""
    slope = Slope(rise=0.2)
    check_obstacle(slope, np.random.default_rng(0).normal(size=(20, 2)))
    ours = list(sw.march(scene(shape=slope), until=0.6, step=0.02))
    plane = sw.obstacles.HalfSpace(point=(0.0, 0.0), normal=(-0.2, 1.0))
    theirs = list(sw.march(scene(shape=plane), until=0.6, step=0.02))
    assert max(abs(s.ledger.energy_error) for s in ours) < 1e-12
    change = ours[-1].ledger.momentum[:2] - [0.0, -1.0]
    assert abs(change @ [1.0, 0.2]) < 1e-10 * np.linalg.norm(change)
    assert ours[-1].ledger.momentum == pytest.approx(theirs[-1].ledger.momentum, abs=1e-9)


def test_a_column_of_the_history_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The share of kinetic energy of a bar at rest and of one that flies."""

    def share(ledger: sw.Ledger) -> float:
        return ledger.energy_kinetic / (ledger.energy_kinetic + ledger.energy_strain)

    monkeypatch.setattr(history_columns, "EXTRA", (history_columns.of_ledger("kinetic_share", RATIO, share),))
    text = (ROOT / "scenarios" / "paper_bar.toml").read_text(encoding="utf-8")
    run = sw.run(sw.loads(text, changes=["time.end=0.2"]), tmp_path / "run")
    assert run.history["kinetic_share"].tolist() == [1.0] * run.history.rows
    monkeypatch.undo()
    assert sw.Run(tmp_path / "run").history["kinetic_share"][0] == 1.0
