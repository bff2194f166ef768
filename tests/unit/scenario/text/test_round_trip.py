"""Reading and writing are inverse, over random scenarios with every kind that text can describe."""

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from softway.bodies.elements.section import Axisymmetric, Bar, PlaneStrain, PlaneStress, Volume
from softway.bodies.inertia.mass_matrix import Consistent, Lumped
from softway.bodies.internal_force.slab_average import AverageField, DiscreteGradient, Weighted
from softway.bodies.prescribed_motion import Still, Table, Translation, Turning
from softway.bodies.setup.initial_fields import Affine, FieldSum, OnTag, Profile, Uniform
from softway.bodies.setup.loads import Gravity, Traction
from softway.bodies.setup.placement import Placement, Rotation
from softway.bodies.solid import Fixed, Solid, Tool
from softway.contact.contact import Contact
from softway.contact.impact_rule import Energy, Impulse, Paper
from softway.laws.bulk import Hencky, LinearElastic, LinearOrthotropic, MooneyRivlin, NeoHookean, StVenantKirchhoff
from softway.laws.strain_measures import Green, Small
from softway.mechanisms import DistanceStop, Hinge, PlaneStop, Rigid, Rod, Slider, Spring, Torque, Universal
from softway.meshes.generators.recipes import Ball, Box, Cylinder, Disc, Interval, MeshFile, Rectangle
from softway.model.scene import AsGiven, StaticStart
from softway.model.time_weight import Collocation, EndPeaks, Momentum
from softway.obstacles.half_space import HalfSpace
from softway.scenario.files import dumps
from softway.scenario.files import loads as read
from softway.scenario.hints.units_text import Units
from softway.scenario.scenario import Output, Probe, Scenario, Time
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.newton import Newton

UNITS = Units.standard()
real = st.floats(-1e12, 1e12, allow_nan=False)
positive = st.floats(1e-9, 1e12)
count = st.integers(1, 9)
word = st.text("abcdefghijklmnopqrstuvwxyz_", min_size=1, max_size=8)
title = st.text(st.characters(blacklist_categories=["Cs"]), max_size=20)
pair = st.tuples(real, real)
triple = st.tuples(real, real, real)
vector = st.one_of(real, st.tuples(real), pair, triple)


@st.composite
def halfspaces(draw):
    """Planes whose normal is a unit vector already."""
    axis = draw(st.integers(0, 2))
    normal = tuple(draw(st.sampled_from([-1.0, 1.0])) if k == axis else 0.0 for k in range(3))
    return HalfSpace(point=draw(triple), normal=normal)


meshes = st.one_of(
    st.builds(Interval, length=positive, cells=count, origin=vector, dim=st.sampled_from([None, 2, 3])),
    st.builds(Rectangle, size=st.tuples(positive, positive), cells=st.tuples(count, count), origin=pair),
    st.builds(Box, size=st.tuples(positive, positive, positive), cells=st.tuples(count, count, count)),
    st.builds(Disc, radius=positive, cells=count, centre=pair),
    st.builds(Cylinder, radius=positive, height=positive, cells=st.tuples(count, count)),
    st.builds(Ball, radius=positive, cells=count, centre=triple),
    st.builds(
        MeshFile,
        path=word.map(lambda w: f"/meshes/{w}.msh"),
        unit=st.sampled_from(["m", "mm"]),
        cells=st.one_of(st.none(), st.just(("tet4", "hex8"))),
    ),
)
modulus, poisson = positive, st.floats(0.0, 0.49)
orthotropic = st.builds(
    LinearOrthotropic,
    E=st.tuples(modulus, modulus, modulus),
    nu=st.just((0.0, 0.0, 0.0)),
    G=st.tuples(modulus, modulus, modulus),
    axes=st.sampled_from([((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), ((1.0, 2.0, 0.0), (-2.0, 1.0, 0.0))]),
    measure=st.sampled_from([Small(), Green()]),
)
isotropic = (st.builds(c, E=modulus, nu=poisson) for c in (LinearElastic, NeoHookean, StVenantKirchhoff, Hencky))
materials = st.one_of(*isotropic, st.builds(MooneyRivlin, c10=modulus, c01=modulus, bulk=modulus), orthotropic)
sections = st.one_of(
    st.none(),
    st.builds(Bar, area=positive),
    st.builds(PlaneStrain, thickness=positive),
    st.builds(PlaneStress, thickness=positive),
    st.just(Axisymmetric()),
    st.just(Volume()),
)
simple_fields = st.one_of(
    st.builds(Uniform, value=vector),
    st.builds(Affine, value=vector, gradient=st.one_of(real, st.tuples(pair, pair)), origin=vector),
    st.builds(Profile, axis=st.sampled_from("xyz"), at=pair, values=st.one_of(pair, st.tuples(pair, pair))),
    st.builds(OnTag, tag=word, value=vector),
)
fields = st.one_of(simple_fields, st.builds(FieldSum, terms=st.lists(simple_fields, max_size=2).map(tuple)))
rotations = st.builds(Rotation, angle=st.floats(-7, 7), axis=st.tuples(real, real, st.floats(1e-3, 1e3)))
places = st.builds(
    Placement,
    rotations=st.lists(rotations, max_size=2).map(tuple),
    translation=st.one_of(st.just(()), vector),
    bottom=st.one_of(st.none(), real),
)
solids = st.builds(
    Solid,
    mesh=meshes,
    material=materials,
    density=real,
    section=sections,
    mass=st.sampled_from([Consistent(), Lumped()]),
    velocity=fields,
    displacement=fields,
    supports=st.lists(st.builds(Fixed, on=word, components=st.sampled_from(["all", "x", "yz"])), max_size=2).map(tuple),
    force=st.sampled_from([Weighted(), AverageField(points=2), DiscreteGradient()]),
    place=places,
)
motions = st.one_of(
    st.just(Still()),
    st.builds(Translation, velocity=triple),
    st.builds(Table, times=st.just((-1.0, 0.0, 1e-3)), displacements=st.tuples(triple, triple, triple)),
    st.builds(Turning, point=triple, rate=real, axis=st.tuples(real, real, st.floats(1e-3, 1e3))),
)
tools = st.builds(Tool, shape=halfspaces(), motion=motions)
timings = st.one_of(
    st.builds(Paper, approach=st.sampled_from(["kept", "extrapolated"])),
    st.just(Impulse()),
    st.builds(Energy, located=st.booleans()),
)
contacts = st.builds(Contact, between=st.tuples(word, word), name=word, timing=timings)
loads = st.lists(
    st.one_of(st.builds(Gravity, acceleration=vector), st.builds(Traction, on=word, value=vector)), max_size=2
).map(tuple)
weights = st.one_of(
    st.builds(Momentum, points=st.integers(2, 5)),
    st.just(Collocation(at=(0.25, 1.0), weights=(0.5, 0.5))),
    st.builds(EndPeaks, theta=st.floats(0.5, 1.0)),
)
times = st.builds(Time, end=positive, step=st.one_of(st.just("auto"), positive), weight=weights)
solvers = st.one_of(
    st.builds(FixedPoint, depth=st.integers(0, 9), tolerance=st.floats(1e-14, 1e-3)), st.builds(Newton, limit=count)
)
probes = st.one_of(
    st.builds(Probe, name=word, of=word, tag=word, quantity=st.sampled_from(["velocity", "reaction"])),
    st.builds(Probe, name=word, of=word, at=triple, component=st.sampled_from(["x", "norm"])),
)
outputs = st.builds(
    Output, fields_every=st.one_of(st.just("auto"), positive), probes=st.lists(probes, max_size=2).map(tuple)
)
flat = st.tuples(real, real)
names = st.tuples(word, word)
rigid = st.one_of(
    st.builds(Rigid, mass=positive, centre=flat, inertia=positive, velocity=flat, spin=real),
    st.builds(Rigid, mass=positive, centre=triple, inertia=st.just((1.0, 1.0, 1.0)), spin=triple),
)
joints = st.one_of(
    st.builds(Hinge, between=names, at=flat),
    st.builds(Hinge, between=names, at=triple, axis=triple),
    st.builds(Slider, between=names, at=flat, axis=flat),
    st.builds(Universal, between=names, at=triple, axes=st.just(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))),
    st.builds(Rod, between=names, ends=st.tuples(flat, flat)),
)
stops = st.one_of(
    st.builds(PlaneStop, between=names, point=flat, plane=flat, normal=st.just((0.0, 1.0)), radius=positive),
    st.builds(DistanceStop, between=names, points=st.tuples(flat, flat), distance=positive),
)
springs = st.builds(Spring, between=names, ends=st.tuples(flat, flat), rest=st.one_of(st.none(), positive))
scenarios = st.builds(
    Scenario,
    title=title,
    bodies=st.dictionaries(word, st.one_of(solids, tools, rigid), max_size=3),
    joints=st.dictionaries(word, joints, max_size=2),
    stops=st.dictionaries(word, stops, max_size=2),
    springs=st.lists(springs, max_size=2).map(tuple),
    torques=st.lists(st.builds(Torque, on=word, value=st.one_of(real, triple)), max_size=2).map(tuple),
    impacts=st.sampled_from(["simultaneous", "sequential"]),
    time=times,
    contacts=st.lists(contacts, max_size=2).map(tuple),
    loads=loads,
    start=st.one_of(st.just(AsGiven()), st.builds(StaticStart, loads=loads)),
    solver=solvers,
    output=outputs,
)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(scenarios)
def test_what_is_written_is_read_back(scenario):
    assert read(dumps(scenario), units=UNITS) == scenario


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(scenarios)
def test_written_text_is_a_fixed_point(scenario):
    text = dumps(scenario)
    assert dumps(read(text, units=UNITS)) == text
