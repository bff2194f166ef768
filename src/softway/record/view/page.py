"""Page of the run of a mechanism, a pile or conductors: a file of HTML with motion or fields, history and events."""

import io
from base64 import b64encode
from collections.abc import Callable, Sequence
from dataclasses import replace
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from softway.errors import InputError
from softway.record.read.records import Records
from softway.record.storage.table import Table
from softway.record.view.film import rigid_film
from softway.record.view.options import STANDARD
from softway.record.view.plots.history import history
from softway.record.view.style import styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FRAMES = 90
"""Maximum number of positions."""
EVENTS = 500
"""Maximum number of events in the table."""
SIZE, DPI = (1120, 630), 110
COLUMNS = {
    "time": "time [s]",
    "contact": "stop",
    "kind": "event",
    "normal_velocity_before": "velocity before [m/s]",
    "normal_velocity_after": "after [m/s]",
    "impulse": "impulse [N s]",
}
STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; color: #222; max-width: 72rem; margin: 1.5rem auto; padding: 0 1rem; }
h1 { font-size: 1.4rem; margin-bottom: .3rem; } h2 { font-size: 1.1rem; margin: 1.6rem 0 .3rem; }
img { max-width: 100%; display: block; } #bar { display: flex; gap: .8rem; align-items: center; margin: .5rem 0; }
#bar input { flex: 1; } button { font: inherit; padding: .15rem .8rem; } #now { min-width: 8rem; text-align: right; }
table { border-collapse: collapse; font-size: .88rem; } .tall { max-height: 24rem; overflow-y: auto; }
th, td { padding: .15rem .8rem; text-align: right; border-bottom: 1px solid #e4e4e4; }
thead th { position: sticky; top: 0; background: #fff; }
tbody tr { cursor: pointer; } tbody tr:hover { background: #eef; }
"""
SCRIPT = """
const frames = document.querySelectorAll('#motion img'), bar = document.querySelector('#bar input');
const times = JSON.parse(document.querySelector('#times').textContent), button = document.querySelector('#bar button');
let shown = 0, timer = null;
function show(k) {
  frames[shown].hidden = true; shown = k; frames[k].hidden = false; bar.value = k;
  document.querySelector('#now').textContent = 't = ' + times[k].toPrecision(4) + ' s';
}
function stop() { clearInterval(timer); timer = null; button.textContent = 'Play'; }
function play() {
  button.textContent = 'Stop';
  timer = setInterval(() => show((shown + 1) % frames.length), 80);
}
button.addEventListener('click', () => timer ? stop() : play());
bar.addEventListener('input', () => { stop(); show(Number(bar.value)); });
for (const row of document.querySelectorAll('tbody tr')) row.addEventListener('click', () => {
  stop(); const at = Number(row.dataset.time);
  show(times.reduce((best, time, k) => Math.abs(time - at) < Math.abs(times[best] - at) ? k : best, 0));
});
document.addEventListener('keydown', event => {
  const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  if (step && event.target !== bar) { stop(); show(Math.min(frames.length - 1, Math.max(0, shown + step))); }
});
show(0);
"""


def page(run: Records, sentences: Sequence[str], watch: Callable[[int, int], None] | None = None) -> str:
    """HTML page of the run of a mechanism, a pile or conductors, which needs no other file and no server.

    Parameters
    ----------
    run
        The run; it may still be going on.
    sentences
        What the summary tells.
    watch
        Callback with the number of finished pictures and the total number.

    Raises
    ------
    InputError
        If nothing has been recorded yet.
    """
    instants = run.times
    if not len(instants):
        raise InputError(str(run.path), "nothing has been recorded yet", "a run with recorded steps")
    rows = np.unique(np.linspace(0, len(instants) - 1, min(len(instants), FRAMES)).round().astype(int))
    title = escape(str(run.provenance.get("title", "")) or "Run")
    times = ", ".join(repr(float(instants[row])) for row in rows)
    with styled():
        look = replace(STANDARD, size=SIZE, dpi=DPI)
        figure, draw = rigid_film(run, look)
        frames = []
        for done, row in enumerate(rows):
            draw(int(row))
            frames.append(f'<img alt="positions" src="{_picture(figure)}"{"" if done == 0 else " hidden"}>')
            figure.set_layout_engine("none")
            if watch is not None:
                watch(done + 1, len(rows))
        curves = _picture(history(run, STANDARD))
    body = [
        f"<h1>{title}</h1>",
        f'<div id="motion">{"".join(frames)}</div>',
        f'<div id="bar"><button>Play</button><input type="range" min="0" max="{len(rows) - 1}" value="0" '
        'aria-label="time"><span id="now"></span></div>',
        "<ul>" + "".join(f"<li>{escape(sentence)}</li>" for sentence in sentences) + "</ul>",
        f'<h2>History</h2><img alt="history" src="{curves}">',
        _events(run.events),
        f'<script type="application/json" id="times">[{times}]</script>',
        f"<script>{SCRIPT}</script>",
    ]
    meta = '<meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
    head = f"{meta}<title>{title}</title><style>{STYLE}</style>"
    return f'<!DOCTYPE html>\n<html lang="en"><head>{head}</head><body>\n' + "\n".join(body) + "\n</body></html>\n"


def _picture(figure: "Figure") -> str:
    """Figure as an address that holds its data."""
    out = io.BytesIO()
    figure.savefig(out, format="png", dpi=DPI, facecolor="white")
    return f"data:image/png;base64,{b64encode(out.getvalue()).decode()}"


def _events(events: Table) -> str:
    """Table of the events; a click on a line shows the position then."""
    if not events.rows:
        return ""
    more = f", the first {EVENTS}" if events.rows > EVENTS else ""
    heads = "".join(f"<th>{escape(head)}</th>" for head in COLUMNS.values())
    lines = []
    for row in range(min(events.rows, EVENTS)):
        values = [events[name][row] for name in COLUMNS]
        cells = "".join(f"<td>{escape(v if isinstance(v, str) else f'{v:.6g}')}</td>" for v in values)
        lines.append(f'<tr data-time="{float(values[0])!r}">{cells}</tr>')
    table = f"<table><thead><tr>{heads}</tr></thead><tbody>{''.join(lines)}</tbody></table>"
    return f'<h2>{events.rows} events of the stops{more}</h2><div class="tall">{table}</div>'
