"""Checks of a path-dependent law."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from softway.arrays import Array
from softway.bodies.internal_force.inelastic.material_points import RatePoints
from softway.bodies.internal_force.material_state import MaterialState, initial_history
from softway.laws.elasticity.elastic_constants import wave_modulus
from softway.laws.law import Increment, RateLaw, Response
from softway.testing.examination import Examination
from softway.testing.stored_energy import strains
from softway.testing.verdict import close, require

_SIZES = (1e-4, 1e-2, 0.3)  # scale of the strain increments: elastic, yielding, flowing
_SPANS = (1e-4, 1.0, 1e4)  # lengths of slabs [s]
_SPAN = 0.1  # length of a slab in a motion of a point [s]
_STEPS = 400  # increments of the path on which energies are summed


def paths(law: RateLaw) -> Iterator[tuple[Increment, Response]]:
    """Strain increments along paths of several sizes and rates, with responses; the last of each path reverses."""
    for size in _SIZES:
        for span in _SPANS:
            stress, memory = np.zeros((1, 3, 3)), law.virgin(1)
            for strain in (*strains(), -list(strains())[-1]):
                increment = Increment(stress=stress, memory=memory, strain=size * strain[None], span=span)
                response = law.respond(increment)
                yield increment, response
                stress, memory = response.stress, response.memory


def _shapes(law: RateLaw) -> float:
    worst = 0.0
    strain = 1e-2 * np.stack(list(strains()))
    start = law.virgin(4)
    many = Increment(stress=np.zeros((4, 3, 3)), memory=start, strain=strain, span=1.0)
    kept, response, C = strain.copy(), law.respond(many), law.moduli(many)
    one = replace(many, stress=many.stress[:1], memory=law.virgin(1), strain=strain[3:])
    single = law.respond(one)
    wanted = {"stress": (4, 3, 3), "stored": (4,), "dissipated": (4,)}
    for name, shape in wanted.items():
        got = getattr(response, name)
        require(np.shape(got) == shape, law, f"{name} of strains (4, 3, 3) has shape {np.shape(got)}")
        worst = max(worst, close(got[3], getattr(single, name)[0], 1e-13, law, f"{name} of one point differs"))
    require(np.shape(C) == (4, 3, 3, 3, 3), law, f"moduli of strains (4, 3, 3) have shape {np.shape(C)}")
    require(response.memory.keys() == start.keys(), law, f"memory {list(start)} becomes {list(response.memory)}")
    for name, values in response.memory.items():
        require(values.shape == start[name].shape, law, f"memory {name!r} changes shape to {values.shape}")
    require(np.array_equal(strain, kept), law, "the array of strains was changed")
    return worst


def _symmetries(law: RateLaw) -> float:
    worst = 0.0
    for increment, response in paths(law):
        C, S = law.moduli(increment), response.stress
        worst = max(
            worst,
            close(S, np.swapaxes(S, 1, 2), 1e-13, law, "stress is not symmetric"),
            close(C, np.swapaxes(C, 1, 2), 1e-12, law, "moduli have no minor symmetry"),
            close(C, np.swapaxes(C, 3, 4), 1e-12, law, "moduli have no minor symmetry"),
        )
    return worst


def _moduli(law: RateLaw) -> float:
    """Compare the moduli with differences of two step lengths; where these disagree the stress has a kink."""
    worst, looked, met = 0.0, 0, 0
    for increment, _ in paths(law):
        C, size = law.moduli(increment)[0], float(np.abs(increment.strain).max())
        for direction in strains():
            given = np.einsum("ijkl,kl->ij", C, direction)
            fine, coarse = (_slope(law, increment, direction, step * size) for step in (3e-4, 1e-3))
            scale, met = float(np.abs(C).max()) * 0.1, met + 1
            if np.abs(fine - coarse).max() > 1e-7 * max(scale, float(np.abs(fine).max())):
                continue
            looked += 1
            worst = max(worst, close(given, fine, 1e-6, law, "moduli are not the derivative of the stress", scale))
    require(looked >= met // 2, law, f"the stress has a derivative in only {looked} of {met} increments")
    return worst


def _slope(law: RateLaw, increment: Increment, direction: Array, step: float) -> Array:
    """Fourth-order central difference (3, 3) of the stress along a direction of the strain."""

    def at(k: float) -> Array:
        return law.respond(replace(increment, strain=increment.strain + k * step * direction)).stress[0]

    return (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step)


def _dissipation(law: RateLaw) -> float:
    worst = 0.0
    for increment, response in paths(law):
        work = np.abs(response.stress).max() * np.abs(increment.strain).max()
        least = float(np.min(response.dissipated))
        require(
            least >= -1e-12 * work, law, f"the dissipation of strain {increment.strain[0].tolist()} is {least:g} J/m^3"
        )
        worst = max(worst, -least / work if work else 0.0)
    return worst


def _energies(law: RateLaw) -> float:
    """Compare stored plus dissipated energy with the work of the stress on a path of loading and unloading."""
    worst = 0.0
    for size in _SIZES[:2]:
        stress, memory, work, taken, turnover = np.zeros((1, 3, 3)), law.virgin(1), 0.0, 0.0, 0.0
        sums = []
        for k in range(_STEPS):
            strain = (1.0 if k < 0.7 * _STEPS else -1.0) * 5.0 * size / _STEPS * list(strains())[-1][None]
            response = law.respond(Increment(stress=stress, memory=memory, strain=strain, span=1.0 / _STEPS))
            done = float(np.sum(0.5 * (stress + response.stress) * strain))
            work, turnover = work + done, turnover + abs(done)
            taken += float(response.stored[0] + response.dissipated[0])
            stress, memory = response.stress, response.memory
            sums.append((taken, work))
        given, done_until = np.array(sums).T
        told = "stored plus dissipated energy is not the work of the stress"
        worst = max(worst, close(given, done_until, 1e-2, law, told, turnover))
    return worst


def _rest(law: RateLaw) -> float:
    worst = 0.0
    for increment, response in paths(law):
        scale = float(np.abs(response.stress).max())
        energy = scale * float(np.abs(increment.strain).max())
        kept = response.stress if response.viscous is None else response.stress - response.viscous
        none = np.zeros_like(increment.strain)
        for span in (1e-12 * increment.span, increment.span):
            still = law.respond(Increment(stress=response.stress, memory=response.memory, strain=none, span=span))
            least, gained = float(still.dissipated[0]), float(still.stored[0] + still.dissipated[0])
            require(least >= -1e-9 * energy, law, f"the dissipation at rest is {least:g} J/m^3")
            require(gained <= 1e-9 * energy, law, f"{gained:g} J/m^3 are gained at rest")
            if span < increment.span:
                after = still.stress if still.viscous is None else still.stress - still.viscous
                worst = max(worst, close(after, kept, 1e-8, law, "an instant of rest changes the stress", scale))
    return worst


def _elastic(law: RateLaw) -> float:
    C = np.asarray(law.elastic_moduli())
    require(C.shape == (3, 3, 3, 3), law, f"elastic moduli have shape {C.shape}")
    require(wave_modulus(C) > 0.0, law, "the elastic moduli give no positive wave modulus")
    worst = close(C, C.transpose(2, 3, 0, 1), 1e-13, law, "elastic moduli have no major symmetry")
    for strain in (1e-10 * e[None] for e in strains()):
        start = Increment(stress=np.zeros((1, 3, 3)), memory=law.virgin(1), strain=strain, span=1e-10)
        response = law.respond(start)
        stress = response.stress if response.viscous is None else response.stress - response.viscous
        given = np.einsum("ijkl,kl->ij", C, strain[0])
        scale = float(np.abs(C).max() * np.abs(strain).max())
        told = "the stress of a sudden small strain does not follow the elastic moduli"
        worst = max(worst, close(stress[0], given, 1e-6, law, told, scale))
    return worst


def _turned(law: RateLaw) -> float:
    """Follow a motion and the rotated motion: stresses rotate, energies stay the same."""
    Q, worst = _turn(), 0.0
    for size in _SIZES[1:]:
        plain, turned = (_walk(law, [R @ F for F in _motion(size)]) for R in (np.eye(3), Q))
        for one, other in zip(plain, turned, strict=True):
            scale = max(float(np.abs(m.stress).max()) for m in plain)
            energy = max(float(np.abs(m.stored).max() + np.abs(m.dissipated).max()) for m in plain)
            worst = max(
                worst,
                close(other.stress, Q @ one.stress @ Q.T, 1e-9, law, "stress does not rotate with the body", scale),
                close(other.stored, one.stored, 1e-9, law, "stored energy changes when the body is rotated", energy),
                close(
                    other.dissipated, one.dissipated, 1e-9, law, "dissipation changes when the body is rotated", energy
                ),
            )
    return worst


def _spun(law: RateLaw) -> float:
    """Rotate a deformed body within a slab; its history variables are those of a body at rest, rotated."""
    Q, worst = _turn(), 0.0
    for size in _SIZES[1:]:
        motion = _motion(size)
        rested = _walk(law, [*motion, motion[-1]])[-1]
        spun = _walk(law, [*motion, Q @ motion[-1]])[-1]
        end = _walk(law, motion)[-1]
        still = Increment(stress=end.stress, memory=end.law, strain=np.zeros((1, 3, 3)), span=_SPAN)
        rounding = 1e-5 * float(
            np.abs(law.moduli(still)).max()
        )  # a strain of 1e-14 matters where the viscosity is large
        scale = max(rounding, *(float(np.abs(m.stress).max()) for m in _walk(law, motion)))
        told = "stress does not rotate with a spinning body"
        worst = max(worst, close(spun.stress, Q @ rested.stress @ Q.T, 1e-9, law, told, scale))
    return worst


def _turn() -> Array:
    """A rotation (3, 3) by 100 degrees about an oblique axis."""
    turn, _ = np.linalg.qr(np.array([[1.0, 2.0, 0.5], [-1.0, 0.3, 2.0], [0.7, -1.0, 1.0]]))
    return np.asarray(turn * np.sign(np.linalg.det(turn)))


def _motion(size: float) -> list[Array]:
    """Deformation gradients (3, 3) of a path with shear and rotation."""
    H = size * np.array([[0.3, 1.0, -0.1], [0.0, -0.2, 0.3], [0.05, -0.4, 0.2]])
    return [np.eye(3) + k * H + 0.1 * k * k * H @ H for k in (0.0, 0.5, 1.0, 0.2)]


def _walk(law: RateLaw, motion: list[Array]) -> list[MaterialState]:
    """State of a point after each slab of a motion that begins undeformed, possibly rotated."""
    points = RatePoints(law=law, free=(), directions=np.eye(3)[None])
    memory = initial_history(law.virgin(1), (1, 3), 1, 0)
    F0, found = motion[0], []
    for F in motion[1:]:
        H0, H1 = ((G - np.eye(3)).T[None] for G in (F0, F))
        answer = points.respond(H0, H1, memory, _SPAN)
        memory = points.committed(answer, memory, np.zeros((1, 3)))
        found.append(memory)
        F0 = F
    return found


RATE_LAW = (
    Examination(name="single and array evaluation agree", look=_shapes, allowed=1e-13),
    Examination(name="stress and moduli are symmetric", look=_symmetries, allowed=1e-12),
    Examination(name="moduli are the derivative of the stress", look=_moduli, allowed=1e-6),
    Examination(name="sudden small strains follow the elastic moduli", look=_elastic, allowed=1e-6),
    Examination(name="dissipation is never negative", look=_dissipation, allowed=1e-12),
    Examination(name="stored plus dissipated energy is the work of the stress", look=_energies, allowed=1e-2),
    Examination(name="only relaxation at rest", look=_rest, allowed=1e-8),
    Examination(name="objective under rotation of the body", look=_turned, allowed=1e-9),
    Examination(name="objective under spin of a deformed body", look=_spun, allowed=1e-9),
)
