"""Layout of the page: the window with its colours, the time below it, curves and events beside it."""

from typing import Any

from trame.ui.vuetify3 import VAppLayout
from trame.widgets import client, html, vtk
from trame.widgets import vuetify3 as v3

PLACE = "(100 * (c.low + (c.high - c.low) * (now - c.begin) / (c.end - c.begin || 1)))"
"""Position of the current time in a drawing ``c`` [%]."""
RULES = """
.page { display: flex; flex-direction: column; height: 100dvh; outline: none }
.page .head { display: flex; align-items: center; gap: 6px 16px; padding: 10px 16px 6px; border-bottom: 1px solid #ddd }
.page .middle { display: flex; flex: 1; min-height: 0 }
.page .window { flex: 1; min-width: 0; min-height: 0; position: relative }
.page .beside { width: 430px; border-left: 1px solid #ddd; display: flex; flex-direction: column; min-height: 0 }
.page .scale { position: absolute; left: 16px; bottom: 10px; width: min(300px, 100% - 32px); background: #fffc }
@media (min-width: 1800px) { .page .beside { width: 600px } }
@media (max-width: 800px) {
  .page .head { flex-wrap: wrap }
  .page .middle { flex-direction: column }
  .page .window { flex: 1 1 45% }
  .page .beside { width: auto; flex: 1 1 55%; border-left: none; border-top: 1px solid #ddd }
}
"""
"""Style sheet; narrow windows show the curves below the bodies."""
_APART = "['slider', 'tab', 'combobox', 'option'].includes($event.target.getAttribute('role'))"
KEYS = (
    f"{_APART} || $event.target.tagName === 'INPUT' ? 0"
    " : $event.key === 'ArrowRight' ? (frame = Math.min(frame + 1, last))"
    " : $event.key === 'ArrowLeft' ? (frame = Math.max(frame - 1, 0))"
    " : $event.key === ' ' && $event.target.tagName !== 'BUTTON' ? (playing = !playing) : 0"
)
"""Key bindings where no part of the page uses the keys itself: one frame forward or back, play."""


def lay_out(page: Any) -> None:
    """Build the page in its server."""
    with VAppLayout(page.server) as layout:
        layout.root.style = "height:100vh; overflow:hidden; background:white"
        client.Style(RULES)
        with html.Div(classes="page", tabindex=0, autofocus=True, keydown=KEYS):
            _head(page)
            with html.Div(classes="middle"):
                with html.Div(classes="window", id="window"):
                    view = vtk.VtkLocalView(page.solids.plotter.render_window, style="width:100%; height:100%")
                    page.server.controller.redraw = view.update
                    page.server.controller.look = view.push_camera
                    _scale()
                _beside(page)
            _time(page)


def _head(page: Any) -> None:
    """Build the header: title, state of the run, field, enlargement."""
    with html.Div(classes="head"):
        html.Div("{{ heading }}", style="font-weight:600; font-size:17px", id="heading")
        v3.VChip("{{ status }}", size="small", color=("status === 'done' ? 'green' : 'orange'",), id="status")
        html.Div("{{ findings.join('; ') }}", v_show=("findings.length",), style="color:#b3261e", id="findings")
        v3.VSpacer()
        v3.VSwitch(
            v_model=("enlarged",),
            v_show=("factor > 1",),
            label=("`deformation × ${factor}`",),
            density="compact",
            hide_details=True,
            color="primary",
        )
        v3.VBtn(icon="mdi-crop-free", title="fit view", variant="text", density="compact", click=page.reset)
        v3.VSelect(
            v_model=("colour",),
            items=("fields",),
            label="field",
            id="field",
            density="compact",
            variant="outlined",
            hide_details=True,
            style="max-width:240px",
        )


def _scale() -> None:
    """Build the colour scale over the window."""
    with html.Div(classes="scale", style="padding:4px 8px", id="scale"):
        html.Div("{{ label }}", style="font-size:13px")
        html.Div(style=("`height:12px; background:${gradient}`",))
        with html.Div(style="display:flex; justify-content:space-between; font-size:12px"):
            html.Span("{{ mark }}", v_for="(mark, i) in marks", key="i")


def _time(page: Any) -> None:
    """Build the playback buttons and the slider of the frames."""
    with html.Div(style="display:flex; align-items:center; gap:8px; padding:4px 16px; border-top:1px solid #ddd"):
        v3.VBtn(
            icon=("playing ? 'mdi-pause' : 'mdi-play'",),
            click="playing = !playing",
            variant="tonal",
            density="comfortable",
            id="play",
        )
        for icon, change in (("mdi-skip-previous", -1), ("mdi-skip-next", 1)):
            v3.VBtn(icon=icon, click=(page.step, f"[{change}]"), variant="text", density="compact")
        v3.VSlider(
            v_model_number=("frame",), min=0, max=("last",), step=1, hide_details=True, id="slider", color="primary"
        )
        html.Div("{{ clock }}", id="clock", style="min-width:96px; text-align:right; font-variant-numeric:tabular-nums")


def _beside(page: Any) -> None:
    """Build the side panel: curves, space-time diagram, events."""
    with html.Div(classes="beside"):
        with v3.VTabs(v_model=("panel",), density="compact", grow=True, style="flex:none"):
            v3.VTab("curves", value="curves")
            v3.VTab("space-time", value="world", v_if=("world",))
            v3.VTab("events ({{ events.length }})", value="events")
        with html.Div(style="flex:1; overflow:auto; min-height:0"):
            with (
                html.Div(v_if=("panel === 'curves'",)),
                html.Div(v_for="(c, i) in curves", key="i", style="position:relative"),
            ):
                share = "$event.offsetX / $event.target.clientWidth"
                _drawing(page, share)
                html.Div(style=(f"`{_LINE}; top:12%; bottom:20%; width:1px; left:${{{PLACE}}}%`",), classes="cursor")
            with (
                html.Div(v_if=("panel === 'world' && world",)),
                html.Div(v_for="c in [world]", key="c.end", style="position:relative"),
            ):
                _drawing(page, "1 - $event.offsetY / $event.target.clientHeight")
                html.Div(style=(f"`{_LINE}; left:12%; right:3%; height:1px; bottom:${{{PLACE}}}%`",), classes="cursor")
            with html.Div(v_if=("panel === 'events'",), id="events"):
                _events(page)


_LINE = "position:absolute; background:#D55E00; pointer-events:none"


def _drawing(page: Any, share: str) -> None:
    """Build a drawing; a click goes to the time at that position."""
    time = f"c.begin + ({share} - c.low) / (c.high - c.low) * (c.end - c.begin)"
    html.Img(src=("c.src",), style="width:100%; display:block; cursor:pointer", click=(page.pick, f"[{time}]"))


def _events(page: Any) -> None:
    """Build the list of contact events; a click goes to their time."""
    titles = {
        "when": "time",
        "kind": "event",
        "node": "node",
        "contact": "contact",
        "before": "v before [m/s]",
        "after": "after",
    }
    with v3.VTable(density="compact", hover=True):
        with html.Thead(), html.Tr():
            for title in titles.values():
                html.Th(title, style="padding:0 6px")
        with (
            html.Tbody(),
            html.Tr(v_for="(e, i) in events", key="i", click=(page.pick, "[e.time]"), style="cursor:pointer"),
        ):
            for key in titles:
                html.Td(f"{{{{ e.{key} }}}}", style="padding:0 6px; white-space:nowrap; font-size:12px")
