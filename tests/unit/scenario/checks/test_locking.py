"""Notes on cells that lock: said with the right number, each remedy tried by a run, silent where nothing locks."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import softway as sw
from softway.apps.verify.cases.large_deformation.d07_cooks_membrane import raised
from softway.bodies.elements.quadrature import Dilating
from softway.laws.law import Material, initial_moduli
from softway.marching.start.initial_state import initial_state
from softway.scenario.checks.locking import flowing, poisson

pytestmark = pytest.mark.slow

ELASTIC = sw.LinearElastic(E=1e4, nu=0.3)
PLASTIC = sw.laws.J2(E=200.0, nu=0.3, yield_stress=1.0)
VISCOUS = sw.laws.NortonHoff(K=1.0, m=0.2)
RUBBER = sw.laws.NeoHookean(E=1.0, nu=0.4999)
LENGTH = 10.0


def notes(solid: sw.Solid) -> list[str]:
    """Notes on a body alone."""
    found = sw.check(sw.Scenario(bodies={"body": solid}, time=sw.Time(end=1e-3))).notes
    assert all(note.where.startswith("bodies.body.") for note in found)
    return [f"{note.problem}; {note.remedy}" for note in found]


def square(law: Material, cells: int = 4, cell: str = "quad4", dilatation: Dilating = "point") -> sw.Solid:
    """Square between plates that hold its ends."""
    driven = tuple(sw.Driven(on="top", components=c, velocity=v) for c, v in (("x", 0.0), ("y", -1.0)))
    return sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(cells, cells), cell=cell),
        material=law,
        density=1.0,
        dilatation=dilatation,
        supports=(sw.Fixed(on="bottom"), *driven),
    )


def pressed(solid: sw.Solid) -> float:
    """Force that presses the square by 5 percent without inertia."""
    probe = sw.Probe(name="force", of="body", tag="top", quantity="reaction", component="y")
    scenario = sw.Scenario(
        bodies={"body": solid},
        time=sw.Time(end=0.05, step=0.01),
        inertia=sw.bodies.Off(),
        output=sw.Output(probes=(probe,)),
    )
    return abs(float(sw.run(scenario).history["force"][-1]))


@cache
def finely_pressed(law: Material) -> float:
    """Force on the square with cells that do not lock."""
    return pressed(square(law, 8, "quad9", "corner"))


def beam(
    cells: tuple[int, int], cell: str = "quad4", dilatation: Dilating = "point", section: object = None
) -> sw.Solid:
    """Cantilever of unit thickness."""
    return sw.Solid(
        mesh=sw.meshes.Rectangle(size=(LENGTH, 1.0), cells=cells, cell=cell),
        material=ELASTIC,
        density=1.0,
        dilatation=dilatation,
        section=section,
        supports=(sw.Fixed(on="left"),),
    )


def tip(solid: sw.Solid) -> float:
    """Deflection of the end of the cantilever under a shear load."""
    load = sw.Traction(on="body.right", value=(0.0, 1e-3))
    model = sw.build(sw.Scene(bodies={"body": solid}, loads=(load,), start=sw.model.StaticStart()))
    return float(initial_state(model).start.displacement[model.parts[0].mesh.nodes("right"), 1].mean())


@pytest.mark.parametrize("law", [*(pytest.param(law, marks=pytest.mark.minutes) for law in (PLASTIC, VISCOUS)), RUBBER])
def test_linear_quadrilaterals_are_noted_and_mean_dilatation_helps(law: Material) -> None:
    (note,) = notes(square(law))
    assert note.startswith(f"quad4 lock with {type(law).__name__}, ") and note.endswith('; dilatation = "mean"')
    assert notes(square(law, dilatation="mean")) == []
    fine = finely_pressed(law)
    wrong, remedied = (pressed(square(law, 4, dilatation=d)) / fine - 1.0 for d in ("point", "mean"))
    assert wrong > 0.4 and 0.0 < remedied < 0.4 * wrong


@pytest.mark.parametrize("law", [*(pytest.param(x, marks=pytest.mark.minutes) for x in (PLASTIC, VISCOUS)), RUBBER])
def test_linear_triangles_are_noted_and_only_quadratic_ones_help(law: Material) -> None:
    (note,) = notes(square(law, cell="tri3"))
    flows = ", or tri3 with it where the flow is large" if law is not RUBBER else ""
    assert note.startswith("tri3 lock with")
    assert note.endswith('quadratic cells (tri6) with dilatation = "corner"' + flows)
    assert len(notes(square(law, cell="tri3", dilatation="mean"))) == 1  # one point in a cell: no change
    assert notes(square(law, cell="tri6", dilatation="corner")) == []
    fine = finely_pressed(law)
    wrong, remedied = (
        pressed(square(law, cells, cell, d)) / fine - 1.0
        for cells, cell, d in ((8, "tri3", "mean"), (4, "tri6", "corner"))  # as many nodes
    )
    assert wrong > 0.08 and abs(remedied) < 0.4 * wrong


def test_triangles_with_means_at_corners_are_noted_only_where_they_are_stiffer_than_squares() -> None:
    """As good as ``quad4`` with ``mean`` in plastic flow, four times further off in elastic constant volume."""
    assert notes(square(PLASTIC, cell="tri3", dilatation="corner")) == []
    assert len(notes(square(RUBBER, cell="tri3", dilatation="corner"))) == 1
    for law, least, most in ((PLASTIC, 1.0, 1.3), (RUBBER, 3.0, 5.0)):
        fine = finely_pressed(law)
        triangles, squares = (
            pressed(square(law, 8, cell, d)) / fine - 1.0 for cell, d in (("tri3", "corner"), ("quad4", "mean"))
        )
        assert least * squares < triangles < most * squares


def test_cooks_membrane_locks_where_it_is_noted() -> None:
    """A third of the deflection, and all of it but 2 percent with the remedy."""
    assert raised("b", 16)[1] < 0.5 * raised("b", 16, "quad9", "corner")[1]
    assert raised("b", 16, dilatation="mean")[1] == pytest.approx(raised("b", 16, "quad9", "corner")[1], rel=0.03)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_compressible_elastic_material_is_not_noted(nu: float) -> None:
    assert notes(square(sw.laws.NeoHookean(E=1.0, nu=nu))) == []
    assert notes(square(sw.laws.Hypoelastic(E=1.0, nu=nu), cell="tri3")) == []


def test_plane_stress_bars_and_quadratic_cells_do_not_lock() -> None:
    assert notes(replace(square(PLASTIC), section=sw.bodies.PlaneStress())) == []
    assert notes(square(PLASTIC, cell="quad9")) == []
    bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=4), material=PLASTIC, density=1.0)
    assert notes(bar) == []


@pytest.mark.parametrize("cell", ["tet4", "hex8"])
def test_solid_cells_are_noted(cell: str) -> None:
    body = sw.Solid(mesh=sw.meshes.Box(size=(1.0, 1.0, 1.0), cells=(2, 2, 2), cell=cell), material=RUBBER, density=1.0)
    (note,) = notes(body)
    assert note.startswith(f"{cell} lock with NeoHookean, nu = 0.4999")
    assert note.endswith({"tet4": '(tet10) with dilatation = "corner"', "hex8": 'dilatation = "mean"'}[cell])


def test_remedy_names_an_average_force_that_takes_it() -> None:
    body = replace(square(RUBBER), force=sw.bodies.DiscreteGradient())
    (note,) = notes(body)
    assert note.endswith('dilatation = "mean" and force = { kind = "Weighted" }')
    assert notes(replace(body, force=sw.bodies.Weighted(), dilatation="mean")) == []


def test_poissons_ratio_at_rest_and_in_flow() -> None:
    assert poisson(initial_moduli(sw.laws.MooneyRivlin(c10=1.0, c01=0.2, bulk=1e4))) == pytest.approx(0.5, abs=2e-4)
    assert flowing(VISCOUS) > 0.4999 and flowing(PLASTIC) > 0.49
    assert flowing(ELASTIC) == pytest.approx(0.3) == flowing(sw.laws.Hypoelastic(E=1.0, nu=0.3))


BEAMS = [((5, 1), "point"), ((10, 2), "point"), ((20, 2), "point"), ((20, 1), "mean"), ((40, 2), "mean")]


@pytest.mark.parametrize(("cells", "dilatation"), BEAMS)
def test_slender_body_is_noted_with_the_error_of_its_stiffness(cells: tuple[int, int], dilatation: Dilating) -> None:
    (note,) = notes(beam(cells, dilatation=dilatation))
    error = tip(beam((40, 4), "quad9")) / tip(beam(cells, dilatation=dilatation)) - 1.0
    number, kind = note.split("it is about ")[1].split(";")[0].split("% too ")
    assert kind == ("stiff" if error > 0.0 else "soft")
    assert float(number) / 100.0 == pytest.approx(abs(error), rel=0.15)


def test_a_great_error_is_a_multiple() -> None:
    (note,) = notes(beam((1, 1), dilatation="point"))
    assert "times too stiff" in note and "%" not in note


def test_error_in_plane_stress() -> None:
    thin = sw.bodies.PlaneStress()
    (note,) = notes(beam((10, 1), section=thin))
    error = tip(beam((40, 4), "quad9", section=thin)) / tip(beam((10, 1), section=thin)) - 1.0
    assert float(note.split("it is about ")[1].split("%")[0]) / 100.0 == pytest.approx(error, rel=0.15)


def test_remedies_of_a_slender_body_help_and_end_the_note() -> None:
    (note,) = notes(beam((10, 2)))
    assert note.startswith(
        "2 layers of quad4 of the length 1 m in a thickness of 1 m: where the body bends, it is about"
    )
    assert note.endswith('quad9 and dilatation = "point", or shorter cells, and three layers or more')
    exact = tip(beam((40, 4), "quad9"))
    for cells, cell in (((10, 2), "quad9"), ((40, 3), "quad4")):
        assert notes(beam(cells, cell)) == []
        assert tip(beam(cells, cell)) == pytest.approx(exact, rel=0.06)


def test_body_that_cannot_bend_is_not_noted() -> None:
    """A block, and a slender strip between rollers along one of its faces."""
    assert notes(replace(beam((10, 2)), mesh=sw.meshes.Rectangle(size=(4.0, 1.0), cells=(4, 1)))) == []
    held = (sw.Fixed(on="left"), sw.Fixed(on="bottom", components="y"))
    assert notes(replace(beam((10, 2)), supports=held)) == []
    assert len(notes(replace(beam((10, 2)), supports=(sw.Fixed(on="bottom", components="x"),)))) == 1


def test_plate_of_one_layer_is_noted_and_a_slice_held_on_its_face_is_not() -> None:
    def plate(cells: tuple[int, int, int], **more: object) -> sw.Solid:
        mesh = sw.meshes.Box(size=(8.0, 8.0, 1.0), cells=cells)
        return sw.Solid(mesh=mesh, material=ELASTIC, density=1.0, **more)

    (note,) = notes(plate((8, 16, 1)))
    assert note.startswith("1 layer of hex8 of the length 1 m in a thickness of 1 m") and "about 57% too stiff" in note
    assert notes(plate((32, 32, 3))) == []
    assert notes(plate((8, 8, 1), supports=(sw.Fixed(on="bottom", components="z"),))) == []


def test_thin_ring_is_noted() -> None:
    mesh = sw.meshes.generators.recipes.Ring(inner=0.95, outer=1.05, cells=(2, 48), angle=2.0 * np.pi)
    (note,) = notes(sw.Solid(mesh=mesh, material=ELASTIC, density=1.0))
    assert "2 layers of quad4" in note and "too stiff" in note
