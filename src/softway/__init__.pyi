"""Names of the package, by which it loads what is used, see :mod:`softway.public_names`."""

from . import bodies as bodies
from . import contact as contact
from . import heat as heat
from . import laws as laws
from . import mechanisms as mechanisms
from . import meshes as meshes
from . import model as model
from . import obstacles as obstacles
from . import piles as piles
from . import record as record
from . import solve as solve
from . import studies as studies
from .bodies.setup.loads import Gravity as Gravity
from .bodies.setup.loads import Traction as Traction
from .bodies.solid import Carried as Carried
from .bodies.solid import Driven as Driven
from .bodies.solid import Fixed as Fixed
from .bodies.solid import Solid as Solid
from .bodies.solid import Tool as Tool
from .contact.assembly.tie import Tie as Tie
from .contact.contact import Contact as Contact
from .errors import Cancelled as Cancelled
from .errors import InputError as InputError
from .errors import NumericsError as NumericsError
from .errors import SoftwayError as SoftwayError
from .errors import StorageError as StorageError
from .heat.coupled.build import build as build
from .laws.bulk import J2 as J2
from .laws.bulk import Hypoelastic as Hypoelastic
from .laws.bulk import LinearElastic as LinearElastic
from .laws.bulk import NeoHookean as NeoHookean
from .laws.cohesive_law import BilinearCohesive as BilinearCohesive
from .laws.friction import Coulomb as Coulomb
from .marching.march import march as march
from .marching.results.step import Certificate as Certificate
from .marching.results.step import Event as Event
from .marching.results.step import Ledger as Ledger
from .marching.results.step import Step as Step
from .marching.state.march_state import MarchState as MarchState
from .marching.state.step_control import StepControl as StepControl
from .meshes.mesh import Mesh as Mesh
from .model.scene import Scene as Scene
from .model.scene import State as State
from .record.run import Run as Run
from .record.write.progress import Progress as Progress
from .scenario.checks.check import check as check
from .scenario.files import dump as dump
from .scenario.files import dumps as dumps
from .scenario.files import load as load
from .scenario.files import loads as loads
from .scenario.run import resume as resume
from .scenario.run import run as run
from .scenario.scenario import Output as Output
from .scenario.scenario import Probe as Probe
from .scenario.scenario import Scenario as Scenario
from .scenario.scenario import Time as Time
from .solve.methods.central_difference import Explicit as Explicit
from .solve.methods.fixed_point import FixedPoint as FixedPoint
from .solve.methods.newton import Newton as Newton
from .studies.sweep import sweep as sweep

__all__ = [
    "J2",
    "BilinearCohesive",
    "Cancelled",
    "Carried",
    "Certificate",
    "Contact",
    "Coulomb",
    "Driven",
    "Event",
    "Explicit",
    "Fixed",
    "FixedPoint",
    "Gravity",
    "Hypoelastic",
    "InputError",
    "Ledger",
    "LinearElastic",
    "MarchState",
    "Mesh",
    "NeoHookean",
    "Newton",
    "NumericsError",
    "Output",
    "Probe",
    "Progress",
    "Run",
    "Scenario",
    "Scene",
    "SoftwayError",
    "Solid",
    "State",
    "Step",
    "StepControl",
    "StorageError",
    "Tie",
    "Time",
    "Tool",
    "Traction",
    "build",
    "check",
    "dump",
    "dumps",
    "load",
    "loads",
    "march",
    "resume",
    "run",
    "sweep",
]
