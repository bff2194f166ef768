"""Bodies at rest, and bodies whose nodes are all prescribed: nothing is left to compute, and the march goes on."""

import numpy as np
import pytest

import softway as sw
from softway.bodies.internal_force.slab_average import EnergyMomentum
from softway.contact import Energy, Impulse, Paper

pytestmark = pytest.mark.slow

LAWS = [
    sw.LinearElastic(E=210e9, nu=0.3),
    sw.NeoHookean(E=210e9, nu=0.3),
    sw.Hypoelastic(E=210e9, nu=0.3),
    sw.J2(E=210e9, nu=0.3, yield_stress=235e6),
]
METHODS = [sw.FixedPoint(), sw.Newton(), sw.Explicit()]
laws = pytest.mark.parametrize("law", LAWS, ids=lambda m: type(m).__name__)
methods = pytest.mark.parametrize("method", METHODS, ids=lambda m: type(m).__name__)


@pytest.mark.few(16)
@laws
@pytest.mark.parametrize("method", [sw.FixedPoint(), sw.Explicit()], ids=lambda m: type(m).__name__)
@pytest.mark.parametrize("dilatation", ["point", "mean"])
@pytest.mark.parametrize("gap", [1.0, 1e-4, 0.0])
def test_a_body_at_rest_stays_at_rest(law: sw.LinearElastic, method: sw.Explicit, dilatation: str, gap: float) -> None:
    """At any distance from a wall.  Forces of rounding do not keep the contact nodes from their equilibrium."""
    mesh = sw.meshes.Rectangle(size=(0.02, 0.02), cells=(4, 4))
    body = sw.Solid(mesh=mesh, material=law, density=7850.0, dilatation=dilatation)
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -gap), normal=(0.0, 1.0)))
    scene = sw.Scene(bodies={"b": body, "w": wall}, contacts=(sw.Contact(between=("b.bottom", "w")),))
    steps = list(sw.march(scene, until=2e-6, method=method))
    assert not any(s.report.rejections for s in steps)
    assert np.abs(steps[-1].after.displacement["b"]).max() <= 1e-15
    assert not steps[-1].events


@pytest.mark.few(16)
@methods
@pytest.mark.parametrize("inertia", [sw.bodies.Full(), sw.bodies.Off()], ids=lambda i: type(i).__name__)
@pytest.mark.parametrize("rule", [None, Energy(), Impulse(), Paper()], ids=lambda r: type(r).__name__)
@pytest.mark.parametrize("force", [sw.bodies.Weighted(), EnergyMomentum()], ids=lambda f: type(f).__name__)
def test_the_natural_test_of_a_law(method: sw.Explicit, inertia: sw.bodies.Full, rule: Energy, force: object) -> None:
    """One sheared cell, all of whose nodes are prescribed: G times the shear, and the work of the supports."""
    odd = (isinstance(method, sw.Explicit), not inertia.factor, not getattr(rule, "massless", True))
    if sum(odd) > 1 or (odd[0] and force != sw.bodies.Weighted()):
        return  # refused
    mesh, pull = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(1, 1)), 0.1
    supports = (
        sw.Fixed(on="bottom"),
        sw.Driven(on="top", components="x", velocity=pull),
        sw.Fixed(on="top", components="y"),
    )
    law = sw.LinearElastic(E=1.0, nu=0.25)
    cell = sw.Solid(mesh=mesh, material=law, density=1e-6, supports=supports, force=force)
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, 1.0), normal=(0.0, -1.0)))
    met = () if rule is None else (sw.Contact(between=("b.top", "w"), timing=rule),)
    scene = sw.Scene(bodies={"b": cell, "w": wall}, contacts=met, inertia=inertia)
    last = list(sw.march(scene, until=1.0, step=0.1, method=method))[-1]
    assert last.after.displacement["b"][2:, 0] == pytest.approx(pull, rel=1e-14)
    work = 0.5 * pull**2 / (2.0 * 1.25)
    assert last.ledger.energy_strain == pytest.approx(work, rel=1e-12)
    assert last.ledger.work_external == pytest.approx(work, rel=1e-9)
    assert list(sw.march(scene, until=0.1, method=method))  # a thousand slabs of its own length


@laws
def test_supports_that_hold_a_stretched_body_without_inertia(law: sw.LinearElastic) -> None:
    """The whole surface is held; what momentum rounding leaves has no scale but that of the positions."""
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2))
    stretch = sw.bodies.Affine(value=(0.0, 0.0), gradient=((1e-4, 0.0), (0.0, 0.0)))
    held = (sw.Driven(on="surface", velocity=0.0),)
    body = sw.Solid(mesh=mesh, material=law, density=1.0, displacement=stretch, supports=held)
    steps = list(sw.march(sw.Scene(bodies={"b": body}, inertia=sw.bodies.Off()), until=1.0, step=0.5))
    assert len(steps) == 2 and not any(s.report.rejections for s in steps)
