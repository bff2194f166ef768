"""Laws of heat: conductivity, capacity and latent heat."""

from softway.laws.heat.conduction import Conduction as Conduction
from softway.laws.heat.conduction import Latent as Latent
from softway.laws.heat.stiffness_table import StiffnessTable as StiffnessTable
from softway.laws.heat.temperature_table import TemperatureTable as TemperatureTable

__all__ = ["Conduction", "Latent", "StiffnessTable", "TemperatureTable"]
