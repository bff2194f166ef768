"""Laws of materials and of friction, and their objective rates, hardening and rate dependence."""

from softway.laws.bulk import J2 as J2
from softway.laws.bulk import Hencky as Hencky
from softway.laws.bulk import Hypoelastic as Hypoelastic
from softway.laws.bulk import Kelvin as Kelvin
from softway.laws.bulk import LinearElastic as LinearElastic
from softway.laws.bulk import LinearOrthotropic as LinearOrthotropic
from softway.laws.bulk import Maxwell as Maxwell
from softway.laws.bulk import MooneyRivlin as MooneyRivlin
from softway.laws.bulk import NeoHookean as NeoHookean
from softway.laws.bulk import NortonHoff as NortonHoff
from softway.laws.bulk import StVenantKirchhoff as StVenantKirchhoff
from softway.laws.friction import Coulomb as Coulomb
from softway.laws.friction import Frictionless as Frictionless
from softway.laws.friction import LimitedViscoplastic as LimitedViscoplastic
from softway.laws.friction import Lubricated as Lubricated
from softway.laws.friction import NortonHoff as NortonHoffFriction
from softway.laws.friction import StaticKinetic as StaticKinetic
from softway.laws.friction import Stribeck as Stribeck
from softway.laws.friction import Tresca as Tresca
from softway.laws.objective_rates import GreenNaghdi as GreenNaghdi
from softway.laws.objective_rates import Jaumann as Jaumann
from softway.laws.objective_rates import Logarithmic as Logarithmic
from softway.laws.objective_rates import Truesdell as Truesdell
from softway.laws.plasticity.hardening import LinearHardening as LinearHardening
from softway.laws.plasticity.hardening import PowerHardening as PowerHardening
from softway.laws.plasticity.hardening import Voce as Voce
from softway.laws.plasticity.rate_dependence import JohnsonCook as JohnsonCook
from softway.laws.plasticity.rate_dependence import NortonFlow as NortonFlow
from softway.laws.plasticity.rate_dependence import Perzyna as Perzyna
from softway.laws.plasticity.rate_dependence import RateIndependent as RateIndependent
from softway.laws.plasticity.softening import Arrhenius as Arrhenius
from softway.laws.plasticity.softening import JohnsonCookSoftening as JohnsonCookSoftening
from softway.laws.plasticity.softening import SofteningTable as SofteningTable

__all__ = [
    "J2",
    "Arrhenius",
    "Coulomb",
    "Frictionless",
    "GreenNaghdi",
    "Hencky",
    "Hypoelastic",
    "Jaumann",
    "JohnsonCook",
    "JohnsonCookSoftening",
    "Kelvin",
    "LimitedViscoplastic",
    "LinearElastic",
    "LinearHardening",
    "LinearOrthotropic",
    "Logarithmic",
    "Lubricated",
    "Maxwell",
    "MooneyRivlin",
    "NeoHookean",
    "NortonFlow",
    "NortonHoff",
    "NortonHoffFriction",
    "Perzyna",
    "PowerHardening",
    "RateIndependent",
    "SofteningTable",
    "StVenantKirchhoff",
    "StaticKinetic",
    "Stribeck",
    "Tresca",
    "Truesdell",
    "Voce",
]
