"""Flutter of elastic bodies that slide: growth of their vibrations under steady friction.

Contact is closed and slips one way, so its force is along ``n - mu d``, with the normal n, the direction d of the slip
and the friction coefficient mu.  The stiffness of the sliding body is then not symmetric: pairs of its frequencies meet
and become complex (docs/theory/contact/friction.md).
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, eigs, splu

from softway.arrays import Array
from softway.contact.contact_rows import ContactRows
from softway.contact.stencils import normal_component
from softway.marching.state.model_state import ModelState
from softway.model.model import Model

MODES = 24
"""Number of modes that are found, the slowest ones."""
SMALL = 400
"""Number of unknowns up to which all modes are found."""
LEAST = 1e-9
"""Inverse squares of frequencies, relative to the greatest, that are rounding."""
GROWING = 1e-5
"""Growth, relative to the frequency, above which a mode is no rounding."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Flutter:
    """Growing vibration of a sliding body.

    Parameters
    ----------
    growth
        Rate of growth [1/s]: the amplitude grows as ``exp(growth t)``.
    frequency
        Angular frequency [rad/s].
    """

    growth: float
    frequency: float

    @property
    def damping_time(self) -> float:
        """Ratio of viscosities to moduli at which the vibration does not grow [s]."""
        return 2.0 * self.growth / self.frequency**2

    def in_slabs(self, span: float, calm: float = 0.0) -> float:
        """Factor by which the amplitude grows in one slab of length ``span`` [s]; estimated with the filter ``calm``.

        The filter takes ``calm H^2`` of the velocity, and half of it of the vibration, which has the displacement, too.

        Examples
        --------
        >>> one = Flutter(growth=0.07, frequency=2.0)
        >>> round(one.in_slabs(0.1), 4), round(one.in_slabs(10.0), 4), round(one.in_slabs(10.0, calm=0.2), 4)
        (1.007, 1.0069, 0.9029)
        """
        half = 0.5 * span * (1j * self.frequency + self.growth)
        return float(abs((1.0 + half) / (1.0 - half)) * np.sqrt(1.0 - calm * self._unresolved(span) ** 2))

    def stopping_calm(self, span: float) -> float:
        """Least filter ``calm`` with which the vibration does not grow in slabs of length ``span`` [s]; above 1 there
        is none.

        Examples
        --------
        >>> one = Flutter(growth=0.2, frequency=1.34)
        >>> round(one.stopping_calm(8.0), 3), one.stopping_calm(0.3) > 1.0
        (0.107, True)
        """
        return float((1.0 - self.in_slabs(span) ** -2) / self._unresolved(span) ** 2)

    def _unresolved(self, span: float) -> float:
        """Eigenvalue H of the filter, see :mod:`softway.marching.friction.calm`."""
        square = (0.5 * span * self.frequency) ** 2
        return square / (1.0 + square)


def sliding_flutter(model: Model, state: ModelState) -> tuple[Flutter, ...]:
    """Growing vibrations of the bodies whose contact slips in a ``state``, without the damping of their materials.

    Contact stays closed, sticking rows stick, and the friction coefficient is the slope of the resistance over the
    pressure.  Large models are examined in their slowest modes.  Empty without slip or inertia.

    Raises
    ------
    RuntimeError
        If rows of contact depend on each other: the matrix is singular.
    """
    if not model.inert or model.friction.frictionless or not (state.closed & state.sliding).any():
        return ()
    stiffness, inertia = _pencil(model, state)
    scale = max(model.wave_speed(part) for part in model.parts) / model.extent(state.start.displacement)
    shift, size = -(scale**2), stiffness.shape[0]
    factor = splu(sp.csc_matrix(stiffness - shift * inertia))
    if size <= SMALL:
        found = np.linalg.eigvals(factor.solve(inertia.toarray()))
    else:
        product = LinearOperator((size, size), matvec=lambda x: factor.solve(inertia @ x), dtype=float)
        found = eigs(product, k=MODES, v0=np.ones(size), return_eigenvectors=False)
    squares = shift + 1.0 / found[np.abs(found) > LEAST * np.abs(found).max()]
    rates = np.sqrt(squares.astype(complex))
    growing = rates[(-rates.imag > GROWING * np.abs(rates)) & (rates.real > -rates.imag)]
    order = np.argsort(growing.real)
    return tuple(Flutter(growth=-float(w.imag), frequency=float(w.real)) for w in growing[order])


def _pencil(model: Model, state: ModelState) -> tuple[sp.csc_array, sp.csc_array]:
    """Stiffness and inertia of the unknowns and of the forces of closed rows; unknowns come first."""
    u, dofs = state.start.displacement, model.dofs
    rows = state.rows or model.rows(u, state.time)
    gradient, force = _closed_rows(model, state, rows)
    held, pushed = dofs.rows(gradient), dofs.rows(force)
    stiffness = model.inertia_and_stiffness(u, 1.0) - model.inertia_and_stiffness(u, 0.0)
    size = max(float(np.abs(stiffness.data).max(initial=0.0)), 1e-300)
    full = sp.block_array([[stiffness, -size * pushed.T], [size * held, None]], format="csc")
    inertia = sp.block_diag([model.inertia_and_stiffness(u, 0.0), sp.csc_array((held.shape[0],) * 2)], format="csc")
    return sp.csc_array(full), sp.csc_array(inertia)


def _closed_rows(model: Model, state: ModelState, rows: ContactRows) -> tuple[sp.csr_array, sp.csr_array]:
    """Conditions (k, n d) on closed rows, directions (k, n d) of their forces; sticking rows hold along the surface."""
    slip = _direction(model, state, rows)
    speed = np.linalg.norm(slip, axis=1)
    mu = model.friction.at(state.start.displacement).resistance(speed, state.pressure)[2]
    drag = normal_component(rows.shear.weights, mu[:, None] * slip / np.where(speed > 0.0, speed, np.inf)[:, None])
    slides, sticks = state.closed & state.sliding, state.closed & ~state.sliding
    normal, k = rows.gradient, rows.shear.tangents.shape[1]
    along = rows.shear.gradient()[np.flatnonzero(np.repeat(sticks, k))]
    held = sp.vstack([normal[slides], normal[sticks], along], format="csr")
    pushed = sp.vstack([(normal - drag)[slides], normal[sticks], along], format="csr")
    return sp.csr_array(held), sp.csr_array(pushed)


def _direction(model: Model, state: ModelState, rows: ContactRows) -> Array:
    """Velocity of the slip (m, d)."""
    if state.slip is not None:
        return state.slip
    soon = 1e-6
    shear = model.contacts.meet(state.start.displacement, state.start.displacement, state.time, state.time + soon)
    return shear.at(state.start.displacement).shear.slip(soon * state.start.velocity) / soon
