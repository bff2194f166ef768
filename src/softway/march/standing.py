"""Where a march stands between two slabs: all that the next slab asks for besides the model."""

from dataclasses import dataclass, replace
from typing import Literal

from softway.errors import InputError
from softway.march.control import StepControl
from softway.march.situation import Situation
from softway.model import Model
from softway.solve.carry import Carry
from softway.solve.explicit import Explicit
from softway.solve.fixed_point import FixedPoint
from softway.solve.newton import Newton
from softway.time.weight import TimeWeight


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """What a march was asked for, see :func:`softway.march.march.march`."""

    until: float
    step: float | Literal["auto"]
    weight: TimeWeight
    method: FixedPoint | Newton | Explicit
    control: StepControl


@dataclass(frozen=True, slots=True, kw_only=True)
class Account:
    """What the audit goes on with: energy at the start, and since then external work, dissipation and error of the
    energy balance [J].
    """

    energy_start: float
    work_external: float = 0.0
    dissipation: float = 0.0
    energy_error: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Pace:
    """Length asked for ``span`` and length proposed for the next slab [s]; whether its energy balance is ``closed``
    along the motion from the first try, and whether it follows a slab that ``halted`` where a body came to rest; how
    many rejections of late were ``endured`` in slabs far shorter than asked for.
    """

    span: float
    length: float
    closed: bool = False
    halted: bool = False
    endured: float = 0.0


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Standing:
    """Where a march stands: given to :func:`~softway.march.march.march` as its ``state``, the march goes on with the
    same bits, in this process or, stored, in another one on the same machine with the same number of threads.

    Parameters
    ----------
    settings
        What the march was asked for; one that is asked for something else begins a new pace and a new operator.
    situation
        Places, speeds, forces, pasts.
    account, pace
        What the audit and the step control go on with.
    carry
        How the operator came about.
    slabs
        Slabs accepted so far with these settings.
    """

    settings: Settings
    situation: Situation
    account: Account
    pace: Pace
    carry: Carry = Carry()
    slabs: int = 0

    def asked(self, settings: Settings, span: float) -> "Standing":
        """Where a march with other ``settings`` and its length ``span`` of a slab begins."""
        return replace(self, settings=settings, pace=Pace(span=span, length=span), carry=Carry(), slabs=0)

    def fitting(self, model: Model) -> "Standing":
        """The same, of this model.

        Raises
        ------
        InputError
            If it is that of another scene.
        """
        ours, rows = model.shape, len(model.encounters.node)
        start, closed = self.situation.start, self.situation.closed
        pasts = [m is not None for m in start.memory]
        known = len(pasts) in (0, len(model.parts))
        if start.displacement.shape != ours or len(closed) != rows or not known:
            found = f"{start.displacement.shape} nodal values and {len(closed)} contact rows"
            raise InputError("state", f"of another scene: {found}", f"one of {ours} and {rows}")
        return self
