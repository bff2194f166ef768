"""The page of a run: what can be chosen on it, and what happens then."""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from trame.app import asynchronous, get_server

from softway.errors import InputError
from softway.page.layout import lay_out
from softway.page.shown import described, events_of, pictures_of
from softway.page.solids import Solids, dress, solids, stage
from softway.record.run import Run
from softway.record.view_body import Stage, instant
from softway.record.view_field import colour_of, names

PERIOD = 1.0
"""Seconds between two looks at a run that goes on."""
PACE = 1.0 / 15.0
"""Seconds between two frames that are played."""


@dataclass(frozen=True, eq=False, kw_only=True, slots=True)
class Page:
    """A run, its window, the server that talks to the browser, and the stage of every field that has been chosen."""

    run: Run
    live: bool
    server: Any
    solids: Solids
    stages: dict[str, Stage]
    tasks: list[Any] = field(default_factory=list)

    @property
    def stage(self) -> Stage:
        """That of the chosen field."""
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
        """Enlarge deformations, or do not."""
        self.frame(self.server.state.frame)

    def pick(self, time: float) -> None:
        """Go to the frame next to a time [s]."""
        times = self.run.fields.times
        self.server.state.frame = int(abs(times - float(time)).argmin())

    def step(self, change: int) -> None:
        """Go some frames on or back."""
        state = self.server.state
        state.frame = min(max(int(state.frame) + change, 0), int(state.last))

    def reset(self) -> None:
        """Put the eye back."""
        self.solids.look(self.stage)
        self.server.controller.look()

    def play(self, playing: bool, **_: object) -> None:
        """Start to play when asked to."""
        if playing:
            self.tasks.append(asynchronous.create_task(self._play()))

    async def _play(self) -> None:
        state = self.server.state
        while state.playing:
            with state:
                state.frame = (int(state.frame) + 1) % (int(state.last) + 1)
            await asyncio.sleep(PACE)

    async def follow(self) -> None:
        """Take up frames as a run writes them, until it has stopped."""
        state = self.server.state
        while True:
            await asyncio.sleep(PERIOD)
            with suppress(InputError, OSError, ValueError):  # a file that is being written: the next look finds it
                last, reason = len(self.run.fields) - 1, self.run.stop.reason
                if last > int(state.last) or reason != state.status:
                    with state:
                        self._refresh(last, reason)
                if reason != "running":
                    return

    def _refresh(self, last: int, reason: str) -> None:
        state = self.server.state
        at_end = int(state.frame) == int(state.last)
        state.update({"last": last, "status": reason, "events": events_of(self.run), **pictures_of(self.run)})
        self.stages.clear()
        self.colours(state.colour)
        state.frame = last if at_end else state.frame

    def started(self, **_: object) -> None:
        """Begin to follow a run that goes on."""
        if self.live:
            self.tasks.append(asynchronous.create_task(self.follow()))


def page(run: Run, live: bool = False) -> Page:
    """The page of a run, not yet served."""
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
            "status": run.stop.reason,
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
    """What follows a change of each choice."""
    reactions: dict[str, Callable[..., None]] = {
        "frame": made.frame,
        "colour": made.colours,
        "enlarged": made.scale,
        "playing": made.play,
    }
    for name, reaction in reactions.items():
        made.server.state.change(name)(reaction)
    made.server.controller.on_server_ready.add(made.started)
