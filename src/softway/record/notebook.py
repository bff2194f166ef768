"""Display of a run in a notebook: its summary as a table, and a picture."""

import base64
from collections.abc import Mapping
from typing import Any

from softway.errors import InputError
from softway.html_tables import table
from softway.record.read.findings import sentences
from softway.record.read.records import Records
from softway.record.view.options import PictureOptions
from softway.record.view.pictures import picture

SMALL = PictureOptions(dpi=75)


def shown(run: Records, found: Mapping[str, Any], status: str, message: str) -> str:
    """Table and picture of a run with its summary ``found``, its status and the message of its stop, as HTML."""
    rows: dict[str, object] = {"folder": run.path, "state": f"{status} {message}".strip()}
    if found["slabs"]:
        relative = found["energy_error_relative"]
        rows |= {
            "slabs": f"{found['slabs']} until {found['time_end']:.4g} s, {found['iterations']} iterations",
            "energy error": "-" if relative is None else f"{relative:.1e} of the largest energy",
        }
        if "penetration_worst" in found:
            rows["deepest penetration"] = f"{found['penetration_worst']:.2g} m"
    if found.get("mesh"):
        changed = found["mesh"]
        rows["meshes"] = f"{changed['changes']} changes, at most {changed['most_nodes']} nodes"
    if found.get("findings"):
        rows["findings"] = "\n".join(sentences(found["findings"]))
    events = run.events["kind"]
    kinds = {str(kind): int((events == kind).sum()) for kind in dict.fromkeys(events)}
    rows["events"] = ", ".join(f"{count} {kind}" for kind, count in kinds.items()) or "none"
    return table(run.provenance.get("title", "") or "Run", rows) + _picture(run)


def _picture(run: Records) -> str:
    """Picture of the bodies as an embedded image; empty if it cannot be drawn."""
    try:
        there = run.history.rows > 1 and len(run.times)
        data = picture(run, look=SMALL)._repr_png_() if there else b""
    except InputError:
        return ""
    return f'<img src="data:image/png;base64,{base64.b64encode(data).decode()}">' if data else ""
