"""Friction laws."""

from softway.laws.friction.coulomb import Coulomb as Coulomb
from softway.laws.friction.frictionless import Frictionless as Frictionless
from softway.laws.friction.limited_viscoplastic import LimitedViscoplastic as LimitedViscoplastic
from softway.laws.friction.lubricated import Lubricated as Lubricated
from softway.laws.friction.norton_hoff import NortonHoff as NortonHoff
from softway.laws.friction.static_kinetic import StaticKinetic as StaticKinetic
from softway.laws.friction.stribeck import Stribeck as Stribeck
from softway.laws.friction.tresca import Tresca as Tresca

__all__ = [
    "Coulomb",
    "Frictionless",
    "LimitedViscoplastic",
    "Lubricated",
    "NortonHoff",
    "StaticKinetic",
    "Stribeck",
    "Tresca",
]
