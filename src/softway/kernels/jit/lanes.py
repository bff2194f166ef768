"""Memory layout of the fused kernels, which compute the points of several cells side by side.

A kernel handles ``LANES`` cells together.  Every quantity at a point is a row of ``LANES`` values, and a loop over the
lanes becomes one vector instruction.  The rows of a point follow each other in a flat array ``s``.  The names are the
positions of the first number of the rows:

=========  ============  ==================================================================
name       rows          content
=========  ============  ==================================================================
FRAME      9             derivatives H_Ji of the displacement, then carrier f_Ji of the stress
SPIN       1             factor of the geometric stiffness: 1, or 0 in the linear theory
STRESS     6             strain E, then stress S: xx yy zz xy yz zx
BRIDGE     6             symmetric tensor B of the moduli
SOFT STIFF 1 1           factors of the moduli: ``dS = SOFT (B:dE) B + 2 STIFF B dE B``
ENERGY     1             energy per volume W
TOTAL      1             sum of ``V W`` over the points so far [J]
NATURAL    9             derivatives of the displacement along the reference coordinates of the cell, or flux
CHANGE     9             derivatives dH of a change of the displacement
FLUX       9             ``P = S f`` (first Piola-Kirchhoff), or its change
NODES      ...           nodal values, and other data of a kernel
=========  ============  ==================================================================

Laws with a history need more rows.  Derivatives are taken along the reference coordinates xi of the cell, and
``STRESS`` is the Cauchy stress:

===========  =====  ======================================================================
name         rows   content
===========  =====  ======================================================================
FRAME        9      derivatives dx_i/dxi_r of the positions at the end of the slab, then their cofactors
BRIDGE       6      relative trial stress divided by its norm: direction of plastic flow
SOFT STIFF   1 1    factors of the moduli: ``ds = SOFT dev(d) + BULK tr(d) I - STIFF n (n:d)``
STEP         9      change of the derivatives dx_i/dxi_r in the slab
TURN         9      rotation from the start to the middle of the slab, and from the middle to the end
STRAIN       6      strain increment of the slab, in the axes of the middle
BACK         6      back stress
PLASTIC      1      equivalent plastic strain
STORED LOST  1 1    energies per current volume stored and dissipated in the slab
RATIO        1      determinant of the derivatives dx_i/dxi_r in the middle of the slab
VOLUME       1      determinant of the derivatives at the end of the slab
SHRINK       1      1/VOLUME
BULK         1      factor of the moduli, see above
PAST         ...    nodal values, and other data of a kernel
===========  =====  ======================================================================
"""

LANES = 8
FRAME, SPIN, STRESS, BRIDGE, SOFT, STIFF, ENERGY, TOTAL = (LANES * row for row in (0, 9, 10, 16, 22, 23, 24, 25))
NATURAL, CHANGE, FLUX, NODES = (LANES * row for row in (26, 35, 44, 53))
VECTOR, TENSOR = 3 * LANES, 9 * LANES
STEP, TURN, STRAIN, BACK, PLASTIC, STORED, LOST, RATIO = (NODES + LANES * row for row in (0, 9, 18, 24, 30, 31, 32, 33))
VOLUME, SHRINK, BULK, PAST = (NODES + LANES * row for row in (34, 35, 36, 37))
