"""Mechanisms: rigid bodies with joints, springs and torques, and their march."""

from softway.mechanisms.joints import BallJoint as BallJoint
from softway.mechanisms.joints import Cylindrical as Cylindrical
from softway.mechanisms.joints import Hinge as Hinge
from softway.mechanisms.joints import PinSlot as PinSlot
from softway.mechanisms.joints import Rod as Rod
from softway.mechanisms.joints import Slider as Slider
from softway.mechanisms.joints import Universal as Universal
from softway.mechanisms.joints import Weld as Weld
from softway.mechanisms.march import BodyState as BodyState
from softway.mechanisms.march import MechanismStep as MechanismStep
from softway.mechanisms.march import march as march
from softway.mechanisms.mechanism import Mechanism as Mechanism
from softway.mechanisms.rigid import Rigid as Rigid
from softway.mechanisms.springs import Spring as Spring
from softway.mechanisms.springs import Torque as Torque
from softway.mechanisms.stops import DistanceStop as DistanceStop
from softway.mechanisms.stops import PlaneStop as PlaneStop
from softway.mechanisms.stops import StopEvent as StopEvent

__all__ = [
    "BallJoint",
    "BodyState",
    "Cylindrical",
    "DistanceStop",
    "Hinge",
    "Mechanism",
    "MechanismStep",
    "PinSlot",
    "PlaneStop",
    "Rigid",
    "Rod",
    "Slider",
    "Spring",
    "StopEvent",
    "Torque",
    "Universal",
    "Weld",
    "march",
]
