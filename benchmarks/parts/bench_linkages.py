"""Mechanisms against Exudyn, in one run and one thread: the slider-crank of case F04, four-bar loops of case F03.

``python benchmarks/parts/bench_linkages.py [--exudyn PYTHON] [--rounds N] [--steps N]`` prints a table: steps a second
of the processor, error of the angle, and how many times as long Exudyn takes at the equal step, and with the step with
which its error is ours.  Without an interpreter that has Exudyn it prints our lines only.  Errors are those at .1 s of
the slider-crank and at 10 s of the loops, where no ``--steps`` shorten the runs.
"""

import argparse
import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from time import process_time

from softway.apps.verify.cases.mechanisms import linkages
from softway.mechanisms import Mechanism, march

PEER = Path(__file__).parents[1] / "peers" / "exudyn_linkages.py"


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A mechanism with its step [s], the steps that are timed, and a known angle of a body after a time.

    Parameters
    ----------
    name, peer
        Name, and that of the peer's script.
    mechanism, body, sign
        The mechanism, the body that turns, and the sign of its angle.
    step, steps
        Step [s] and number of steps that are timed.
    until, angle
        Time [s] and angle of the reference [rad].
    asked
        How many times as fast we should be at the equal step.
    """

    name: str
    peer: str
    mechanism: Mechanism
    body: str
    sign: float
    step: float
    steps: int
    until: float
    angle: float
    asked: float


CASES = (
    Case(
        name="slider-crank", peer="crank", mechanism=linkages.slider_crank(), body="crank", sign=1.0, step=1e-4,
        steps=40_000, until=0.1, angle=8.571639066844464, asked=4.0,
    ),
    Case(
        name="2 loops", peer="2", mechanism=linkages.four_bars(2), body="crank0", sign=-1.0, step=1e-3, steps=10_000,
        until=10.0, angle=31.75059718698085, asked=3.0,
    ),
    Case(
        name="40 loops", peer="40", mechanism=linkages.four_bars(40), body="crank0", sign=-1.0, step=2e-3, steps=5_000,
        until=10.0, angle=31.597433743982613, asked=4.0,
    ),
)  # fmt: skip


def ours(case: Case, rounds: int, steps: int) -> tuple[float, float]:
    """Steps a second, the best of some rounds, and the error of the angle [rad]."""
    list(march(case.mechanism, until=10 * case.step, step=case.step))
    rates = []
    for _ in range(rounds):
        start = process_time()
        list(march(case.mechanism, until=steps * case.step, step=case.step, every=steps))
        rates.append(steps / (process_time() - start))
    seen = march(case.mechanism, until=case.until, step=case.step, every=10)
    *_, (_, angle) = linkages.angles(seen, case.body)
    return max(rates), abs(case.sign * angle - case.angle)


def peer(interpreter: str, case: Case, step: float, steps: int) -> dict[str, float]:
    """The time that Exudyn takes [s], and the angle after it."""
    command = [interpreter, str(PEER), case.peer, repr(step), str(steps)]
    variables = os.environ | {"OMP_NUM_THREADS": "1"}
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=variables)
    return dict(json.loads(done.stdout.strip().splitlines()[-1]))


def theirs(interpreter: str, case: Case, step: float, rounds: int, steps: int) -> tuple[float, float]:
    """Steps a second, the best of some rounds, and the error of the angle [rad]."""
    rate = max(steps / peer(interpreter, case, step, steps)["used"] for _ in range(rounds))
    reached = peer(interpreter, case, step, round(case.until / step))["angle"]
    return rate, abs(case.sign * reached - case.angle)


def installed(interpreter: str) -> bool:
    """Whether an interpreter has Exudyn."""
    try:
        return subprocess.run([interpreter, "-c", "import exudyn"], capture_output=True).returncode == 0
    except OSError:
        return False


def compared(interpreter: str, case: Case, rate: float, error: float, rounds: int, steps: int) -> None:
    """Print the lines of Exudyn."""
    other, missed = theirs(interpreter, case, case.step, rounds, steps)
    print(
        f"{'Exudyn':>24} {case.step:9.2e} {other:10.0f} {missed:9.1e}   {rate / other:5.1f} times as long, "
        f"asked {case.asked:g}", flush=True,
    )  # fmt: skip
    finer = case.until / round(case.until / (case.step * (error / missed) ** 0.5))
    other, missed = theirs(interpreter, case, finer, 1, steps)
    longer = rate * case.step / (other * finer)
    print(
        f"{'Exudyn, equal error':>24} {finer:9.2e} {other:10.0f} {missed:9.1e}   {longer:5.1f} times as long",
        flush=True,
    )


def main() -> None:
    """Print the table."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--exudyn", default=sys.executable, help="interpreter that has Exudyn")
    options.add_argument("--rounds", type=int, default=3)
    options.add_argument("--steps", type=int, help="steps that are timed")
    chosen = options.parse_args()
    there = installed(chosen.exudyn)
    print(f"{'':24} {'step s':>9} {'steps/s':>10} {'error':>9}")
    for case in CASES:
        steps = chosen.steps or case.steps
        rate, error = ours(case, chosen.rounds, steps)
        print(f"{case.name + ', softway':>24} {case.step:9.2e} {rate:10.0f} {error:9.1e}", flush=True)
        if there:
            compared(chosen.exudyn, case, rate, error, chosen.rounds, steps)
    if not there:
        print("Exudyn is not installed: --exudyn names an interpreter that has it")


if __name__ == "__main__":
    main()
