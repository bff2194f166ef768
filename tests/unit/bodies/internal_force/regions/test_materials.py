"""Laws by regions: what is refused, and with which remedy."""

import numpy as np
import pytest

import softway as sw
from softway.errors import InputError
from softway.meshes import Divided, InBall, InBox, Interval

SOFT, HARD = sw.LinearElastic(E=1.0), sw.LinearElastic(E=2.0)
BAR = Interval(length=1.0, cells=10)


def built(mesh: object, material: object, density: object = 1.0) -> object:
    return sw.build(sw.Scene(bodies={"bar": sw.Solid(mesh=mesh, material=material, density=density)}))


def refused(mesh: object, material: object, density: object = 1.0) -> InputError:
    with pytest.raises(InputError) as found:
        built(mesh, material, density)
    return found.value


def test_a_law_for_a_region_that_does_not_exist_names_those_that_do() -> None:
    mesh = Divided(mesh=BAR, regions={"tip": InBox(low=(0.5,))}, rest="shaft")
    error = refused(mesh, {"tip": SOFT, "shft": HARD})
    assert error.where == "bodies.bar.material.shft" and "'shft'" in error.problem
    assert "one of: shaft, tip, all" in error.remedy
    built(mesh, {"tip": SOFT, "shaft": HARD})
    built(mesh, {"TIP": SOFT, "Shaft": HARD})
    built(mesh, {"all": SOFT})


def test_cells_without_a_law_are_told_with_their_region() -> None:
    mesh = Divided(mesh=BAR, regions={"tip": InBox(low=(0.75,))}, rest="shaft")
    error = refused(mesh, {"tip": SOFT})
    assert error.where == "bodies.bar.material" and "7 of 10 cells have no law, the first at (0.05) m" in error.problem
    assert "they lie in shaft" in error.problem and error.remedy == "a law for shaft"
    lone = Divided(mesh=BAR, regions={"tip": InBox(low=(0.75,))}, rest="")
    error = refused(lone, {"tip": SOFT})
    assert "in no region" in error.problem and "Divided with rest" in error.remedy
    built(mesh, {"tip": SOFT, "shaft": HARD})
    whole = BAR.build()
    both = whole.with_region("tip", lambda x: x[:, 0] > 0.5).with_region("shaft", lambda x: x[:, 0] < 0.5)
    built(both, {"tip": SOFT, "shaft": HARD})


def test_cells_with_two_laws_are_told_with_both_regions() -> None:
    whole = BAR.build().with_region("left", lambda x: x[:, 0] < 0.6).with_region("right", lambda x: x[:, 0] > 0.4)
    error = refused(whole, {"left": SOFT, "right": HARD})
    assert error.where == "bodies.bar.material.right"
    assert "2 cells have the law of 'left' too, the first at (0.45) m" in error.problem
    assert "no law for 'left'" in error.remedy
    built(whole.with_region("right", lambda x: x[:, 0] > 0.6), {"left": SOFT, "right": HARD})


@pytest.mark.parametrize(
    ("density", "where"),
    [({"left": 1.0}, "density.right"), ({"left": 1.0, "right": 1.0, "top": 2.0}, "density.top")],
)
def test_densities_are_those_of_the_laws(density: dict[str, float], where: str) -> None:
    with pytest.raises(InputError) as found:
        sw.Solid(mesh=BAR, material={"left": SOFT, "right": HARD}, density=density)
    assert found.value.where == where


def test_densities_by_regions_need_laws_by_regions() -> None:
    with pytest.raises(InputError, match="one law for the body"):
        sw.Solid(mesh=BAR, material=SOFT, density={"left": 1.0})
    with pytest.raises(InputError, match="no law"):
        sw.Solid(mesh=BAR, material={}, density=1.0)


def test_each_law_is_checked() -> None:
    with pytest.raises(InputError) as found:
        sw.Solid(mesh=BAR, material={"a": SOFT, "b": sw.NeoHookean(E=1.0, nu=0.5)}, density=1.0)
    assert found.value.where == "material.b.nu"
    plastic = sw.J2(E=1.0, nu=0.3, yield_stress=1.0)
    with pytest.raises(InputError, match="J2, which has no stored energy"):
        sw.Solid(mesh=BAR, material={"a": SOFT, "b": plastic}, density=1.0, force=sw.bodies.DiscreteGradient())


def test_zones_divide_a_mesh() -> None:
    mesh = sw.meshes.Rectangle(size=(1.0, 1.0), cells=(4, 4))
    ball, box = InBall(centre=(0.5, 0.5), radius=0.2), InBox(low=(0.0, 0.5))
    found = Divided(mesh=mesh, regions={"core": ball, "top": box}, rest="bottom").build()
    assert {name: len(cells) for name, cells in found.regions.items()} == {"core": 4, "top": 6, "bottom": 6}
    assert np.array_equal(np.sort(np.concatenate(list(found.regions.values()))), np.arange(16))
    turned = sw.bodies.Placement(translation=(3.0, 1.0)).applied(found.with_tag("low", lambda x: x[:, 1] < 0.1))
    assert turned.regions.keys() == found.regions.keys()


@pytest.mark.parametrize(
    ("zone", "where"),
    [
        (InBox(low=(2.0,)), "regions.a"),
        (InBox(), "regions.a.high"),
        (InBox(low=(0.0, 1.0)), "regions.a.low"),
        (InBall(centre=(0.0, 0.0), radius=1.0), "regions.a.centre"),
    ],
)
def test_zones_that_fit_no_cell_are_refused(zone: object, where: str) -> None:
    with pytest.raises(InputError) as found:
        Divided(mesh=BAR, regions={"a": zone}).build()
    assert found.value.where == where
    Divided(mesh=BAR, regions={"a": InBox(low=(0.5,))}).build()


def test_the_fastest_wave_sets_the_slab() -> None:
    mesh = Divided(mesh=BAR, regions={"a": InBox(low=(0.5,))}, rest="b")
    model = built(mesh, {"a": sw.LinearElastic(E=4.0), "b": sw.LinearElastic(E=9.0)}, {"a": 1.0, "b": 9.0})
    assert model.wave_speed(model.parts[0]) == 2.0
    assert model.parts[0].materials.impedance(model.parts[0].internal.section) == 2.0
    assert model.parts[0].materials.stiffest(model.parts[0].internal.section) == (9.0, 1.0)
