"""Deformable solids and rigid tools: their description, discretisation and internal forces."""

from softway.bodies.bulk_viscosity import BulkViscosity as BulkViscosity
from softway.bodies.conductor import RigidThermal as RigidThermal
from softway.bodies.conductor import Thermal as Thermal
from softway.bodies.elements.section import Axisymmetric as Axisymmetric
from softway.bodies.elements.section import Bar as Bar
from softway.bodies.elements.section import PlaneStrain as PlaneStrain
from softway.bodies.elements.section import PlaneStress as PlaneStress
from softway.bodies.elements.section import Volume as Volume
from softway.bodies.inertia.inertia_scaling import Full as Full
from softway.bodies.inertia.inertia_scaling import Off as Off
from softway.bodies.inertia.inertia_scaling import Scaled as Scaled
from softway.bodies.inertia.mass_matrix import Consistent as Consistent
from softway.bodies.inertia.mass_matrix import Lumped as Lumped
from softway.bodies.internal_force.slab_average import AverageField as AverageField
from softway.bodies.internal_force.slab_average import DiscreteGradient as DiscreteGradient
from softway.bodies.internal_force.slab_average import EnergyMomentum as EnergyMomentum
from softway.bodies.internal_force.slab_average import Weighted as Weighted
from softway.bodies.prescribed_motion import Sliding as Sliding
from softway.bodies.prescribed_motion import Still as Still
from softway.bodies.prescribed_motion import Swinging as Swinging
from softway.bodies.prescribed_motion import Table as Table
from softway.bodies.prescribed_motion import Translation as Translation
from softway.bodies.prescribed_motion import Turning as Turning
from softway.bodies.setup.amplitude import Ramp as Ramp
from softway.bodies.setup.initial_fields import Affine as Affine
from softway.bodies.setup.initial_fields import FieldSum as FieldSum
from softway.bodies.setup.initial_fields import OnTag as OnTag
from softway.bodies.setup.initial_fields import Profile as Profile
from softway.bodies.setup.initial_fields import Uniform as Uniform
from softway.bodies.setup.loads import Gravity as Gravity
from softway.bodies.setup.loads import Traction as Traction
from softway.bodies.setup.motion_laws import Haversine as Haversine
from softway.bodies.setup.motion_laws import RatePolyline as RatePolyline
from softway.bodies.setup.motion_laws import Sine as Sine
from softway.bodies.setup.motion_laws import SmoothSteps as SmoothSteps
from softway.bodies.setup.motion_laws import Spline as Spline
from softway.bodies.setup.placement import Mirror as Mirror
from softway.bodies.setup.placement import Placement as Placement
from softway.bodies.setup.placement import Rotation as Rotation
from softway.bodies.solid import Carried as Carried
from softway.bodies.solid import Driven as Driven
from softway.bodies.solid import Fixed as Fixed
from softway.bodies.solid import Guided as Guided
from softway.bodies.solid import Solid as Solid
from softway.bodies.solid import Tool as Tool
from softway.bodies.solid import placed_together as placed_together

__all__ = [
    "Affine",
    "AverageField",
    "Axisymmetric",
    "Bar",
    "BulkViscosity",
    "Carried",
    "Consistent",
    "DiscreteGradient",
    "Driven",
    "EnergyMomentum",
    "FieldSum",
    "Fixed",
    "Full",
    "Gravity",
    "Guided",
    "Haversine",
    "Lumped",
    "Mirror",
    "Off",
    "OnTag",
    "Placement",
    "PlaneStrain",
    "PlaneStress",
    "Profile",
    "Ramp",
    "RatePolyline",
    "RigidThermal",
    "Rotation",
    "Scaled",
    "Sine",
    "Sliding",
    "SmoothSteps",
    "Solid",
    "Spline",
    "Still",
    "Swinging",
    "Table",
    "Thermal",
    "Tool",
    "Traction",
    "Translation",
    "Turning",
    "Uniform",
    "Volume",
    "Weighted",
    "placed_together",
]
