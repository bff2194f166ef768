"""What runs on one rank only is refused in words."""

import pytest

import softway as sw
from softway.bodies import Thermal
from softway.bodies.elements.section import PlaneStress
from softway.cluster.admitted import require_several
from softway.heat.coupled.build import build
from softway.model.model import Model
from softway.solve.operators import ConjugateGradients, Factored


def solid(**more: object) -> sw.Solid:
    """Square in the plane."""
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4))
    given = {"mesh": mesh, "material": sw.NeoHookean(E=100.0, nu=0.3), "density": 1.0}
    return sw.Solid(**{**given, **more})


def model(contact: sw.Contact | None = None, **more: object) -> Model:
    """Square above a wall."""
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.1), normal=(0.0, 1.0)))
    contact = contact or sw.Contact(between=("one.bottom", "floor"))
    return build(sw.Scene(bodies={"one": solid(**more), "floor": floor}, contacts=(contact,)))


def two(between: object) -> Model:
    """Two squares."""
    other = solid(place=sw.bodies.Placement(translation=(2.0, 0.0)))
    return build(sw.Scene(bodies={"one": solid(), "other": other}, contacts=(sw.Contact(between=between),)))


def heated(*loads: object, solid_of: dict[str, object] | None = None, **more: object) -> Model:
    """Square with a temperature."""
    given = {"law": sw.heat.Conduction(conductivity=1.0, capacity=1.0), "temperature": 300.0}
    body = solid(thermal=Thermal(**{**given, **more}), **(solid_of or {}))
    return build(sw.Scene(bodies={"one": body}, loads=loads))


MELTING = sw.heat.Conduction(conductivity=1.0, capacity=1.0, latent=sw.heat.Latent(heat=10.0, melting=900.0))
VARYING = sw.heat.Conduction(
    conductivity=sw.heat.TemperatureTable(temperatures=(200.0, 400.0), values=(1.0, 2.0)), capacity=1.0
)
STIFFNESS = sw.heat.StiffnessTable(temperatures=(300.0, 500.0), values=(1.0, 0.8))
PLASTIC = {"material": sw.J2(E=100.0, nu=0.3, yield_stress=1.0), "section": PlaneStress(thickness=1.0)}
CASES = {
    "melting": (
        lambda: heated(law=MELTING),
        "bodies.one.thermal.law: runs on one rank only: heat of melting",
    ),
    "varying conductivity": (
        lambda: heated(law=VARYING),
        "bodies: runs on one rank only: conductivities and capacities that depend on the temperature",
    ),
    "varying moduli": (
        lambda: heated(stiffness=STIFFNESS),
        "bodies.one.thermal.stiffness: runs on one rank only: moduli that depend on the temperature",
    ),
    "radiation": (
        lambda: heated(sw.heat.Radiation(on="one.top", emissivity=0.5, ambient=300.0)),
        "loads: runs on one rank only: radiation of a surface",
    ),
    "expansion with free faces": (
        lambda: heated(expansion=1e-5, solid_of=PLASTIC),
        "bodies.one.thermal.expansion: runs on one rank only: thermal expansion of a law with a history in a body with "
        "free faces",
    ),
    "creep": (
        lambda: model(material=sw.laws.NortonHoff(K=1.0, m=0.5)),
        "bodies.one.material: runs on one rank only: a material without elasticity, whose slabs Newton's method has to "
        "take over",
    ),
    "mean dilatation of corners": (
        lambda: model(dilatation="corner"),
        "bodies.one.dilatation: runs on one rank only: 'corner', whose averages reach over several cells",
    ),
    "viscosity": (
        lambda: model(shock=sw.bodies.BulkViscosity()),
        "bodies.one.shock: runs on one rank only: a bulk viscosity",
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_a_scene_on_one_rank_only(name: str) -> None:
    made, told = CASES[name]
    with pytest.raises(sw.InputError) as caught:
        require_several(made(), sw.FixedPoint(), 2)
    assert str(caught.value) == f"{told}\n  try: a run on one rank, without --ranks"


@pytest.mark.parametrize("method", [sw.Newton(), sw.FixedPoint(operator=Factored())], ids=["Newton", "Factored"])
def test_a_method_on_one_rank_only(method: sw.Newton | sw.FixedPoint) -> None:
    with pytest.raises(sw.InputError, match="solver.*: runs on one rank only"):
        require_several(model(), method, 2)


def test_more_ranks_than_cells() -> None:
    with pytest.raises(sw.InputError, match="ranks: 17 for 16 cells\n  try: 16 or fewer"):
        require_several(model(), sw.FixedPoint(), 17)


def test_what_is_admitted() -> None:
    rough = sw.Contact(between=("one.bottom", "floor"), friction=sw.Coulomb(mu=0.3))
    require_several(model(), sw.FixedPoint(), 4)
    require_several(model(rough, material=sw.J2(E=100.0, nu=0.3, yield_stress=1.0)), sw.FixedPoint(), 4)
    require_several(two(("one.right", "other.left")), sw.FixedPoint(operator=ConjugateGradients()), 8)
