"""The page about one slab names the calls from the march to the contact force as they are."""

import re
import sys
from pathlib import Path

import pytest

import softway as sw
from softway.solve.constraints import normal_active_set

CALL = re.compile(r"^\d+\. `(\S+\.py): (\S+)`", re.MULTILINE)


def chain() -> list[tuple[str, str]]:
    """Files and functions of softway that are on the way now, outermost first, without this module's own."""
    found, frame = [], sys._getframe(2)
    while frame is not None:
        module = frame.f_globals.get("__name__", "")
        if module.startswith("softway."):
            place = module.removeprefix("softway.").replace(".", "/") + ".py"
            found.append((place, frame.f_code.co_qualname))
        frame = frame.f_back
    return found[::-1]


def test_the_calls_are_those_of_the_page(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[list[tuple[str, str]]] = []
    solved = normal_active_set.multipliers

    def recorded(frozen, active, wanted):
        seen.append([*chain(), ("solve/constraints/normal_active_set.py", solved.__name__)])
        return solved(frozen, active, wanted)

    monkeypatch.setattr(normal_active_set, "multipliers", recorded)
    block = sw.Solid(
        mesh=sw.meshes.Rectangle(size=(1.0, 1.0), cells=(2, 2)),
        material=sw.NeoHookean(E=100.0, nu=0.3),
        density=1.0,
        place=sw.bodies.Placement(translation=(0.0, 0.01)),
        velocity=sw.bodies.Uniform(value=(0.0, -1.0)),
    )
    ball = sw.Tool(shape=sw.obstacles.Sphere(centre=(0.0, -5.0), radius=5.0))
    scene = sw.Scene(bodies={"block": block, "ball": ball}, contacts=(sw.Contact(between=("block.bottom", "ball")),))
    *_, last = sw.march(scene, until=0.06, step=0.02)
    assert last.ledger.contacts[scene.contacts[0].label].force_n > 0.0
    page = (root / "docs" / "reference" / "code" / "one_slab.md").read_text(encoding="utf-8")
    assert seen[-1] == CALL.findall(page)
