"""A10: rod in inches and pounds, read from a scenario file, with the 20 elements and the step of the case."""

import tempfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import softway as sw
from softway.apps.verify.case import Outcome, sheet
from softway.apps.verify.scenes import bars
from softway.record.view.plots.curves import Curve, Panel

POUND_FORCE = 4.4482216152605


@cache
def march() -> bars.Record:
    """March the scenario file."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "rod.toml"
        file.write_text(_text(sheet("A10")["definition"]), encoding="utf-8")
        scenario = sw.load(file)
    return bars.recorded(sw.march(scenario.scene, until=scenario.time.end, step=scenario.time.step))


def compute() -> Outcome:
    """Compute the case; the mean force is the impulse divided by the duration of contact."""
    rod = march()
    ((start, end),) = rod.contacts(apart=1e-3)
    found = {"t_impact": start, "t_release": end, "mean contact force": rod.impulse / (end - start) / POUND_FORCE}
    level = sheet("A10")["qoi"][2]["value"]
    curves = (
        Curve(x=1e3 * rod.times, y=rod.force / POUND_FORCE, kind="steps", label="softway"),
        Curve(x=[1e3 * start, 1e3 * end], y=[level, level], kind="exact", label="rho c v A"),
    )
    return Outcome(values=found, panels=(Panel(title="Force of the wall", x="t [ms]", y="force [lbf]", curves=curves),))


def _text(d: Mapping[str, Any]) -> str:
    return f"""
        [bodies.bar]
        kind = "Solid"
        mesh = {{ kind = "Interval", length = "{d["length"]}", cells = {d["elements"]} }}
        material = {{ kind = "LinearElastic", E = "{d["youngs"]}" }}
        section = {{ kind = "Bar", area = "{d["area"]}" }}
        density = "{d["density"]}"
        velocity = "{d["speed"]}"
        [bodies.stop]
        kind = "Tool"
        shape = {{ kind = "HalfSpace", point = "10.01 in", normal = -1 }}
        [[contacts]]
        name = "stop"
        between = ["bar.right", "stop"]
        [time]
        end = "3.5 ms"
        step = "{d["step"]}"
    """
