"""What runs on one rank only is refused in words."""

import pytest

import softway as sw
from softway.cluster.admitted import require_several
from softway.model.build import build
from softway.model.model import Model
from softway.solve.operators import Factored


def solid(**more: object) -> sw.Solid:
    """Square in the plane."""
    given = {"material": sw.NeoHookean(E=100.0, nu=0.3), "density": 1.0}
    return sw.Solid(mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)), **{**given, **more})


def model(contact: sw.Contact | None = None, **more: object) -> Model:
    """Square above a wall."""
    floor = sw.Tool(shape=sw.obstacles.HalfSpace(point=(0.0, -0.1), normal=(0.0, 1.0)))
    contact = contact or sw.Contact(between=("one.bottom", "floor"))
    return build(sw.Scene(bodies={"one": solid(**more), "floor": floor}, contacts=(contact,)))


def two() -> Model:
    """Two squares."""
    other = solid(place=sw.bodies.Placement(translation=(2.0, 0.0)))
    return build(sw.Scene(bodies={"one": solid(), "other": other}))


ROUGH = sw.Contact(between=("one.bottom", "floor"), friction=sw.Coulomb(mu=0.3))
CASES = {
    "two bodies": (two, "bodies: runs on one rank only: 2 deformable bodies"),
    "friction": (lambda: model(ROUGH), "contacts: runs on one rank only: friction"),
    "history": (
        lambda: model(material=sw.J2(E=100.0, nu=0.3, yield_stress=1.0)),
        "bodies.one.material: runs on one rank only: several materials, or one with a history",
    ),
    "mean dilatation": (
        lambda: model(dilatation="mean"),
        "bodies.one.material: runs on one rank only: NeoHookean without a compiled law for such cells",
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
    with pytest.raises(sw.InputError, match="ranks: 5 for 4 cells\n  try: 4 or fewer"):
        require_several(model(), sw.FixedPoint(), 5)


def test_what_is_admitted() -> None:
    require_several(model(), sw.FixedPoint(), 4)
