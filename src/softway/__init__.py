"""softway: dynamic contact of solids, with the velocity as unknown and contact as a constraint on it."""

import logging

from softway.bodies.amplitude import Ramp
from softway.bodies.fields import Affine, FieldSum, OnTag, Profile, Uniform
from softway.bodies.force import AverageField, DiscreteGradient, EnergyMomentum, Weighted
from softway.bodies.inertia import Full, Off, Scaled
from softway.bodies.loads import Gravity, Traction
from softway.bodies.mass import Consistent, Lumped
from softway.bodies.motion import Still, Table, Translation, Turning
from softway.bodies.placement import Placement, Rotation
from softway.bodies.section import Axisymmetric, Bar, PlaneStrain, PlaneStress, Volume
from softway.bodies.shock import BulkViscosity
from softway.bodies.solid import Driven, Fixed, Solid, Tool
from softway.contact.contact import Contact, DualMortar, NodeToSurface
from softway.contact.timing import Energy, Impulse, Paper
from softway.errors import Cancelled, InputError, NumericsError, SoftwayError, StorageError
from softway.execute import resume, run
from softway.laws.bulk import (
    J2,
    Hencky,
    Hypoelastic,
    Kelvin,
    LinearElastic,
    LinearOrthotropic,
    Maxwell,
    MooneyRivlin,
    NeoHookean,
    NortonHoff,
    StVenantKirchhoff,
)
from softway.laws.flow import JohnsonCook, NortonFlow, Perzyna, RateIndependent
from softway.laws.friction import (
    Coulomb,
    Frictionless,
    LimitedViscoplastic,
    Lubricated,
    StaticKinetic,
    Stribeck,
    Tresca,
)
from softway.laws.friction import NortonHoff as NortonHoffFriction
from softway.laws.hardening import LinearHardening, PowerHardening, Voce
from softway.laws.rates import GreenNaghdi, Jaumann, Logarithmic, Truesdell
from softway.march.control import StepControl
from softway.march.march import march
from softway.march.standing import Standing
from softway.march.step import Certificate, Event, Ledger, Step
from softway.model import build
from softway.record.checkpoint import Checkpoints
from softway.record.progress import Progress
from softway.record.run import Run
from softway.scenario.codec import load, resolved
from softway.scenario.scenario import Output, Probe, Scenario, Time
from softway.scene import AsGiven, Scene, State, StaticStart
from softway.solve.explicit import Explicit
from softway.solve.fixed_point import FixedPoint
from softway.solve.newton import Newton
from softway.solve.operators import Factored, MatrixFree, Multigrid
from softway.space.curved import Block, Cavity, Roller, Sphere, Torus
from softway.space.curved import Cylinder as RigidCylinder
from softway.space.distance import SignedDistance
from softway.space.faceted import Facets, Surface
from softway.space.mesh import Mesh
from softway.space.obstacles import HalfSpace
from softway.space.sources import Ball, Box, Cylinder, Disc, Interval, MeshFile, Rectangle
from softway.study import Sweep, sweep
from softway.time.weight import Collocation, EndPeaks, Momentum

logging.getLogger(__name__).addHandler(logging.NullHandler())

__all__ = [
    "J2",
    "Affine",
    "AsGiven",
    "AverageField",
    "Axisymmetric",
    "Ball",
    "Bar",
    "Block",
    "Box",
    "BulkViscosity",
    "Cancelled",
    "Cavity",
    "Certificate",
    "Checkpoints",
    "Collocation",
    "Consistent",
    "Contact",
    "Coulomb",
    "Cylinder",
    "Disc",
    "DiscreteGradient",
    "Driven",
    "DualMortar",
    "EndPeaks",
    "Energy",
    "EnergyMomentum",
    "Event",
    "Explicit",
    "Facets",
    "Factored",
    "FieldSum",
    "Fixed",
    "FixedPoint",
    "Frictionless",
    "Full",
    "Gravity",
    "GreenNaghdi",
    "HalfSpace",
    "Hencky",
    "Hypoelastic",
    "Impulse",
    "InputError",
    "Interval",
    "Jaumann",
    "JohnsonCook",
    "Kelvin",
    "Ledger",
    "LimitedViscoplastic",
    "LinearElastic",
    "LinearHardening",
    "LinearOrthotropic",
    "Logarithmic",
    "Lubricated",
    "Lumped",
    "MatrixFree",
    "Maxwell",
    "Mesh",
    "MeshFile",
    "Momentum",
    "MooneyRivlin",
    "Multigrid",
    "NeoHookean",
    "Newton",
    "NodeToSurface",
    "NortonFlow",
    "NortonHoff",
    "NortonHoffFriction",
    "NumericsError",
    "Off",
    "OnTag",
    "Output",
    "Paper",
    "Perzyna",
    "Placement",
    "PlaneStrain",
    "PlaneStress",
    "PowerHardening",
    "Probe",
    "Profile",
    "Progress",
    "Ramp",
    "RateIndependent",
    "Rectangle",
    "RigidCylinder",
    "Roller",
    "Rotation",
    "Run",
    "Scaled",
    "Scenario",
    "Scene",
    "SignedDistance",
    "SoftwayError",
    "Solid",
    "Sphere",
    "StVenantKirchhoff",
    "Standing",
    "State",
    "StaticKinetic",
    "StaticStart",
    "Step",
    "StepControl",
    "Still",
    "StorageError",
    "Stribeck",
    "Surface",
    "Sweep",
    "Table",
    "Time",
    "Tool",
    "Torus",
    "Traction",
    "Translation",
    "Tresca",
    "Truesdell",
    "Turning",
    "Uniform",
    "Voce",
    "Volume",
    "Weighted",
    "build",
    "load",
    "march",
    "resolved",
    "resume",
    "run",
    "sweep",
]
