"""A run in a notebook: its summary as a table, and a picture."""

import base64

from softway.errors import InputError
from softway.markup import table
from softway.record.look import Look
from softway.record.run import Run
from softway.record.view import picture

SMALL = Look(dpi=75)


def shown(run: Run) -> str:
    """The table and the picture as HTML."""
    found, stop = run.summary, run.stop
    rows: dict[str, object] = {"folder": run.path, "state": f"{stop.reason} {stop.message}".strip()}
    if found["slabs"]:
        relative = found["energy_error_relative"]
        rows |= {
            "slabs": f"{found['slabs']} until {found['time_end']:.4g} s, {found['iterations']} iterations",
            "energy error": "-" if relative is None else f"{relative:.1e} of the greatest energy",
            "deepest penetration": f"{found['penetration_worst']:.2g} m",
        }
    events = run.events["kind"]
    kinds = {str(kind): int((events == kind).sum()) for kind in dict.fromkeys(events)}
    rows["events"] = ", ".join(f"{count} {kind}" for kind, count in kinds.items()) or "none"
    return table(run.provenance.get("title", "") or "Run", rows) + _picture(run)


def _picture(run: Run) -> str:
    """The picture of the bodies inside the page; nothing where it cannot be drawn."""
    try:
        data = picture(run, look=SMALL)._repr_png_() if run.history.rows > 1 and len(run.fields) else b""
    except InputError:
        return ""
    return f'<img src="data:image/png;base64,{base64.b64encode(data).decode()}">' if data else ""
