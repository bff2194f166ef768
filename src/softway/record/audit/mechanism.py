"""Audit of the rigid bodies of a run: joints, gaps and energies computed again from their motion and description.

Nothing of the march is used: every joint and stop is looked at by what its kind means.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from softway.errors import InputError
from softway.mechanisms.members.mechanism import Mechanism
from softway.mechanisms.members.stops import AngleStop
from softway.record.audit.joint_errors import gap_of, open_by, opening_rates
from softway.record.audit.mechanism_energy import balance_errors
from softway.record.audit.placed_bodies import PlacedBodies
from softway.record.read.body_motion import body_motions
from softway.record.read.records import Records

LIMIT = 1e-9
"""Error relative to the size of the mechanism, or to the energies, beyond which it is a finding."""
SLOW = 1e-8
"""Rate of an error, a difference, relative to the greatest speed, beyond which it is a finding."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MechanismAudit:
    """What the audit of the rigid bodies of a run found.

    Parameters
    ----------
    instants
        Number of stored instants.
    joints, rates
        Greatest error of each joint: of places [m], and of directions times the size of the mechanism; and its greatest
        rate by the velocities [m/s].
    overlaps
        Deepest overlap of each stop [m], zero where none is negative.
    balances
        Greatest errors of the energies, of their balance, of momentum and of spin in ``history.csv``, relative to the
        greatest of each.
    size, speed
        Size of the mechanism and its ways [m], and greatest speed of a point of it [m/s].
    left_out
        What was not looked at.
    """

    instants: int
    joints: Mapping[str, float]
    rates: Mapping[str, float]
    overlaps: Mapping[str, float]
    balances: Mapping[str, float]
    size: float
    speed: float
    left_out: tuple[str, ...]

    @property
    def findings(self) -> tuple[str, ...]:
        """Sentences on errors beyond rounding."""
        found = [
            f"the joint '{name}' is open by {error:.3g} m"
            for name, error in self.joints.items()
            if not error <= LIMIT * self.size
        ]
        found += [
            f"the velocities open the joint '{name}' by {rate:.3g} m/s"
            for name, rate in self.rates.items()
            if not rate <= SLOW * self.speed
        ]
        found += [
            f"the stop '{name}' is overlapped by {depth:.3g} m"
            for name, depth in self.overlaps.items()
            if not depth <= LIMIT * self.size
        ]
        found += [
            f"{name} in history.csv: error of {error:.3g} against the motion, relative to the greatest"
            for name, error in self.balances.items()
            if not error <= LIMIT
        ]
        return tuple(found)


def audited_mechanism(run: Records, mechanism: Mechanism) -> MechanismAudit:
    """Audit the run of a mechanism.

    Parameters
    ----------
    run
        The run.
    mechanism
        The mechanism that its scenario describes.

    Raises
    ------
    InputError
        If a table of the run is missing, damaged or empty.
    """
    if not (run.motion.rows and run.history.rows):
        raise InputError(str(run.path), "holds no instant yet", "a run that has started to move")
    placed = PlacedBodies(mechanism=mechanism, motions=body_motions(run))
    return looked_at(placed, *balance_errors(run, placed))


def looked_at(placed: PlacedBodies, balances: Mapping[str, float], lacking: tuple[str, ...]) -> MechanismAudit:
    """Audit of joints and stops, with the errors of the ``balances`` and what is ``lacking`` of them."""
    mechanism = placed.mechanism
    angular = [f"the stop '{name}'" for name, stop in mechanism.stops.items() if isinstance(stop, AngleStop)]
    driven = [f"the gear '{name}'" for name in mechanism.gears] + [f"the motor '{name}'" for name in mechanism.motors]
    return MechanismAudit(
        instants=placed.instants,
        joints={name: open_by(placed, joint) for name, joint in mechanism.joints.items()},
        rates=opening_rates(placed),
        overlaps={
            name: float(max(0.0, -gap_of(placed, stop).min()))
            for name, stop in mechanism.stops.items()
            if not isinstance(stop, AngleStop)
        },
        balances=balances,
        size=placed.size,
        speed=placed.speed,
        left_out=(*angular, *driven, *lacking),
    )
