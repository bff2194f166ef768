"""Page of a run: its controls and their actions."""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from trame.app import asynchronous, get_server

from softway.apps.viewer.layout import lay_out
from softway.apps.viewer.shown import described, events_of, findings_of, pictures_of
from softway.apps.viewer.solids import Solids, dress, solids, stage
from softway.errors import InputError
from softway.record.run import Run
from softway.record.view.bodies.bodies import Stage, instant
from softway.record.view.bodies.colour_field import colour_of, names

PERIOD = 1.0
"""Seconds between two updates from a run that is still running."""
PACE = 1.0 / 15.0
"""Seconds between two frames during playback."""


@dataclass(frozen=True, eq=False, kw_only=True, slots=True)
class Page:
    """Page of a run, with its window, its server, and a stage for every field chosen so far."""

    run: Run
    live: bool
    server: Any
    solids: Solids
    stages: dict[str, Stage]
    tasks: list[Any] = field(default_factory=list)

    @property
    def stage(self) -> Stage:
        """Stage of the chosen field."""
        return self.stages[self.server.state.colour]

    def frame(self, frame: int, **_: object) -> None:
        """Show a frame."""
        state, count = self.server.state, len(self.run.fields)
        shown = self.run.fields[min(int(frame), count - 1)]
        self.solids.show(self.stage, shown, bool(state.enlarged))
        state.update({"now": shown.time, "clock": instant(shown.time)})
        self.server.controller.redraw()

    def colours(self, colour: str, **_: object) -> None:
        """Colour by a field."""
        if colour not in self.stages:
            self.stages[colour] = stage(self.run, colour_of(self.run, colour))
        self.solids.paint(self.stage)
        self.server.state.update(described(self.stage))
        self.frame(self.server.state.frame)

    def scale(self, **_: object) -> None:
        """Show deformations enlarged or to scale."""
        self.frame(self.server.state.frame)

    def pick(self, time: float) -> None:
        """Go to the frame closest to a time [s]."""
        times = self.run.fields.times
        self.server.state.frame = int(abs(times - float(time)).argmin())

    def step(self, change: int) -> None:
        """Go some frames forward or back."""
        state = self.server.state
        state.frame = min(max(int(state.frame) + change, 0), int(state.last))

    def reset(self) -> None:
        """Reset the camera."""
        self.solids.look(self.stage)
        self.server.controller.look()

    def play(self, playing: bool, **_: object) -> None:
        """Start playback if ``playing`` is true."""
        if playing:
            self.tasks.append(asynchronous.create_task(self._play()))

    async def _play(self) -> None:
        state = self.server.state
        while state.playing:
            with state:
                state.frame = (int(state.frame) + 1) % (int(state.last) + 1)
            await asyncio.sleep(PACE)

    async def follow(self) -> None:
        """Show new frames while the run is writing them, until it stops."""
        state = self.server.state
        while True:
            await asyncio.sleep(PERIOD)
            with suppress(InputError, OSError, ValueError):  # a file that is being written: the next update reads it
                last, reason = len(self.run.fields) - 1, self.run.status
                if last > int(state.last) or reason != state.status:
                    with state:
                        self._refresh(last, reason)
                if reason != "running":
                    return

    def _refresh(self, last: int, reason: str) -> None:
        state = self.server.state
        at_end = int(state.frame) == int(state.last)
        told = {"status": reason, "findings": findings_of(self.run)}
        state.update({"last": last, "events": events_of(self.run), **told, **pictures_of(self.run)})
        self.stages.clear()
        self.colours(state.colour)
        state.frame = last if at_end else state.frame

    def started(self, **_: object) -> None:
        """Start to follow the run if the page is live."""
        if self.live:
            self.tasks.append(asynchronous.create_task(self.follow()))


def page(run: Run, live: bool = False) -> Page:
    """Create the page of a run, without serving it."""
    server = get_server(f"softway-{id(run)}", client_type="vue3")
    first = stage(run, colour_of(run, None))
    words = described(first)
    made = Page(run=run, live=live, server=server, solids=solids(), stages={words["colour"]: first})
    state, last = server.state, len(run.fields) - 1
    state.update(
        {
            "trame__title": run.provenance.get("title", "") or "softway",
            "heading": run.provenance.get("title", "") or run.path.name,
            "fields": [{"value": name, "title": colour_of(run, name).word} for name in names(run.fields.kinds.items())],
            "frame": last if live else 0,
            "last": last,
            "enlarged": True,
            "playing": False,
            "status": run.status,
            "findings": findings_of(run),
            "panel": "curves",
            "events": events_of(run),
            **pictures_of(run),
            **words,
        }
    )
    made.solids.show(first, run.fields[int(state.frame)], True)
    dress(made.solids, first)
    made.solids.look(first)
    _listen(made)
    lay_out(made)
    made.frame(state.frame)
    return made


def _listen(made: Page) -> None:
    """Connect the controls of the page with their actions."""
    reactions: dict[str, Callable[..., None]] = {
        "frame": made.frame,
        "colour": made.colours,
        "enlarged": made.scale,
        "playing": made.play,
    }
    for name, reaction in reactions.items():
        made.server.state.change(name)(reaction)
    made.server.controller.on_server_ready.add(made.started)
