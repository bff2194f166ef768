"""Laws of the bulk material."""

from softway.laws.bulk.linear_elastic import LinearElastic as LinearElastic
from softway.laws.bulk.neo_hookean import NeoHookean as NeoHookean
from softway.laws.bulk.st_venant_kirchhoff import StVenantKirchhoff as StVenantKirchhoff

__all__ = ["LinearElastic", "NeoHookean", "StVenantKirchhoff"]
