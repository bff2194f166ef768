"""Sums over nodes of one's own: a march takes them from its vector space only."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

import softway as sw
from softway.bodies.assembled.vector_space import LocalSpace
from softway.model.build import build
from softway.model.model import Model


@dataclass(frozen=True)
class Halves:
    """Every sum in two parts, as two processes would have them, and the number of calls."""

    local: LocalSpace
    calls: dict[str, int] = field(default_factory=dict)

    def _halves(self, name: str, *fields: np.ndarray) -> tuple[tuple[np.ndarray, ...], tuple[np.ndarray, ...]]:
        self.calls[name] = self.calls.get(name, 0) + 1
        cut = [len(f) // 2 for f in fields]
        one = tuple(f[:k] for f, k in zip(fields, cut, strict=True))
        return one, tuple(f[k:] for f, k in zip(fields, cut, strict=True))

    def greatest(self, *fields: np.ndarray) -> float:
        return max(self.local.greatest(*part) for part in self._halves("greatest", *fields))

    def least(self, field: np.ndarray) -> float:
        return min(self.local.least(*part) for part in self._halves("least", field))

    def total(self, density: np.ndarray) -> float:
        return sum(self.local.total(*part) for part in self._halves("total", density))

    def mean(self, density: np.ndarray) -> float:
        return self.total(density) / density.size

    def sums(self, density: np.ndarray) -> np.ndarray:
        one, other = self._halves("sums", density)
        return self.local.sums(*one) + self.local.sums(*other)

    def totals(self, density: np.ndarray) -> np.ndarray:
        self._halves("totals", density)
        return np.array([self.total(density[rows]) for rows in self.local.solids])

    def totals_of(self, densities: Sequence[np.ndarray]) -> np.ndarray:
        return np.array([self.totals(density) for density in densities])

    def dot(self, a: np.ndarray, b: np.ndarray) -> float:
        return sum(self.local.dot(*part) for part in self._halves("dot", a, b))

    def norm(self, field: np.ndarray) -> float:
        return float(np.sqrt(self.dot(field, field)))

    def products(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        one, other = self._halves("products", a, b)
        return self.local.products(*one) + self.local.products(*other)

    def products_of(self, a: np.ndarray, vectors: Sequence[np.ndarray]) -> tuple[np.ndarray, ...]:
        return tuple(self.products(a, b) for b in vectors)

    def works(self, forces: np.ndarray, motion: np.ndarray) -> np.ndarray:
        return np.array([self.total(f * motion) for f in forces])

    def every(self, mask: np.ndarray) -> bool:
        return all(self.local.every(*part) for part in self._halves("every", mask))

    def gather(self, field: np.ndarray) -> np.ndarray:
        one, other = self._halves("gather", field)
        return np.concatenate([*one, *other])

    @property
    def of_unknowns(self) -> "Halves":
        return self

    def among(self, rows: slice | np.ndarray) -> "Halves":
        return self

    def filled(self, field: np.ndarray) -> np.ndarray:
        return np.concatenate([*self._halves("filled", field)[0], *self._halves("filled", field)[1]])

    def combined(self, weights: np.ndarray, fields: np.ndarray) -> np.ndarray:
        return self.local.combined(weights, fields)


def in_halves(model: Model) -> tuple[Model, Halves]:
    """The model with its sums in two parts."""
    space = Halves(LocalSpace(tuple(p.nodes for p in model.parts)))
    return replace(model, space=space, contacts=replace(model.contacts, space=space)), space


def discs() -> sw.Scene:
    """Two discs, of which one is thrown at the other."""
    bodies = {
        name: sw.Solid(
            mesh=sw.meshes.Disc(radius=1.0, cells=4),
            material=sw.NeoHookean(E=100.0, nu=0.3),
            density=1.0,
            place=sw.bodies.Placement(translation=(x, y)),
            velocity=sw.bodies.Uniform(value=(-speed, 0.0)),
        )
        for name, x, y, speed in (("left", 0.0, 0.0, 0.0), ("right", 2.02, 0.3, 1.0))
    }
    return sw.Scene(bodies=bodies, contacts=(sw.Contact(between=("left", "right")),))


@pytest.mark.parametrize(
    "method", [sw.FixedPoint(), pytest.param(sw.Newton(), marks=pytest.mark.slow)], ids=["fixed-point", "newton"]
)
def test_a_march_takes_all_sums_from_its_space(method: sw.FixedPoint | sw.Newton) -> None:
    """The same motion to rounding, with the sums in two parts."""
    model = build(discs())
    halves, space = in_halves(model)
    ours = list(sw.march(halves, until=0.4, step=0.02, method=method))
    theirs = list(sw.march(model, until=0.4, step=0.02, method=method))
    for mine, other in zip(ours, theirs, strict=True):
        for name in ("left", "right"):
            np.testing.assert_allclose(mine.after.displacement[name], other.after.displacement[name], atol=1e-9)
        assert abs(mine.certificate.energy_error) < 1e-12
    assert any(s.ledger.contacts["left-right"].force_n > 0.0 for s in ours)
    assert {"greatest", "total", "totals", "dot", "every", "products", "gather"} <= set(space.calls)
