"""Catalogue of the cases."""

import difflib
from collections.abc import Iterable, Mapping

from softway.apps.verify.case import Case
from softway.errors import InputError

QUICK = 9.5
"""Greatest computing time of a case in the quick suite [s]."""


CASES: Mapping[str, tuple[float, str]] = {
    "A01": (0.1, "waves.a01_amplification_matrix"),
    "A02": (3.0, "waves.a02_bar_on_wall"),
    "A03": (9.0, "waves.a03_two_element_bar"),
    "A04": (4.0, "waves.a04_struck_bar"),
    "A05": (6.0, "waves.a05_struck_bar_with_stop"),
    "A06": (5.0, "waves.a06_struck_continuum_bar"),
    "A07": (14.0, "waves.a07_equal_bars"),
    "A08": (45.0, "waves.a08_unequal_bars"),
    "A09": (45.0, "waves.a09_bouncing_bar"),
    "A10": (4.0, "waves.a10_rod_in_inches"),
    "A11": (12.0, "waves.a11_released_bar"),
    "A12": (1.5, "waves.a12_steel_bar"),
    "B01": (3.0, "contact.b01_patch_test"),
    "B02": (17.0, "contact.b02_plane_wave"),
    "B03": (0.3, "contact.b03_cylinder_on_plane"),
    "B04": (1.0, "contact.b04_hemisphere_on_plane"),
    "B05": (1.0, "contact.b05_ball_impact"),
    "B06": (0.5, "contact.b06_press_fit"),
    "B07": (1.0, "contact.b07_cattaneo_mindlin"),
    "B08": (2.0, "contact.b08_disc_on_wall"),
    "B09": (90.0, "contact.b09_fast_thin_bodies"),
    "C01": (8.0, "friction.c01_block_on_incline"),
    "C02": (10.0, "friction.c02_sprung_mass_to_rest"),
    "C03": (30.0, "friction.c03_stick_slip_belt"),
    "C04": (6.0, "friction.c04_viscoplastic_friction"),
    "C05": (120.0, "friction.c05_rolling_on_incline"),
    "C06": (100.0, "friction.c06_sliding_to_rolling"),
    "C07": (0.1, "friction.c07_rod_end_collision"),
    "C08": (8.0, "friction.c08_friction_oscillator"),
    "C09": (8.0, "friction.c09_slope_stick_or_slip"),
    "D01": (0.6, "large_deformation.d01_simple_shear_rates"),
    "D02": (0.3, "large_deformation.d02_rotated_stress"),
    "D03": (0.3, "large_deformation.d03_closed_cycle"),
    "D04": (7.0, "large_deformation.d04_uniaxial_hypoelastic"),
    "D05": (75.0, "large_deformation.d05_swinging_bar"),
    "D06": (50.0, "large_deformation.d06_spinning_bar"),
    "D07": (0.5, "large_deformation.d07_cooks_membrane"),
    "D08": (0.6, "large_deformation.d08_elastica"),
    "D09": (80.0, "large_deformation.d09_taylor_bar"),
    "D10": (1.7, "large_deformation.d10_plastic_shear"),
    "E01": (2.0, "forming.e01_frictionless_upsetting"),
    "E02": (8.0, "forming.e02_upsetting_with_friction"),
    "E03": (10.0, "forming.e03_ring_test"),
    "E04": (4.0, "forming.e04_viscous_slice"),
    "E05": (6.0, "forming.e05_necking_strip"),
    "E06": (1.5, "forming.e06_plastic_upsetting"),
    "F01": (1.3, "mechanisms.f01_pendulum"),
    "F02": (0.2, "mechanisms.f02_double_pendulum"),
    "F03": (15.0, "mechanisms.f03_four_bar_loops"),
    "F04": (1.5, "mechanisms.f04_slider_crank"),
    "F05": (0.4, "mechanisms.f05_squeezer"),
    "F06": (0.2, "rigid_contact.f06_bouncing_ball"),
    "F07": (0.5, "rigid_contact.f07_rocking_block"),
    "F08": (0.8, "rigid_contact.f08_pendulum_and_wall"),
    "F09": (12.0, "rigid_contact.f09_woodpecker"),
    "F10": (12.0, "rigid_contact.f10_painleve_rod"),
    "F11": (0.1, "mechanisms.f11_free_top"),
    "F12": (0.4, "mechanisms.f12_bricard"),
    "G01": (5.5, "heat.g01_freezing_water"),
    "G02": (0.6, "heat.g02_adiabatic_compression"),
    "G03": (0.5, "heat.g03_braking_block"),
    "G04": (1.8, "heat.g04_closing_gap"),
    "I01": (3.0, "refinement.i01_contact_times"),
    "I02": (2.0, "refinement.i02_standing_wave"),
    "I03": (20.0, "refinement.i03_adapted_bar"),
    "I04": (20.0, "refinement.i04_hertz_ball"),
    "classic": (1.0, "classic"),
    "peers": (3.0, "peers"),
}
"""Computing time of each case alone on one core [s], and its module below ``cases``."""


def listed() -> tuple[Case, ...]:
    """All cases in order.

    Examples
    --------
    >>> [case.id for case in listed()][:3]
    ['A01', 'A02', 'A03']
    """
    return tuple(
        Case(id=name, seconds=seconds, module=f"softway.apps.verify.cases.{module}")
        for name, (seconds, module) in CASES.items()
    )


def chosen(ids: Iterable[str] = (), *, quick: bool = False) -> tuple[Case, ...]:
    """Select cases by ids or beginnings of ids, ignoring case; without any, select all.

    Parameters
    ----------
    ids
        ``A02`` selects this case, ``B`` all cases whose id begins with B.
    quick
        Select only cases that take at most ``QUICK`` seconds.

    Raises
    ------
    InputError
        If an id is unknown, or no case remains.

    Examples
    --------
    >>> [case.id for case in chosen(["a02"])]
    ['A02']
    """
    everything = listed()
    wanted = [word.upper() for word in ids]
    for word in wanted:
        if not any(case.id.upper().startswith(word) for case in everything):
            raise _unknown(word, [case.id for case in everything])
    found = [c for c in everything if not wanted or any(c.id.upper().startswith(word) for word in wanted)]
    kept = tuple(case for case in found if not quick or case.seconds <= QUICK)
    if not kept:
        names = ", ".join(case.id for case in found)
        raise InputError("--quick", f"none of {names} takes less than {QUICK:g} s", "the same command without --quick")
    return kept


def _unknown(word: str, known: list[str]) -> InputError:
    near = difflib.get_close_matches(word, known, n=1, cutoff=0.5)
    guess = f"did you mean {near[0]}? " if near else ""
    return InputError("IDS", f"no case '{word}'", f"{guess}known: {', '.join(known)}")
