"""Material laws."""

from softway.laws.bulk.hencky import Hencky as Hencky
from softway.laws.bulk.hypoelastic import Hypoelastic as Hypoelastic
from softway.laws.bulk.j2 import J2 as J2
from softway.laws.bulk.linear_elastic import LinearElastic as LinearElastic
from softway.laws.bulk.mooney_rivlin import MooneyRivlin as MooneyRivlin
from softway.laws.bulk.neo_hookean import NeoHookean as NeoHookean
from softway.laws.bulk.norton_hoff import NortonHoff as NortonHoff
from softway.laws.bulk.orthotropic import LinearOrthotropic as LinearOrthotropic
from softway.laws.bulk.st_venant_kirchhoff import StVenantKirchhoff as StVenantKirchhoff
from softway.laws.bulk.viscoelastic import Kelvin as Kelvin
from softway.laws.bulk.viscoelastic import Maxwell as Maxwell

__all__ = [
    "J2",
    "Hencky",
    "Hypoelastic",
    "Kelvin",
    "LinearElastic",
    "LinearOrthotropic",
    "Maxwell",
    "MooneyRivlin",
    "NeoHookean",
    "NortonHoff",
    "StVenantKirchhoff",
]
