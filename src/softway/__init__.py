"""softway: dynamic contact of solids, with the velocity as unknown and contact as a constraint on it.

Names that nearly every program needs are here.  The others are one dot deeper: ``softway.bodies``, ``contact``,
``heat``, ``laws``, ``mechanisms``, ``meshes``, ``model``, ``obstacles``, ``piles``, ``record``, ``solve`` and
``studies``.
"""

import logging
from typing import TYPE_CHECKING

from softway import bodies as bodies
from softway import contact as contact
from softway import heat as heat
from softway import laws as laws
from softway import mechanisms as mechanisms
from softway import meshes as meshes
from softway import model as model
from softway import obstacles as obstacles
from softway import piles as piles
from softway import record as record
from softway import solve as solve
from softway import studies as studies
from softway.bodies.setup.loads import Gravity, Traction
from softway.bodies.solid import Carried, Driven, Fixed, Solid, Tool
from softway.contact.assembly.tie import Tie
from softway.contact.contact import Contact
from softway.errors import Cancelled, InputError, NumericsError, SoftwayError, StorageError
from softway.heat.coupled.build import build
from softway.laws.bulk import J2, Hypoelastic, LinearElastic, NeoHookean
from softway.laws.cohesive_law import BilinearCohesive
from softway.laws.friction import Coulomb
from softway.marching.march import march
from softway.marching.results.step import Certificate, Event, Ledger, Step
from softway.marching.state.march_state import MarchState
from softway.marching.state.step_control import StepControl
from softway.meshes.mesh import Mesh
from softway.model.scene import Scene, State
from softway.record.run import Run
from softway.record.write.progress import Progress
from softway.scenario.checks.check import check
from softway.scenario.files import dump, dumps, load, loads
from softway.scenario.run import resume, run
from softway.scenario.scenario import Output, Probe, Scenario, Time
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.newton import Newton
from softway.studies.sweep import sweep

if not TYPE_CHECKING:  # type checkers refuse names that are not here by themselves
    from softway.public_names import missing as __getattr__  # noqa: F401

logging.getLogger(__name__).addHandler(logging.NullHandler())


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
