"""Refusals of time, solver, output and probes."""

from try_it import BAR, PLANE, Call, Table, Try

from softway.bodies.solid import Solid
from softway.laws.bulk.linear_elastic import LinearElastic
from softway.marching.march import march
from softway.meshes.generators.recipes import Interval
from softway.model.build import build
from softway.model.model import Model
from softway.model.scene import Scene
from softway.record.write.probes import readings
from softway.scenario.scenario import Probe

BARS = {"b": Interval(length=1.0, cells=2).build()}
END = "time.weight={kind='Collocation', at=[1], weights=[1]}"
HELD = "bodies.b.supports=[{on='left'}]"
CALM = "contacts[0].timing={kind='Energy', calm=0.2}"
LOCATED = "contacts[0].timing={kind='Energy', located=true}"
LARGE = "bodies.b.material.kind=NeoHookean"
MOVING = "bodies.w.motion={kind='Translation', velocity=[0, 0.1]}"
ROUGH = "contacts[0].friction={kind='Coulomb', mu=0.3}"
BESIDE = f"{PLANE}[bodies.r]\nkind = 'Rigid'\nmass = 1\ncentre = [5, 5]\ninertia = 1\n"
MOMENTUM = "time.weight=Momentum"
WARM = "{temperature=300, expansion=1e-5, law={kind='Conduction', conductivity=1, capacity=1}}"


def bar() -> Model:
    """Model of a bar."""
    body = Solid(mesh=BARS["b"], material=LinearElastic(E=1.0), density=1.0)
    return build(Scene(bodies={"b": body}))


PROBE = "output.probes=[{name='p', of='b', tag='top', component='y'}]"
TABLE: Table = {
    "end": Try(PLANE, "time.end=0", "2 ms", "time.end=2 ms"),
    "step": Try(PLANE, "time.step=0", "1 us", "time.step=1 us"),
    "step, auto": Try(PLANE, "time.step=0", '"auto"', "time.step=auto"),
    "long step": Try(PLANE, "time.step=1", "a shorter step", "time.step=0.01"),
    "too many slabs": Try(PLANE, "time.step=1e-12", "longer slabs", "time.step=1e-3"),
    "too many slabs, end": Try(PLANE, "time.step=1e-12", "an earlier end", "time.end=1e-9"),
    "theta": Try(PLANE, "time.weight={kind='EndPeaks', theta=0.4}", "[0.5, 1]", "time.weight.theta=0.5"),
    "Gauss points": Try(
        PLANE, "time.weight={kind='Momentum', points=1}", "2 or more", "time.weight.points=2", "EndPeaks"
    ),
    "weights": Try(
        PLANE,
        "contacts=[] & time.weight={kind='Collocation', at=[0.5, 1], weights=[1]}",
        "one weight per peak",
        "time.weight.weights=[0.5, 0.5]",
    ),
    "peaks": Try(
        PLANE,
        "contacts=[] & time.weight={kind='Collocation', at=[2], weights=[1]}",
        "between 0 and 1",
        "time.weight.at=[1]",
    ),
    "sum": Try(
        PLANE,
        "contacts=[] & time.weight={kind='Collocation', at=[1], weights=[2]}",
        "sum to 1",
        "time.weight.weights=[1]",
    ),
    "unstable": Try(
        PLANE,
        "contacts=[] & time.weight={kind='Collocation', at=[0.25], weights=[1]}",
        "at least 1/2",
        "time.weight.at=[0.5]",
    ),
    "control": Try(PLANE, "time.control={approach=-1}", "a positive number", "time.control.approach=1"),
    "error of a slab": Try(PLANE, "time.tolerance=0", "1e-2", "time.tolerance=1e-2"),
    "error, explicit": Try(PLANE, "time.tolerance=1e-2 & solver=Explicit", "FixedPoint", "solver=FixedPoint"),
    "error, weight": Try(
        PLANE, f"time.tolerance=1e-2 & contacts=[] & {MOMENTUM}", "EndPeaks with theta = 0.5", "time.weight=EndPeaks"
    ),
    "error, no inertia": Try(PLANE, f"time.tolerance=1e-2 & inertia=Off & {HELD}", "omit it", "time={end=0.01}"),
    "error, rigid": Try(BESIDE, "time.tolerance=1e-2", "omit it", "time={end=0.01}"),
    "error, heat": Try(PLANE, f"time.tolerance=1e-2 & bodies.b.thermal={WARM}", "omit it", "time={end=0.01}"),
    "tolerance": Try(PLANE, "solver={kind='FixedPoint', tolerance=1}", "at most 1e-2", "solver.tolerance=1e-2"),
    "limit": Try(PLANE, "solver={kind='Newton', limit=0}", "at least 1", "solver.limit=1"),
    "depth": Try(PLANE, "solver={kind='FixedPoint', depth=-1}", "about 8", "solver.depth=8"),
    "depth, plain": Try(PLANE, "solver={kind='FixedPoint', depth=-1}", "0 for the plain", "solver.depth=0"),
    "safety": Try(PLANE, "solver={kind='Explicit', safety=2}", "at most 1", "solver.safety=1"),
    "products": Try(
        PLANE,
        "solver={kind='FixedPoint', operator={kind='MatrixFree', tolerance=2}}",
        "between 0 and 1",
        "solver.operator.tolerance=0.1",
    ),
    "number of products": Try(
        PLANE,
        "solver={kind='FixedPoint', operator={kind='MatrixFree', limit=0}}",
        "at least 1",
        "solver.operator.limit=9",
    ),
    "backend": Try(
        PLANE,
        "solver={kind='FixedPoint', operator={kind='Factored', backend='SuperLUU'}}",
        "superlu",
        "solver.operator.backend=superlu",
    ),
    "frames": Try(PLANE, "output.fields_every=0", '"auto"', "output.fields_every=auto"),
    "frames, time": Try(PLANE, "output.fields_every=0", "a time", "output.fields_every=1 ms"),
    "checkpoints": Try(PLANE, "output.checkpoints={every=-1}", "30 s", "output.checkpoints.every=30 s"),
    "kept checkpoints": Try(PLANE, "output.checkpoints={keep=-1}", "or 2", "output.checkpoints.keep=2"),
    "probe without a name": Try(
        PLANE,
        f"{PROBE} & output.probes[0].name=a[0]",
        "without commas, quotes and brackets",
        "output.probes[0].name=a0",
    ),
    "probe of nobody": Try(PLANE, f"{PROBE} & output.probes[0].of=c", "'b'", "output.probes[0].of=b"),
    "component": Try(PLANE, f"{PROBE} & output.probes[0].component=z", "'y'", "output.probes[0].component=y"),
    "two places": Try(PLANE, "output.probes=[{name='p', of='b'}]", "'tag' or 'at'", "output.probes[0].tag=top"),
    "place": Try(PLANE, "output.probes=[{name='p', of='b', at=[0]}]", "2 coordinates", "output.probes[0].at=[0, 0]"),
    "tag": Try(PLANE, f"{PROBE} & output.probes[0].tag=tp", "top", "output.probes[0].tag=top"),
    "explicit weight": Try(
        PLANE,
        "solver=Explicit & time.weight={kind='Collocation', at=[1], weights=[1]}",
        "the default weight",
        "time.weight=EndPeaks",
    ),
    "explicit weight, solver": Try(
        PLANE, f"solver=Explicit & {END}", "the solver FixedPoint", "solver=FixedPoint & contacts=[]"
    ),
    "explicit without inertia": Try(PLANE, f"solver=Explicit & inertia=Off & {HELD}", "with inertia", "inertia=Full"),
    "explicit without inertia, solver": Try(
        PLANE, f"solver=Explicit & inertia=Off & {HELD}", "FixedPoint", "solver=FixedPoint"
    ),
    "explicit impulse": Try(
        PLANE, "solver=Explicit & contacts[0].timing=Impulse", "Energy", "contacts[0].timing=Energy"
    ),
    "explicit impulse, solver": Try(
        PLANE, "solver=Explicit & contacts[0].timing=Impulse", "FixedPoint", "solver=FixedPoint"
    ),
    "explicit located": Try(
        PLANE, f"solver=Explicit & {LOCATED}", "located = false", "contacts[0].timing.located=false"
    ),
    "explicit located, solver": Try(PLANE, f"solver=Explicit & {LOCATED}", "FixedPoint", "solver=FixedPoint"),
    "explicit calm": Try(PLANE, f"solver=Explicit & {CALM}", "calm = 0", "contacts[0].timing.calm=0"),
    "explicit calm, solver": Try(PLANE, f"solver=Explicit & {CALM}", "FixedPoint", "solver=FixedPoint"),
    "calm beside rigid bodies": Try(BESIDE, CALM, "calm = 0", "contacts[0].timing.calm=0"),
    "located, large": Try(PLANE, f"{LOCATED} & {LARGE}", "located = false", "contacts[0].timing.located=false"),
    "located, small": Try(PLANE, f"{LOCATED} & {LARGE}", "LinearElastic", "bodies.b.material.kind=LinearElastic"),
    "located, moving": Try(PLANE, f"{LOCATED} & {MOVING}", "located = false", "contacts[0].timing.located=false"),
    "located, at rest": Try(PLANE, f"{LOCATED} & {MOVING}", "half-spaces at rest", "bodies.w.motion=Still"),
    "located with friction": Try(PLANE, f"{LOCATED} & {ROUGH}", "located = false", "contacts[0].timing.located=false"),
    "peak at the end": Try(PLANE, END, "EndPeaks with theta = 0.5", "time.weight={kind='EndPeaks', theta=0.5}"),
    "peak at the end, Impulse": Try(PLANE, END, "the rule Impulse", "contacts[0].timing=Impulse"),
    "stable step": Try(
        PLANE, f"contacts=[] & {MOMENTUM} & time.step=0.9 & time.end=0.9", "a step of at most", "time.step=0.1"
    ),
    "stable weight": Try(
        PLANE, f"contacts=[] & {MOMENTUM} & time.step=0.9 & time.end=0.9", "EndPeaks", "time.weight=EndPeaks"
    ),
    "quantity": Call(
        lambda _: readings([Probe(name="p", of="b", tag="all", quantity="heat")], BARS),
        "velocity",
        lambda _: readings([Probe(name="p", of="b", tag="all", quantity="velocity")], BARS),
    ),  # type: ignore[arg-type]
    "nothing to march": Call(
        lambda _: next(march(bar(), until=0.0)), "an end after the start", lambda _: next(march(bar(), until=1.0))
    ),
    "no step to march": Call(
        lambda _: next(march(bar(), until=1.0, step=0.0)), "'auto'", lambda _: next(march(bar(), until=1.0))
    ),
    "triangle": Try(
        PLANE,
        "contacts[0].timing={kind='Paper', split='triangle'}",
        "split = 'product'",
        "contacts[0].timing.split=product",
    ),
    "triangle inside": Try(
        BAR,
        "contacts[0].timing={kind='Paper', split='triangle'} & contacts[0].between=['b.all', 'w']",
        "tags at the ends",
        "contacts[0].between=['b.left', 'w']",
    ),
}
