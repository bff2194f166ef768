"""Heat conduction: conductors, their laws and boundary conditions, and the march of their temperatures."""

from softway.bodies.conductor import Conductor as Conductor
from softway.bodies.setup.heat_loads import Convection as Convection
from softway.bodies.setup.heat_loads import HeatFlux as HeatFlux
from softway.bodies.setup.heat_loads import HeatSource as HeatSource
from softway.bodies.setup.heat_loads import Radiation as Radiation
from softway.bodies.setup.heat_loads import Temperature as Temperature
from softway.heat.build_heat import build_heat as build_heat
from softway.heat.heat_contact import HeatContact as HeatContact
from softway.heat.heat_model import HeatModel as HeatModel
from softway.heat.heat_model import HeatScene as HeatScene
from softway.heat.ledger import HeatLedger as HeatLedger
from softway.heat.march import HeatState as HeatState
from softway.heat.march import HeatStep as HeatStep
from softway.heat.march import march_heat as march_heat
from softway.laws.heat.conduction import Conduction as Conduction
from softway.laws.heat.conduction import Latent as Latent
from softway.laws.heat.contact_heat import ContactHeat as ContactHeat
from softway.laws.heat.stiffness_table import StiffnessTable as StiffnessTable
from softway.laws.heat.temperature_table import TemperatureTable as TemperatureTable

__all__ = [
    "Conduction",
    "Conductor",
    "ContactHeat",
    "Convection",
    "HeatContact",
    "HeatFlux",
    "HeatLedger",
    "HeatModel",
    "HeatScene",
    "HeatSource",
    "HeatState",
    "HeatStep",
    "Latent",
    "Radiation",
    "StiffnessTable",
    "Temperature",
    "TemperatureTable",
    "build_heat",
    "march_heat",
]
