"""What the page shows beside the window, as plain data for the browser."""

import base64
from typing import Any

from softway.record.run import Run
from softway.record.view_body import Stage, instant
from softway.record.view_drawing import Drawing, curves, world
from softway.record.view_style import stops

MOST = 2000
"""Greatest number of events in the list."""


def described(stage: Stage) -> dict[str, Any]:
    """The field and its colours in words."""
    factor, label = stage.colour.label(stage.range.scale)
    low, high = factor * stage.range.low, factor * stage.range.high
    name = f"{stage.colour.name}.{stage.colour.part}" if stage.colour.part else stage.colour.name
    return {
        "colour": name,
        "label": label,
        "marks": [f"{low + share * (high - low):.3g}" for share in (0.0, 0.25, 0.5, 0.75, 1.0)],
        "gradient": f"linear-gradient(to right, {', '.join(stops(stage.range.map))})",
        "factor": stage.factor,
    }


def pictures_of(run: Run) -> dict[str, Any]:
    """The curves, and the mesh of space-time where there is one."""
    spacetime = world(run)
    return {
        "curves": [_data(drawing) for drawing in curves(run)],
        "world": None if spacetime is None else _data(spacetime),
    }


def events_of(run: Run) -> list[dict[str, Any]]:
    """Touches and releases in order of time."""
    table = run.events
    return [
        {
            "time": float(table["time"][row]),
            "when": instant(float(table["time"][row])),
            "kind": str(table["kind"][row]),
            "contact": str(table["contact"][row]),
            "node": int(table["node"][row]),
            "before": f"{table['normal_velocity_before'][row]:.4g}",
            "after": f"{table['normal_velocity_after'][row]:.4g}",
        }
        for row in range(min(len(table["time"]), MOST))
    ]


def _data(drawing: Drawing) -> dict[str, Any]:
    """A drawing with its axes, as a browser takes it."""
    packed = base64.b64encode(drawing.svg.encode()).decode()
    return {
        "src": f"data:image/svg+xml;base64,{packed}",
        "low": drawing.low,
        "high": drawing.high,
        "begin": drawing.begin,
        "end": drawing.end,
    }
