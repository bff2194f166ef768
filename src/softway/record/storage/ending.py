"""End of a run: why it stopped, whatever ended it, and failures to write as errors that name the folder."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from softway.errors import Cancelled, NumericsError, StorageError
from softway.record.storage.provenance import CANCELLED, DONE, INTERRUPTED, Stop


@contextmanager
def ending(finish: Callable[[Stop], None]) -> Iterator[None]:
    """Call ``finish`` with the reason of the stop after the work inside, however it ends; exceptions propagate."""
    stop = Stop("failed", "unexpected error")
    try:
        yield
        stop = DONE
    except KeyboardInterrupt:
        stop = INTERRUPTED
        raise
    except Cancelled:
        stop = CANCELLED
        raise
    except (NumericsError, StorageError) as error:
        stop = Stop("failed", str(error))
        raise
    except Exception as error:  # from the progress callback, or a defect: it propagates unchanged
        if _of_interruption(error):
            stop = INTERRUPTED
            raise KeyboardInterrupt from error
        stop = Stop("failed", f"{type(error).__name__}: {error}")
        raise
    finally:
        finish(stop)


def _of_interruption(error: BaseException | None) -> bool:
    """True if an exception was raised while an interruption went up, as the clean-up of a library may do."""
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__context__
    return error is not None


@contextmanager
def recording(place: Path | None) -> Iterator[None]:
    """Turn an OSError into a StorageError that names the folder and the way to resume the run."""
    name = str(place or "temporary folder")
    try:
        yield
    except OSError as error:
        problem = f"cannot be written: {error.strerror or error}"
        remedy = f"free some disk space, then softway resume {name}"
        raise StorageError(name, problem, remedy) from error
