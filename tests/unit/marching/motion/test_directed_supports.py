"""Supports along directions: the same motion as with supports along the axes, in a turned frame."""

from dataclasses import replace

import numpy as np
import pytest

import softway as sw
from softway.bodies.inertia.inertia_scaling import Full, Off
from softway.bodies.setup.motion_laws import SmoothSteps, value_and_rate
from softway.bodies.solid import Driven, Fixed, Guided, Support
from softway.contact.impact_rule import Energy, Impulse
from softway.errors import InputError
from softway.marching.march import march
from softway.marching.results.step import Step
from softway.meshes.generators.shapes import rectangle
from softway.meshes.mesh import Mesh
from softway.solve.methods.central_difference import Explicit
from softway.solve.operators.matrix_free import MatrixFree

ANGLE = 0.6
MESH = rectangle((1.0, 0.5), (4, 2)).with_tag("foot", lambda x: (x[:, 1] < 1e-9) & (x[:, 0] < 0.9))
"""A block; a roller at the corner that meets the wall would leave its friction and normal force undetermined."""


def turned(vector: tuple[float, float], angle: float) -> tuple[float, float]:
    c, s = np.cos(angle), np.sin(angle)
    return float(c * vector[0] - s * vector[1]), float(s * vector[0] + c * vector[1])


def turn(mesh: Mesh, angle: float) -> Mesh:
    c, s = np.cos(angle), np.sin(angle)
    return replace(mesh, points=mesh.points @ np.array([[c, s], [-s, c]]))


def scene(angle: float, *supports: Support, **options: object) -> sw.Scene:
    """A block that slides along its bottom against a wall, with its weight across and along, all turned by an angle."""
    rule = options.pop("timing", Energy())
    friction = options.pop("friction", None)
    solid = sw.Solid(
        mesh=turn(MESH, angle),
        material=options.pop("material", sw.NeoHookean(E=50.0, nu=0.3)),
        density=1.0,
        velocity=sw.bodies.Uniform(value=turned(options.pop("speed", (0.5, 0.0)), angle)),
        supports=supports,
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=turned((1.02, 0.0), angle), normal=turned((-1.0, 0.1), angle)))
    extra = {} if friction is None else {"friction": friction}
    return sw.Scene(
        bodies={"body": solid, "wall": wall},
        contacts=(sw.Contact(between=("body.right", "wall"), timing=rule, **extra),),
        loads=(sw.Gravity(acceleration=turned((0.3, -1.0), angle)),),
        **options,
    )


def pair(angle: float, aligned: tuple[Support, ...], inclined: tuple[Support, ...], **options: object):
    """The march with supports along the axes, and that turned by the angle with supports along directions."""
    given = {key: options.pop(key) for key in ("until", "step", "method") if key in options}
    first, second = (list(march(scene(a, *s, **options), **given)) for a, s in ((0.0, aligned), (angle, inclined)))
    assert len(first) == len(second)
    return first, second


def same(first: list[Step], second: list[Step], angle: float, near: float) -> None:
    back = np.array([turned((1.0, 0.0), angle), turned((0.0, 1.0), angle)]).T
    for s, t in zip(first, second, strict=True):
        for name, size in (("displacement", 1.0), ("velocity", 10.0)):
            one, other = (getattr(step.after, name)["body"] for step in (s, t))
            np.testing.assert_allclose(other @ back, one, atol=near * size)
        np.testing.assert_allclose(t.reactions["body"] @ back, s.reactions["body"], atol=1e3 * near)
        assert t.ledger.work_external == pytest.approx(s.ledger.work_external, abs=near)
        assert t.ledger.energy_strain == pytest.approx(s.ledger.energy_strain, abs=near)
        assert abs(t.ledger.energy_error) <= 1e-12
        assert t.certificate.momentum_error <= 1e-11


METHODS = {
    "fixed point": sw.FixedPoint(tolerance=1e-13),
    "newton": sw.Newton(tolerance=1e-13),
    "matrix free": sw.FixedPoint(tolerance=1e-13, operator=MatrixFree()),
}


@pytest.mark.parametrize(
    "friction", [None, pytest.param(sw.Coulomb(mu=0.3), marks=pytest.mark.slow)], ids=["smooth", "rough"]
)
@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
def test_a_block_on_inclined_rollers_hits_a_wall(method: object, friction: object) -> None:
    """Against the problem along the axes, to rounding and the tolerance of the method."""
    aligned, inclined = Fixed(on="foot", components="y"), Fixed(on="foot", direction=turned((0.0, -2.0), ANGLE))
    first, second = pair(ANGLE, (aligned,), (inclined,), until=0.5, step=0.01, method=method, friction=friction)
    same(first, second, ANGLE, 1e-10)
    assert sum(len(s.events) for s in first) > 0
    normal = np.array(turned((0.0, 1.0), ANGLE))
    nodes = MESH.nodes("foot")
    assert max(np.abs(s.after.displacement["body"][nodes] @ normal).max() for s in second) < 1e-15
    assert [len(s.events) for s in first] == [len(s.events) for s in second]


def test_the_normal_of_the_side_is_its_direction() -> None:
    rollers = (Fixed(on="foot", direction=turned((0.0, -1.0), ANGLE)),), (Fixed(on="foot", direction="normal"),)
    first, second = (list(march(scene(ANGLE, *s), until=0.2, step=0.01)) for s in rollers)
    for s, t in zip(first, second, strict=True):
        np.testing.assert_allclose(t.after.displacement["body"], s.after.displacement["body"], atol=1e-13)


@pytest.mark.parametrize("inertia", [Full(), Off()], ids=lambda i: type(i).__name__)
def test_a_press_along_a_direction(inertia: Full | Off) -> None:
    """Held along one direction, driven along the other by a table and by a smooth law: the work is what it stores."""
    table = {"velocity": (0.0, 0.4, 0.0), "times": (0.0, 0.15, 0.4)}
    law = SmoothSteps(times=(0.0, 0.4), points=(0.0, -0.1))
    speed = (0.0, 0.0)
    along, across = turned((1.0, 0.0), ANGLE), turned((0.0, 1.0), ANGLE)
    aligned = (
        Driven(on="left", components="x", **table), Fixed(on="foot", components="y"),
        Guided(on="top", components="y", travel=law),
    )  # fmt: skip
    inclined = (
        Driven(on="left", direction=along, **table), Fixed(on="foot", direction=across),
        Guided(on="top", direction=across, travel=law),
    )  # fmt: skip
    first, second = pair(ANGLE, aligned, inclined, until=0.5, step=0.07, inertia=inertia, speed=speed)
    same(first, second, ANGLE, 1e-10)
    left, top = MESH.nodes("left"), MESH.nodes("top")
    for s in second:
        t, u = s.slab.end, s.after.displacement["body"]
        moved = 0.2 * t * t / 0.15 if t <= 0.15 else 0.08 - 0.8 * max(0.4 - t, 0.0) ** 2
        assert u[left] @ along == pytest.approx(moved, abs=1e-15)
        assert u[top] @ across == pytest.approx(value_and_rate(law.pieces, t)[0], abs=1e-15)
    assert second[-1].ledger.work_external > 0.01


def test_a_static_start_on_inclined_rollers() -> None:
    start = sw.model.StaticStart()
    aligned = (Fixed(on="foot", components="y"), Fixed(on="left", components="x"))
    inclined = (Fixed(on="foot", direction="normal"), Fixed(on="left", direction="normal"))
    first, second = pair(ANGLE, aligned, inclined, until=0.1, step=0.02, start=start, speed=(0.0, 0.0))
    same(first, second, ANGLE, 1e-10)
    with pytest.raises(InputError, match="leave free: a motion made of translation along x and translation along y"):
        next(march(scene(ANGLE, inclined[0], inertia=Off(), speed=(0.0, 0.0)), until=0.1))


def triangles(n: int, part: str) -> Mesh:
    """Unit square of squares cut along x = y, or its half below this line, with the tag ``cut`` of the line."""
    x = np.linspace(0.0, 1.0, n + 1)
    points = np.array([[a, b] for b in x for a in x])
    at = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    squares = [(i, j) for j in range(n) for i in range(n) if part == "whole" or i >= j]
    cells = [[at[j, i], at[j, i + 1], at[j + 1, i + 1]] for i, j in squares]
    cells += [[at[j, i], at[j + 1, i + 1], at[j + 1, i]] for i, j in squares if part == "whole" or i > j]
    used, numbers = np.unique(np.array(cells), return_inverse=True)
    cut = np.flatnonzero(points[used, 0] == points[used, 1])
    return Mesh(points=points[used], blocks={"tri3": numbers.reshape(-1, 3)}, tags={"cut": cut})


def test_half_a_square_with_its_symmetry_plane_at_45_degrees() -> None:
    """It moves like the half of the whole square, with half of the energy."""
    found = []
    for part in ("whole", "half"):
        mesh = triangles(4, part)
        x = mesh.points
        solid = sw.Solid(
            mesh=mesh,
            material=sw.NeoHookean(E=1.0, nu=0.3),
            density=1.0,
            velocity=np.stack(
                [0.2 * x[:, 0] * x[:, 1] + 0.1 * x[:, 1], 0.2 * x[:, 0] * x[:, 1] + 0.1 * x[:, 0]], axis=1
            ),
            supports=(Fixed(on="cut", direction=(1.0, -1.0)),) if part == "half" else (),
        )
        found.append((mesh, list(march(sw.Scene(bodies={"body": solid}), until=1.0, step=0.05))))
    (whole, first), (half, second) = found
    place = [whole.nearest(p) for p in half.points]
    for s, t in zip(first, second, strict=True):
        u = s.after.displacement["body"]
        np.testing.assert_allclose(t.after.displacement["body"], u[place], atol=1e-12)
        assert 2.0 * t.ledger.energy_strain == pytest.approx(s.ledger.energy_strain, abs=1e-13)
        assert 2.0 * t.ledger.energy_kinetic == pytest.approx(s.ledger.energy_kinetic, abs=1e-13)
        assert abs(t.ledger.energy_error) < 1e-13


def test_a_march_on_inclined_rollers_can_be_continued() -> None:
    supports = (Driven(on="left", direction=turned((1.0, 0.0), ANGLE), velocity=(0.3, 0.0), times=(0.0, 0.3)),)
    whole = list(march(scene(ANGLE, *supports), until=0.4, step=0.02))
    rest = list(march(scene(ANGLE, *supports), until=0.4, step=0.02, state=whole[6].march_state))
    for s, t in zip(whole[7:], rest, strict=True):
        assert np.array_equal(s.after.displacement["body"], t.after.displacement["body"])
        assert s.ledger.work_external == t.ledger.work_external


@pytest.mark.parametrize(
    ("options", "given"), [({"timing": Impulse()}, {}), ({"material": sw.LinearElastic(E=1.0)}, {"method": Explicit()})]
)
def test_rules_that_treat_nodes_one_by_one_refuse(options: dict[str, object], given: dict[str, object]) -> None:
    with pytest.raises(InputError) as error:
        next(march(scene(ANGLE, Fixed(on="foot", direction="normal"), **options), until=0.1, **given))
    assert error.value.where == "bodies.body.supports"
