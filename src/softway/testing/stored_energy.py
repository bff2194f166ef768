"""Checks of a law with a stored energy."""

from collections.abc import Iterator

import numpy as np

from softway.arrays import Array
from softway.bodies.internal_force.elastic.material_points import MaterialPoints
from softway.laws.elasticity.elastic_constants import wave_modulus
from softway.laws.law import StoredEnergy
from softway.laws.strain_measures import Green, Small
from softway.testing.examination import Examination
from softway.testing.verdict import close, require


def strains() -> Iterator[Array]:
    """Moderate strains (3, 3): stretches along the axes, shear, and a general strain."""
    yield np.diag([0.1, 0.0, 0.0])
    yield np.diag([-0.1, 0.05, 0.2])
    yield np.array([[0.0, 0.15, 0.0], [0.15, 0.0, 0.0], [0.0, 0.0, 0.0]])
    yield np.array([[0.2, -0.07, 0.03], [-0.07, -0.1, 0.11], [0.03, 0.11, 0.05]])


def _general() -> Array:
    return list(strains())[-1]


def _shapes(law: StoredEnergy) -> float:
    E, worst = np.stack([np.stack(list(strains()))] * 2), 0.0
    kept = E.copy()
    for name, axes in (("energy", 0), ("stress", 2), ("tangent", 4)):
        answer = getattr(law, name)(E)
        require(answer.shape == (2, 4) + (3,) * axes, law, f"{name} of strains (2, 4, 3, 3) has shape {answer.shape}")
        single = getattr(law, name)(E[1, 2])
        worst = max(
            worst, close(answer[1, 2], single, 1e-14, law, f"{name} of one strain differs from {name} of an array")
        )
    require(np.array_equal(E, kept), law, "the array of strains was changed")
    return worst


def _undeformed(law: StoredEnergy) -> float:
    zero = np.zeros((3, 3))
    scale = float(np.abs(law.tangent(zero)).max())
    require(float(law.energy(zero)) == 0.0, law, f"energy of the undeformed state is {float(law.energy(zero)):g}")
    return close(law.stress(zero), zero, 1e-14, law, "stress of the undeformed state is not zero", scale)


def _stress(law: StoredEnergy) -> float:
    worst = 0.0
    for E in strains():
        S = law.stress(E)
        for direction in strains():
            slope, scale = difference(law.energy, E, direction), float(np.abs(S).max())
            error = close(np.sum(S * direction), slope, 1e-8, law, "stress is not the derivative of the energy", scale)
            worst = max(worst, error)
    return worst


def _moduli(law: StoredEnergy) -> float:
    worst = 0.0
    for E in strains():
        C = law.tangent(E)
        for direction in strains():
            change = difference(law.stress, E, direction)
            given = np.einsum("ijkl,kl", C, direction)
            worst = max(worst, close(given, change, 1e-8, law, "tangent is not the derivative of the stress"))
    return worst


def _symmetries(law: StoredEnergy) -> float:
    worst = 0.0
    for E in strains():
        S, C = law.stress(E), law.tangent(E)
        errors = (
            close(S, S.T, 1e-13, law, "stress is not symmetric", np.abs(C).max()),
            close(C, C.transpose(2, 3, 0, 1), 1e-13, law, "tangent has no major symmetry"),
            close(C, C.transpose(1, 0, 2, 3), 1e-13, law, "tangent has no minor symmetry"),
        )
        worst = max(worst, *errors)
    return worst


def _positive(law: StoredEnergy) -> float:
    for E in strains():
        require(float(law.energy(E)) > 0.0, law, f"energy is not positive at a moderate strain {E.tolist()}")
    return 0.0


def _tiny(law: StoredEnergy) -> float:
    x, w = np.polynomial.legendre.leggauss(4)
    worst = 0.0
    for E in (1e-6 * strain for strain in strains()):
        work = sum(0.5 * wi * float(np.sum(law.stress(0.5 * (1.0 + xi) * E) * E)) for xi, wi in zip(x, w, strict=True))
        worst = max(worst, close(law.energy(E), work, 1e-9, law, "energy of a strain of 1e-7 is inaccurate"))
    return worst


def _rotations(law: StoredEnergy) -> float:
    points = MaterialPoints(law=law, free=(), directions=np.eye(3)[None])
    H = np.array([[[0.1, 0.2, -0.1], [0.0, -0.1, 0.3], [0.05, 0.1, 0.2]]])
    if not isinstance(law.measure, Green):
        spin = H - np.swapaxes(H, -1, -2)
        told = "energy changes under an infinitesimal rotation"
        return close(points.energy(H + spin), points.energy(H), 1e-13, law, told)
    turn, _ = np.linalg.qr(np.array([[1.0, 2.0, 0.5], [-1.0, 0.3, 2.0], [0.7, -1.0, 1.0]]))
    turn *= np.sign(np.linalg.det(turn))
    turned = (np.eye(3) + H) @ turn.T - np.eye(3)
    return max(
        close(points.energy(turned), points.energy(H), 1e-12, law, "energy changes when the body is rotated"),
        close(points.flux(turned), points.flux(H) @ turn.T, 1e-12, law, "stress does not rotate with the body"),
    )


def _inverted(law: StoredEnergy) -> float:
    if not isinstance(law.measure, Green):
        return np.nan
    points = MaterialPoints(law=law, free=(), directions=np.eye(3)[None])
    H = np.diag([-1.5, 0.0, 0.0])[None]
    with np.errstate(all="raise"):
        energy, flux = points.energy_and_flux(H)
    require(bool(np.isposinf(energy).all()), law, f"energy of inverted material is {energy[0]:g}, not infinite")
    require(not np.isfinite(flux).any(), law, "stress of inverted material is finite")
    return 0.0


def _reported(law: StoredEnergy) -> float:
    C = np.asarray(law.tangent(np.zeros((3, 3))))
    uniaxial = 1.0 / np.linalg.pinv(C.reshape(9, 9), hermitian=True)[0, 0]
    modulus = law.wave_speed(2.0) ** 2 * 2.0
    return max(
        close(modulus, wave_modulus(C), 1e-12, law, "wave_speed contradicts the tangent at zero strain"),
        close(law.youngs(), uniaxial, 1e-12, law, "youngs contradicts the tangent at zero strain", modulus),
    )


def _linear(law: StoredEnergy) -> float:
    if not law.linear:
        return np.nan
    require(isinstance(law.measure, Small), law, "a linear law must use the small strain as its measure")
    constant = law.tangent(np.zeros((3, 3)))
    return close(law.tangent(_general()), constant, 0.0, law, "a linear law has moduli that depend on strain")


def difference(function, E: Array, direction: Array) -> Array:  # type: ignore[no-untyped-def]
    """Fourth-order central difference of a function along a direction (3, 3) at the strain E (3, 3)."""
    step = 1e-3
    one, two = (function(E + k * step * direction) - function(E - k * step * direction) for k in (1.0, 2.0))
    return (8.0 * one - two) / (12.0 * step)


STORED_ENERGY = (
    Examination(name="single and array evaluation agree", look=_shapes, allowed=1e-14),
    Examination(name="no energy and no stress without strain", look=_undeformed, allowed=1e-14),
    Examination(name="stress is the derivative of the energy", look=_stress, allowed=1e-8),
    Examination(name="moduli are the derivative of the stress", look=_moduli, allowed=1e-8),
    Examination(name="stress and moduli are symmetric", look=_symmetries, allowed=1e-13),
    Examination(name="energy of moderate strains is positive", look=_positive),
    Examination(name="energy of tiny strains is accurate", look=_tiny, allowed=1e-9),
    Examination(name="objective under rotations", look=_rotations, allowed=1e-12),
    Examination(name="inverted material has infinite energy", look=_inverted),
    Examination(name="reported wave speed and Young's modulus match the moduli", look=_reported, allowed=1e-12),
    Examination(name="a linear law has constant moduli", look=_linear),
)
