"""Tolerances of accepted slabs: how far contact conditions and balances may be missed, in one place."""

DEPTH = 1e-12
"""Greatest overlap of surfaces, relative to the coordinates: rounding of positions."""
TENSION = 1e-12
"""Greatest tension of a contact row, relative to the greatest contact force."""
ENERGY = 1e-9
"""Greatest error of the energy balance of one slab that has to close, relative to the energies that take part."""
UNSTABLE = 0.1
"""Growth of the energy in one slab of central differences, relative to the energies that take part, that only a slab
beyond the stability limit has; of the rule Impulse, growth in all slabs together that makes a march worthless."""
GAINED = 3e-3
"""Growth of the energy in one slab of the rule Impulse with touches, relative to the energies that take part."""
SUMS = 2e-15
"""Rounding error of sums of works and energies, relative to their magnitudes."""
AT_REST = 1e10
"""Energies, relative to the rounding error of the stored energy, below which bodies are at rest: strains of 1e-9."""
BEQUEST = 0.5
"""Fraction of the admissible momentum error that a slab may leave to the next one."""
MOMENTUM = 1e-9
"""Greatest error of the momentum balance of one slab, relative to the momenta that take part."""
MOTION = 1e-12
"""Greatest distance of an initial field from the motions that the degrees of freedom describe, relative to it."""
FORCES = 1e-6
"""Greatest error of the balance of forces of bodies without inertia, relative to the forces that take part: stiff
bodies keep it up to the accuracy of positions."""
KEEP_EDGES_AFTER = 6
"""Iterations after which nodes and edges keep their facets and edges where all edges have rows."""
KEEP_FACETS_AFTER = 15
"""Number of iterations after which nodes are kept on their facets: a node between two facets would alternate."""
EXPONENT = 60
"""Power of two to which the greatest entries of matrices and right-hand sides in single precision are brought: their
products do not overflow."""
INDEPENDENT = 1e-13
"""Least eigenvalue, for each of them, of the products of unit differences of residuals that is used in mixing."""
DECIDED = 0.5
"""Part of a limit within which a decision of a compiled slab is certain: the solver for all models takes it, too."""
BALANCED = 0.5
"""Part of a limit within which a balance of a compiled slab certainly holds."""
