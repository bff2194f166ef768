"""Workers that are told to end while they are in a finaliser."""

import signal
import time
import weakref

import pytest

from softway.studies.processes import Complaint, answers


class Thing:
    """What a weak reference may point to."""


def _interrupted(seconds: float) -> str:
    """Lose an interruption in the callback of a weak reference, and go on for some seconds."""
    thing = Thing()
    reference = weakref.ref(thing, lambda _: signal.default_int_handler(signal.SIGTERM, None))
    del thing
    assert reference() is None
    time.sleep(seconds)
    return "went on"


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timers that interrupt")
def test_an_interruption_that_a_finaliser_swallows_comes_again(capfd):
    ((_, told, _),) = answers([20.0], _interrupted, 1)
    assert isinstance(told, Complaint), "or else it went on to its end"
    assert "Traceback" not in capfd.readouterr().err


@pytest.mark.slow
def test_workers_that_are_done_end_quietly(capfd):
    assert sorted(answer for _, answer, _ in answers(["a", "bb"], len, 2)) == [1, 2]
    assert not capfd.readouterr().err
