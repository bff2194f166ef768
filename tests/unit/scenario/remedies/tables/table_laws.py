"""Refusals of material laws."""

from try_it import PLANE, SPACE, Table, Try

LAW = "bodies.b.material"


def law(wrong: str, remedy: str, follow: str, text: str = PLANE) -> Try:
    """Material with a parameter that is wrong, and the change of one parameter that follows the remedy."""
    return Try(text, f"{LAW}={{{wrong}}}", remedy, f"{LAW}.{follow}")


J2 = "kind='J2', E=1, nu=0.3"
HOFF = "kind='NortonHoff'"
WARM = "bodies.b.thermal={temperature=300, law={conductivity=1, capacity=1}}"
ORTHO = "kind='LinearOrthotropic', E=[1, 1, 1], nu=[0.3, 0.3, 0.3], G=[1, 1, 1]"
TABLE: Table = {
    "E": law("kind='LinearElastic', E=0", "a positive Young's modulus", "E=1"),
    "nu": law("kind='LinearElastic', E=1, nu=0.6", "0.3", "nu=0.3"),
    "nu of rubber": law("kind='NeoHookean', E=1, nu=0.6", "0.49", "nu=0.49"),
    "yield": law(f"{J2}, yield_stress=-1", "zero or more", "yield_stress=1"),
    "no strength": law(f"{J2}, yield_stress=0", "a positive stress", "yield_stress=1"),
    "kinematic": law(f"{J2}, yield_stress=1, kinematic=-1", "zero or more", "kinematic=0"),
    "softening": law(
        f"{J2}, yield_stress=1, hardening={{kind='LinearHardening', modulus=-9}}",
        "a slope above -3 mu",
        "hardening.modulus=-1",
    ),
    "Voce": law(
        f"{J2}, yield_stress=1, hardening={{kind='Voce', saturation=1, exponent=0}}",
        "10 to 20",
        "hardening.exponent=10",
    ),
    "power": law(
        f"{J2}, yield_stress=1, hardening={{kind='PowerHardening', modulus=-1, exponent=0.3}}",
        "zero or more",
        "hardening.modulus=1",
    ),
    "exponent": law(
        f"{J2}, yield_stress=1, hardening={{kind='PowerHardening', modulus=1, exponent=0}}",
        "0.3",
        "hardening.exponent=0.3",
    ),
    "Perzyna drag": law(
        f"{J2}, yield_stress=1, flow={{kind='Perzyna', drag=-1, reference=1}}", "zero or more", "flow.drag=0"
    ),
    "Perzyna reference": law(
        f"{J2}, yield_stress=1, flow={{kind='Perzyna', drag=1, reference=0}}", "a positive rate", "flow.reference=1"
    ),
    "Perzyna exponent": law(
        f"{J2}, yield_stress=1, flow={{kind='Perzyna', drag=1, reference=1, exponent=0.5}}",
        "1 or more",
        "flow.exponent=1",
    ),
    "Johnson-Cook": law(f"{J2}, yield_stress=1, flow={{kind='JohnsonCook', C=-1}}", "0.01 to 0.03", "flow.C=0.02"),
    "Johnson-Cook reference": law(
        f"{J2}, yield_stress=1, flow={{kind='JohnsonCook', C=0.01, reference=0}}", "a positive rate", "flow.reference=1"
    ),
    "melting": Try(
        PLANE,
        f"{LAW}={{{J2}, yield_stress=1, softening={{kind='JohnsonCookSoftening', reference=3, melting=3}}}} & {WARM}",
        "1356 K",
        f"{LAW}.softening.melting=1356",
    ),
    "activation": Try(
        PLANE,
        f"{LAW}={{{HOFF}, K=1, m=0.2, softening={{kind='Arrhenius', activation=-1, reference=1200}}}} & {WARM}",
        "6000 K",
        f"{LAW}.softening.activation=6000",
    ),
    "softening without heat": Try(
        PLANE,
        f"{LAW}={{{J2}, yield_stress=1, softening={{kind='Arrhenius', activation=1, reference=300}}}}",
        "thermal = { temperature",
        WARM,
    ),
    "Norton": law(
        f"{J2}, yield_stress=1, flow={{kind='NortonFlow', K=0, m=0.2}}", "a positive consistency", "flow.K=1"
    ),
    "Norton m": law(f"{J2}, yield_stress=1, flow={{kind='NortonFlow', K=1, m=2}}", "0.2", "flow.m=0.2"),
    "Mooney": law("kind='MooneyRivlin', c10=-1, c01=1, bulk=1000", "c10 >= 0 and c01 >= 0", "c10=1"),
    "no shear": law("kind='MooneyRivlin', c10=0, c01=0, bulk=1000", "a positive constant", "c10=1"),
    "bulk": law("kind='MooneyRivlin', c10=1, c01=0, bulk=0", "2000 times", "bulk=2000"),
    "Hoff K": law(f"{HOFF}, K=0, m=0.2, bulk=1e5", "a positive consistency", "K=1"),
    "Hoff m": law(f"{HOFF}, K=1, m=0, bulk=1e5", "0.2", "m=0.2"),
    "Hoff bulk": law(f"{HOFF}, K=1, m=0.2, bulk=0", "1e5 times K", "bulk=1e5"),
    "Hoff still": law(f"{HOFF}, K=1, m=0.2, bulk=1e5, still=0", "far below", "still=1e-6"),
    "ratio": law(f"{ORTHO}".replace("nu=[0.3", "nu=[2"), "of tension along axis 1", "nu=[0.3, 0.3, 0.3]", SPACE),
    "ratios together": law(
        f"{ORTHO}".replace("0.3, 0.3, 0.3", "0.9, 0.9, 0.9"), "smaller", "nu=[0.3, 0.3, 0.3]", SPACE
    ),
    "skew axes": law(
        f"{ORTHO}, axes=[[1, 0, 0], [1, 1, 0]]", "two perpendicular", "axes=[[1, 0, 0], [0, 1, 0]]", SPACE
    ),
    "modulus": law(f"{ORTHO}".replace("E=[1", "E=[0"), "a positive modulus", "E=[1, 1, 1]", SPACE),
    "Kelvin": law(
        "kind='Kelvin', E=1, nu=0.3, shear_viscosity=-1, bulk_viscosity=0", "zero or more", "shear_viscosity=1"
    ),
    "Maxwell times": law("kind='Maxwell', E=1, nu=0.3, shares=[0.5], times=[]", "a time for each", "times=[1]"),
    "Maxwell shares": law("kind='Maxwell', E=1, nu=0.3, shares=[1.5], times=[1]", "at most 1", "shares=[0.5]"),
    "Maxwell time": law("kind='Maxwell', E=1, nu=0.3, shares=[0.5], times=[0]", "positive relaxation", "times=[1]"),
    "unknown": Try(PLANE, f"{LAW}=steal", "steel", f"{LAW}=steel S235"),
    "law of a name": Try(PLANE, f"{LAW}={{library='steel S235', law='plstic'}}", "plastic", f"{LAW}.law=plastic"),
    "name of a number": Try(PLANE, f"{LAW}={{library=3}}", "steel S235", f"{LAW}.library=steel S235"),
    "no conductivity": Try(
        PLANE,
        f"{LAW}=nylon & bodies.b.thermal={{temperature=300}}",
        "conductivity = ..., capacity = ...",
        "bodies.b.thermal.law={conductivity=0.25, capacity=1670}",
    ),
    "no yield stress": Try(PLANE, f"{LAW}={{library='rubber', law='plastic'}}", "elastic", f"{LAW}.law=elastic"),
}
