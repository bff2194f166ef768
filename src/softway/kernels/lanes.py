"""Layout of the fused kernels: what is computed at the points of several cells at once, side by side.

A kernel handles ``LANES`` cells together.  Every number of a point is a row of that many values, so that a loop over
the lanes becomes one instruction of the machine.  The rows of one point follow each other in a flat array ``s``; the
names are the places of their first numbers:

=========  ============  ==================================================================
name       rows          content
=========  ============  ==================================================================
FRAME      9             derivatives H_Ji of the displacement, then carrier f_Ji of the stress
SPIN       1             1 where the stress turns with the carrier, 0 in the linear theory
STRESS     6             strain E, then stress S: xx yy zz xy yz zx
BRIDGE     6             symmetric tensor B of the moduli
SOFT STIFF 1 1           factors of the moduli: ``dS = SOFT (B:dE) B + 2 STIFF B dE B``
ENERGY     1             energy per volume W
TOTAL      1             sum of ``V W`` over the points so far [J]
NATURAL    9             derivatives along the reference coordinates of the cell, of displacement or of flux
CHANGE     9             derivatives dH of a change of the displacement
FLUX       9             ``P = S f`` (first Piola-Kirchhoff), or its change
NODES      ...           nodal values, and whatever else a kernel needs
=========  ============  ==================================================================

Laws with a history need more rows.  Their derivatives are those along the reference coordinates xi of the cell, and
``STRESS`` is that of Cauchy:

===========  =====  ======================================================================
name         rows   content
===========  =====  ======================================================================
FRAME        9      derivatives dx_i/dxi_r of the places at the end of the slab, then their cofactors
BRIDGE       6      relative trial stress over its norm: the direction of the flow
SOFT STIFF   1 1    factors of the moduli: ``ds = SOFT dev(d) + BULK tr(d) I - STIFF n (n:d)``
STEP         9      change of these derivatives in the slab
TURN         9      rotation from the start to the middle, and from there to the end
STRAIN       6      strain increment of the slab, in the axes of the middle
BACK         6      back stress
PLASTIC      1      equivalent plastic strain
STORED LOST  1 1    energies per present volume taken up in the slab, stored and dissipated
RATIO        1      determinant of these derivatives in the middle
VOLUME       1      their determinant at the end
SHRINK       1      1/VOLUME
BULK         1      see above
PAST         ...    nodal values, and whatever else a kernel needs
===========  =====  ======================================================================
"""

LANES = 8
FRAME, SPIN, STRESS, BRIDGE, SOFT, STIFF, ENERGY, TOTAL = (LANES * row for row in (0, 9, 10, 16, 22, 23, 24, 25))
NATURAL, CHANGE, FLUX, NODES = (LANES * row for row in (26, 35, 44, 53))
VECTOR, TENSOR = 3 * LANES, 9 * LANES
STEP, TURN, STRAIN, BACK, PLASTIC, STORED, LOST, RATIO = (NODES + LANES * row for row in (0, 9, 18, 24, 30, 31, 32, 33))
VOLUME, SHRINK, BULK, PAST = (NODES + LANES * row for row in (34, 35, 36, 37))
