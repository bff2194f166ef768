"""Mechanisms: rigid bodies with joints, springs and torques, and their march."""

from softway.bodies.setup.motion_laws import RatePolyline as RatePolyline
from softway.bodies.setup.motion_laws import Sine as Sine
from softway.mechanisms.arrays import MechanismState as MechanismState
from softway.mechanisms.march import march as march
from softway.mechanisms.members.couplings import Gear as Gear
from softway.mechanisms.members.couplings import HeatLink as HeatLink
from softway.mechanisms.members.joints import BallJoint as BallJoint
from softway.mechanisms.members.joints import Cylindrical as Cylindrical
from softway.mechanisms.members.joints import Hinge as Hinge
from softway.mechanisms.members.joints import PinSlot as PinSlot
from softway.mechanisms.members.joints import Rod as Rod
from softway.mechanisms.members.joints import Screw as Screw
from softway.mechanisms.members.joints import Slider as Slider
from softway.mechanisms.members.joints import Universal as Universal
from softway.mechanisms.members.joints import Weld as Weld
from softway.mechanisms.members.mechanism import Mechanism as Mechanism
from softway.mechanisms.members.motors import Motor as Motor
from softway.mechanisms.members.motors import Polyline as Polyline
from softway.mechanisms.members.motors import Steady as Steady
from softway.mechanisms.members.rigid import Rigid as Rigid
from softway.mechanisms.members.solids import rigid_ball as rigid_ball
from softway.mechanisms.members.solids import rigid_box as rigid_box
from softway.mechanisms.members.solids import rigid_cylinder as rigid_cylinder
from softway.mechanisms.members.solids import rigid_disc as rigid_disc
from softway.mechanisms.members.solids import rigid_rectangle as rigid_rectangle
from softway.mechanisms.members.solids import rigid_rod as rigid_rod
from softway.mechanisms.members.springs import HingeTorque as HingeTorque
from softway.mechanisms.members.springs import PointForce as PointForce
from softway.mechanisms.members.springs import Spring as Spring
from softway.mechanisms.members.springs import Torque as Torque
from softway.mechanisms.members.springs import TorsionSpring as TorsionSpring
from softway.mechanisms.members.stops import AngleStop as AngleStop
from softway.mechanisms.members.stops import DistanceStop as DistanceStop
from softway.mechanisms.members.stops import PlaneStop as PlaneStop
from softway.mechanisms.members.stops import StopEvent as StopEvent
from softway.mechanisms.members.volumes import rigid_file as rigid_file
from softway.mechanisms.members.volumes import rigid_mesh as rigid_mesh
from softway.mechanisms.members.volumes import rigid_surface as rigid_surface
from softway.mechanisms.robots.robot_file import RobotFile as RobotFile
from softway.mechanisms.robots.robot_file import read_robot as read_robot
from softway.mechanisms.step import BodyState as BodyState
from softway.mechanisms.step import MechanismStep as MechanismStep

__all__ = [
    "AngleStop",
    "BallJoint",
    "BodyState",
    "Cylindrical",
    "DistanceStop",
    "Gear",
    "HeatLink",
    "Hinge",
    "HingeTorque",
    "Mechanism",
    "MechanismState",
    "MechanismStep",
    "Motor",
    "PinSlot",
    "PlaneStop",
    "PointForce",
    "Polyline",
    "RatePolyline",
    "Rigid",
    "RobotFile",
    "Rod",
    "Screw",
    "Sine",
    "Slider",
    "Spring",
    "Steady",
    "StopEvent",
    "Torque",
    "TorsionSpring",
    "Universal",
    "Weld",
    "march",
    "read_robot",
    "rigid_ball",
    "rigid_box",
    "rigid_cylinder",
    "rigid_disc",
    "rigid_file",
    "rigid_mesh",
    "rigid_rectangle",
    "rigid_rod",
    "rigid_surface",
]
