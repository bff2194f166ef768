"""softway: dynamic contact of solids, with the velocity as unknown and contact as a constraint on it.

Names that nearly every program needs are here.  The others are one dot deeper: ``softway.bodies``, ``contact``,
``heat``, ``laws``, ``mechanisms``, ``meshes``, ``model``, ``obstacles``, ``piles``, ``record``, ``solve`` and
``studies``.
"""

import logging

from softway.public_names import public

__getattr__, __dir__, __all__ = public(__name__, __file__)

logging.getLogger(__name__).addHandler(logging.NullHandler())
