"""Data of the page apart from the 3D window, as plain values for the browser."""

import base64
from typing import Any

from softway.record.read.findings import gathered, sentences, stored
from softway.record.run import Run
from softway.record.view.bodies.bodies import Stage, instant
from softway.record.view.plots.panels import Drawing, curves, world
from softway.record.view.style import stops
from softway.record.write.events import MESH

MOST = 2000
"""Greatest number of events in the list."""


def described(stage: Stage) -> dict[str, Any]:
    """Name, label and colour scale of the shown field."""
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
    """Drawings of the curves and, if there is one, of the space-time mesh."""
    spacetime = world(run)
    return {
        "curves": [_data(drawing) for drawing in curves(run)],
        "world": None if spacetime is None else _data(spacetime),
    }


def events_of(run: Run) -> list[dict[str, Any]]:
    """Contact events (touch and release) and findings in order of time, without changes of meshes."""
    table = run.events
    rows = [row for row, kind in enumerate(table["kind"]) if kind != MESH]
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
        for row in rows[:MOST]
    ]


def findings_of(run: Run) -> list[str]:
    """Sentences on the findings of the audit so far."""
    return sentences(gathered(stored(run.events)))


def _data(drawing: Drawing) -> dict[str, Any]:
    """Drawing with its axes, as data for the browser."""
    packed = base64.b64encode(drawing.svg.encode()).decode()
    return {
        "src": f"data:image/svg+xml;base64,{packed}",
        "low": drawing.low,
        "high": drawing.high,
        "begin": drawing.begin,
        "end": drawing.end,
    }
