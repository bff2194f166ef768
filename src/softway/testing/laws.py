"""Examination of a material law."""

from collections.abc import Iterator

import numpy as np

from softway.bodies.points import MaterialPoints
from softway.laws.lateral import condensed
from softway.laws.law import StoredEnergy
from softway.laws.measure import Green, Small
from softway.testing.verdict import close, require
from softway.typing import Array


def check_law(law: StoredEnergy) -> None:
    """Raise ``AssertionError`` saying what is wrong with a law; return quietly if nothing is.

    Examined: shapes, the undeformed state, stress as derivative of the energy, moduli as derivative of the stress,
    their symmetries, the energy of tiny strains against the work of the stress, indifference to rotations, inverted
    matter, and the moduli of small strains that the law reports.

    Examples
    --------
    >>> from softway.laws.bulk import NeoHookean
    >>> check_law(NeoHookean(E=1.0, nu=0.3))
    """
    _shapes(law)
    _undeformed(law)
    for E in _strains():
        _derivatives(law, E)
        _symmetries(law, E)
        _tiny(law, 1e-6 * E)
    _rotations(law)
    _inverted(law)
    _reported(law)


def _strains() -> Iterator[Array]:
    """Moderate strains: stretches along the axes, shear, and a general one."""
    yield np.diag([0.1, 0.0, 0.0])
    yield np.diag([-0.1, 0.05, 0.2])
    yield np.array([[0.0, 0.15, 0.0], [0.15, 0.0, 0.0], [0.0, 0.0, 0.0]])
    yield np.array([[0.2, -0.07, 0.03], [-0.07, -0.1, 0.11], [0.03, 0.11, 0.05]])


def _general() -> Array:
    return list(_strains())[-1]


def _shapes(law: StoredEnergy) -> None:
    E = np.stack([np.stack(list(_strains()))] * 2)
    kept = E.copy()
    for name, axes in (("energy", 0), ("stress", 2), ("tangent", 4)):
        answer = getattr(law, name)(E)
        require(answer.shape == (2, 4) + (3,) * axes, law, f"{name} of strains (2, 4, 3, 3) has shape {answer.shape}")
        single = getattr(law, name)(E[1, 2])
        close(answer[1, 2], single, 1e-14, law, f"{name} of one strain differs from {name} of many")
    require(np.array_equal(E, kept), law, "the strain given was changed")


def _undeformed(law: StoredEnergy) -> None:
    zero = np.zeros((3, 3))
    scale = float(np.abs(law.tangent(zero)).max())
    require(float(law.energy(zero)) == 0.0, law, f"energy of the undeformed state is {float(law.energy(zero)):g}")
    require(np.abs(law.stress(zero)).max() <= 1e-14 * scale, law, "stress of the undeformed state is not zero")


def _derivatives(law: StoredEnergy, E: Array) -> None:
    S, C = law.stress(E), law.tangent(E)
    for direction in _strains():
        slope = _difference(law.energy, E, direction)
        close(np.sum(S * direction), slope, 1e-8, law, "stress is not the derivative of the energy", np.abs(S).max())
        change = _difference(law.stress, E, direction)
        close(np.einsum("ijkl,kl", C, direction), change, 1e-8, law, "tangent is not the derivative of the stress")


def _symmetries(law: StoredEnergy, E: Array) -> None:
    S, C = law.stress(E), law.tangent(E)
    close(S, S.T, 1e-13, law, "stress is not symmetric", np.abs(C).max())
    close(C, C.transpose(2, 3, 0, 1), 1e-13, law, "tangent has no major symmetry")
    close(C, C.transpose(1, 0, 2, 3), 1e-13, law, "tangent has no minor symmetry")
    require(float(law.energy(E)) > 0.0, law, f"energy is not positive at a moderate strain {E.tolist()}")


def _tiny(law: StoredEnergy, E: Array) -> None:
    x, w = np.polynomial.legendre.leggauss(4)
    work = sum(0.5 * wi * float(np.sum(law.stress(0.5 * (1.0 + xi) * E) * E)) for xi, wi in zip(x, w, strict=True))
    close(law.energy(E), work, 1e-9, law, "energy of a strain of 1e-7 has lost its digits")


def _rotations(law: StoredEnergy) -> None:
    points = MaterialPoints(law=law, free=(), directions=np.eye(3)[None])
    H = np.array([[[0.1, 0.2, -0.1], [0.0, -0.1, 0.3], [0.05, 0.1, 0.2]]])
    if isinstance(law.measure, Green):
        turn, _ = np.linalg.qr(np.array([[1.0, 2.0, 0.5], [-1.0, 0.3, 2.0], [0.7, -1.0, 1.0]]))
        turn *= np.sign(np.linalg.det(turn))
        turned = (np.eye(3) + H) @ turn.T - np.eye(3)
        close(points.energy(turned), points.energy(H), 1e-12, law, "energy changes when the body is turned")
        close(points.flux(turned), points.flux(H) @ turn.T, 1e-12, law, "stress does not turn with the body")
    else:
        spin = H - np.swapaxes(H, -1, -2)
        close(points.energy(H + spin), points.energy(H), 1e-13, law, "energy changes under an infinitesimal rotation")


def _inverted(law: StoredEnergy) -> None:
    if not isinstance(law.measure, Green):
        return
    points = MaterialPoints(law=law, free=(), directions=np.eye(3)[None])
    H = np.diag([-1.5, 0.0, 0.0])[None]
    with np.errstate(all="raise"):
        energy, flux = points.energy_and_flux(H)
    require(bool(np.isposinf(energy).all()), law, f"energy of inverted matter is {energy[0]:g}, not infinite")
    require(not np.isfinite(flux).any(), law, "stress of inverted matter is finite")


def _reported(law: StoredEnergy) -> None:
    C = law.tangent(np.zeros((3, 3)))
    dilatational, uniaxial = C[0, 0, 0, 0], condensed(C, 1, (1, 2))[0, 0, 0, 0]
    close(law.wave_speed(2.0) ** 2 * 2.0, dilatational, 1e-12, law, "wave_speed contradicts the tangent at zero strain")
    close(law.youngs(), uniaxial, 1e-12, law, "youngs contradicts the tangent at zero strain")
    if law.linear:
        require(isinstance(law.measure, Small), law, "a linear law is written in the small strain")
        close(law.tangent(_general()), C, 0.0, law, "a linear law has moduli that depend on strain")


def _difference(function, E: Array, direction: Array) -> Array:  # type: ignore[no-untyped-def]
    """Central difference of fourth order along a direction."""
    step = 1e-3
    one, two = (function(E + k * step * direction) - function(E - k * step * direction) for k in (1.0, 2.0))
    return (8.0 * one - two) / (12.0 * step)
