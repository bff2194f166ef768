"""Refusals of the text of a scenario: units, names, tables, overrides and modules."""

from math import inf
from pathlib import Path

import numpy as np
from try_it import PLANE, SOLID, UNITS, Call, Table, Try

from softway.bodies.prescribed_motion import Still
from softway.bodies.solid import Solid, Tool
from softway.laws.bulk.linear_elastic import LinearElastic
from softway.meshes.generators.recipes import Interval, Rectangle
from softway.obstacles.signed_distance import SignedDistance
from softway.scenario.checks.check import check
from softway.scenario.example_law import law_named
from softway.scenario.files import dumps, load, loads, parsed
from softway.scenario.scenario import Output, Scenario, Time
from softway.scenario.text.override import overridden

B, LAW = "bodies.b", "bodies.b.material"
DATA = {"time": {"end": 1}, "bodies": {"b": {"velocity": [1, 2]}}, "contacts": []}
BODY = Solid(mesh=Interval(length=1.0, cells=2), material=LinearElastic(E=1.0), density=1.0)


def changed(wrong: str, remedy: str, right: str) -> Call:
    """Change of the data that is wrong, and one that follows the remedy."""
    return Call(lambda _: overridden(DATA, [wrong]), remedy, lambda _: overridden(DATA, [right]))


def read(wrong: str, remedy: str, right: str, then: str = "") -> Call:
    """Part of a text that is wrong, and another one."""
    text = PLANE.replace("[time]\nend = 0.01", "")
    return Call(lambda _: loads(text + wrong, units=UNITS), remedy, lambda _: loads(text + right, units=UNITS), then)


def copies(wrong: str, remedy: str, right: str) -> Call:
    """Copies of a ball that are wrong, and others."""
    ball = "[bodies.a]\nkind='Solid'\nmesh={kind='Disc', radius=0.1, cells=2}\nmaterial='glass'\ncopies="
    return read(f"{ball}{wrong}\n[time]\nend=1", remedy, f"{ball}{right}\n[time]\nend=1")


def scenario(**given: object) -> Scenario:
    """Scenario of a bar with other parts."""
    return Scenario(**{"bodies": {"b": BODY}, "time": Time(end=0.1), **given})  # type: ignore[arg-type]


def file(name: str, remedy: str) -> Call:
    """Scenario file that is wrong, and one that is right."""
    return Call(
        lambda folder: load(folder / name, units=UNITS), remedy, lambda folder: load(folder / "plane.toml", units=UNITS)
    )


def tool(folder: Path, **given: object) -> Tool:
    return Tool(shape=SignedDistance(**{"function": lambda x: x[:, 1], "dim": 2, **given}))  # type: ignore[arg-type]


def plane(shape: Tool) -> object:
    """Check of a square above a tool."""
    import softway as sw

    body = sw.Solid(
        mesh=Rectangle(size=(1.0, 1.0), cells=(3, 3), origin=(0.0, 0.01)), material=LinearElastic(E=1.0), density=1.0
    )
    return check(
        sw.Scenario(
            bodies={"b": body, "w": shape}, contacts=(sw.Contact(between=("b.bottom", "w")),), time=Time(end=0.01)
        )
    )


TABLE: Table = {
    "truth for a number": Try(PLANE, "time.end=true", '"2 ms"', "time.end=2 ms"),
    "text for a number": Try(PLANE, "time.end=soon", '"2 ms"', "time.end=2 ms"),
    "no unit": Try(PLANE, "time.end='2'", '"2 ms"', "time.end=2 ms"),
    "unknown unit": Try(PLANE, "time.end=2 blinks", '"2 ms"', "time.end=2 ms"),
    "decimal comma": Try(PLANE, "time.end=2,5 ms", "a decimal point", "time.end=2.5 ms"),
    "another dimension": Try(PLANE, "time.end=2 mm", '"2 ms"', "time.end=2 ms"),
    "infinite": Try(PLANE, "time.end=inf", '"2 ms"', "time.end=2 ms"),
    "no change": changed("time.end", "path=value", "time.end=2"),
    "no path": changed("time:end=2", "names and positions", "time.end=2"),
    "no entry": changed("contacts[0].name=a", "without a position", "contacts=[]"),
    "beyond the entries": changed("bodies.b.velocity[2]=1", "below 2", "bodies.b.velocity[1]=1"),
    "no table": changed("time.end.at=1", "time.end=...", "time.end=1"),
    "no such body": changed("bodies.c.density=1", "b", "bodies.b.density=1"),
    "no list": changed("loads[0].on=a", "add the entry in the file", "loads=[]"),
    "words": Try(PLANE, f"{B}.dilatation=mian", "mean", f"{B}.dilatation=mean"),
    "whole number": Try(PLANE, f"{B}.mesh.cells=[1.5, 2]", "a whole number", f"{B}.mesh.cells=[1, 2]"),
    "truth": Try(PLANE, "output.audit=1", "true or false", "output.audit=true"),
    "list": Try(PLANE, f"{B}.supports=left", "a list in square brackets", f"{B}.supports=[{{on='left'}}]"),
    "entries": Try(PLANE, f"{B}.mesh.size=[1]", "a list of 2 entries", f"{B}.mesh.size=[1, 1]"),
    "bodies": Try(PLANE, "bodies=3", "[bodies.NAME]", "bodies={}", "no Solid"),
    "word or number": Try(PLANE, "time.step=2 mm", "'auto'", "time.step=auto"),
    "no kind": Try(PLANE, f"{LAW}={{E=1}}", "LinearElastic", f"{LAW}.kind=LinearElastic"),
    "unknown kind": Try(PLANE, f"{LAW}.kind=NeoHook", "NeoHookean", f"{LAW}.kind=NeoHookean"),
    "not a kind": Try(
        PLANE, f"{B}.mesh=3", "Rectangle", f"{B}.mesh={{kind='Rectangle', size=[1, 1], cells=[3, 3], origin=[0, 0.01]}}"
    ),
    "no table for an object": Try(PLANE, "output=3", "a table with", "output={}"),
    "kind of one": Try(PLANE, "output={kind='Outpt'}", "Output", "output.kind=Output"),
    "unknown key": read("[time]\nend = 1\nstp = 1", "step", "[time]\nend = 1\nstep = 1"),
    "key elsewhere": read("[time]\nend = 1\nloads = []", "at the top level", "loads = []\n[time]\nend = 1", "known"),
    "key of a body": Call(
        lambda _: loads("supports = [{ on = 'bottom' }]" + PLANE, units=UNITS),
        "bodies.NAME.supports",
        lambda _: loads(PLANE.replace(SOLID, SOLID + "supports = [{ on = 'bottom' }]\n"), units=UNITS),
    ),
    "key of a load": Call(
        lambda _: loads("gravity = [0, -9.81]\n" + PLANE, units=UNITS),
        '[[loads]] with kind = "Gravity"',
        lambda _: loads(PLANE + '[[loads]]\nkind = "Gravity"\nacceleration = [0, -9.81]', units=UNITS),
    ),
    "rigid wall": Call(
        lambda _: loads(PLANE + "[walls.floor]\nnormal = [0, 1]", units=UNITS),
        '[bodies.walls] with kind = "Tool"',
        lambda _: loads(
            PLANE + "[bodies.floor]\nkind = 'Tool'\nshape = { kind = 'HalfSpace', point = [0, 0], normal = [0, 1] }",
            units=UNITS,
        ),
    ),
    "missing key": read("[time]", "end =", "[time]\nend = 1"),
    "missing mesh": Try(PLANE, f"{B}.mesh={{kind='MeshFile'}}", "add path", f"{B}.mesh.path=tagged.inp & contacts=[]"),
    "no dataclass": Try(
        PLANE, f"{LAW}={{kind='own_law:distance'}}", "@dataclass", f"{LAW}={{kind='own_law:Law', E=1}}"
    ),
    "no law": Try(PLANE, f"{LAW}={{kind='own_law:Empty'}}", "add the members", f"{LAW}={{kind='own_law:Law', E=1}}"),
    "no form": Try(PLANE, f"{LAW}={{kind='own-law:Law'}}", "module:name", f"{LAW}={{kind='own_law:Law', E=1}}"),
    "installed": Try(
        PLANE, f"{LAW}={{kind='math:pi'}}", "math.py in that folder", f"{LAW}={{kind='own_law:Law', E=1}}"
    ),
    "name of Python": Try(
        PLANE, f"{LAW}={{kind='json:Law'}}", "another name for json.py", f"{LAW}={{kind='own_law:Law', E=1}}"
    ),
    "needs a module": Try(
        PLANE, f"{LAW}={{kind='needy_law:Law'}}", "install no_such_module", f"{LAW}={{kind='own_law:Law', E=1}}"
    ),
    "no module": Try(
        PLANE, f"{LAW}={{kind='softway.laws.own:Law'}}", "next to the scenario", f"{LAW}={{kind='own_law:Law', E=1}}"
    ),
    "broken module": Try(
        PLANE, f"{LAW}={{kind='broken_law:Law', E=1}}", "correct the module", f"{LAW}={{kind='own_law:Law', E=1}}"
    ),
    "no such class": Try(PLANE, f"{LAW}={{kind='own_law:Lwa', E=1}}", "Law", f"{LAW}={{kind='own_law:Law', E=1}}"),
    "constructor": Try(
        PLANE, f"{LAW}={{kind='own_law:Fails', E=1}}", "own_law.Fails", f"{LAW}={{kind='own_law:Law', E=1}}"
    ),
    "folder": file(".", "a TOML file"),
    "no file": file("plane.tml", "plane.toml"),
    "bytes": file("bytes.toml", "UTF-8"),
    "syntax": file("syntax.toml", "name = value"),
    "nested": Call(
        lambda _: parsed("a = " + "[" * 60 + "]" * 60, "text"), "only the tables", lambda _: parsed("a = []", "text")
    ),
    "no scenario": Call(
        lambda _: check("plane.toml"), "softway.load", lambda folder: check(load(folder / "plane.toml", units=UNITS))
    ),  # type: ignore[arg-type]
    "wrong type": Call(lambda _: check(scenario(title=3)), "text", lambda _: check(scenario(title="3"))),
    "no name": Call(
        lambda _: check(scenario(bodies={3: BODY})), "a text as a name", lambda _: check(scenario(bodies={"3": BODY}))
    ),
    "a tuple": Call(
        lambda _: check(
            scenario(
                contacts=(),
                bodies={
                    "b": Solid(mesh=Rectangle(size=(1.0,), cells=(1, 1)), material=LinearElastic(E=1.0), density=1.0)
                },
            )
        ),
        "a tuple of 2 entries",
        lambda _: check(scenario()),
    ),  # type: ignore[arg-type]
    "number": Call(lambda _: Time(end="2 s"), "a number in SI units", lambda _: Time(end=2.0)),  # type: ignore[arg-type]
    "writing functions": Call(
        lambda _: dumps(scenario(bodies={"b": BODY, "w": tool(_)})), "from Python only", lambda _: dumps(scenario())
    ),
    "law of a command": Call(lambda _: law_named("NeoHook"), "NeoHookean", lambda _: law_named("NeoHookean")),
    "writing classes": Call(lambda _: dumps(scenario(solver=Still())), "FixedPoint", lambda _: dumps(scenario())),
    "writing infinities": Call(
        lambda _: dumps(scenario(output=Output(fields_every=inf))), "a finite number", lambda _: dumps(scenario())
    ),
    "no obstacle": Call(lambda _: Tool(shape=3), "HalfSpace", lambda _: tool(_)),  # type: ignore[arg-type]
    "dimension": Call(lambda _: tool(_, dim=4), "1, 2 or 3", lambda _: tool(_, dim=3)),
    "no function": Call(lambda _: tool(_, function=3), "a function of points", lambda _: tool(_)),
    "function of no module": Call(
        lambda _: tool(_, function="nomod:f"), "package.module:name", lambda _: tool(_, function="math:hypot")
    ),
    "answer": Call(lambda _: plane(tool(_, function=lambda x: 1.0)), "shape (", lambda _: plane(tool(_))),
    "gap elsewhere": Call(
        lambda _: tool(_).shape.gap(np.zeros((1, 3))), "3", lambda _: tool(_, dim=3).shape.gap(np.zeros((1, 3)))
    ),
    "copies without places": copies("3", "vectors or tables", "[[0, 2]]"),
    "copies without a place": copies("[{velocity=[0, 0]}]", "at = ", "[{at=[0, 2], velocity=[0, 0]}]"),
    "copies of a lattice by one number": copies(
        "{count=2, spacing=[1, 1]}", "count = [", "{count=[2, 1], spacing=[2, 2]}"
    ),
    "too many copies": copies("{count=[200, 200], spacing=[1, 1]}", "at most", "{count=[2, 1], spacing=[2, 2]}"),
    "copies of a lattice by other words": copies("{counts=[2, 1]}", "count = [", "{count=[2, 1], spacing=[2, 2]}"),
    "copies of a lattice in one direction": copies(
        "{count=[2, 1], spacing=[2]}", "[5, 3]", "{count=[2, 1], spacing=[2, 2]}"
    ),
    "copies of a group": copies("[[0, 9]]\ngroup=1", "a list", "[[0, 9]]\ngroup=[{translation=[0, 1]}]"),
    "copies of a tool": copies("[[0, 9]]\n[bodies.t]\nkind='Tool'\ncopies=[[0]]", "of a Solid", "[[0, 9]]"),
    "copies with a name that exists": read(
        "[bodies.a]\ncopies=[[0, 0]]\n[bodies.a1]\n[time]\nend=1",
        "another name",
        "[time]\nend=1",
    ),
}
