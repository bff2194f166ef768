"""Both examples of the paper and the drop of a steel part, with tables of errors and with pictures in demo/.

Run it with ``make demo``, or ``python examples/demo.py [--quick]``; the quick form omits the part.
"""

import sys
import time
from pathlib import Path

import matplotlib as mpl
import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.linalg import eigh
from scipy.optimize import brentq

import softway as sw
from softway.apps.verify.exact import semidiscrete
from softway.apps.verify.exact.thrown import Thrown
from softway.record.view.pictures import pictures

mpl.use("Agg")
import matplotlib.pyplot as plt

ROOT = Path(__file__).resolve().parents[1]
OUT = ROOT / "demo"

CONSOLE = Console(width=100)
GAP = 0.25
STOP = 0.2
RULES = {
    "Paper": (sw.contact.Paper(), sw.bodies.Consistent(), "literal"),
    "Impulse": (sw.contact.Impulse(), sw.bodies.Consistent(), "impulse"),
    "Impulse, lumped": (sw.contact.Impulse(), sw.bodies.Lumped(), "impulse"),
    "Energy": (sw.contact.Energy(), sw.bodies.Consistent(), None),
}


def example_1(
    rule: sw.contact.Paper | sw.contact.Impulse | sw.contact.Energy,
    mass: sw.bodies.Consistent | sw.bodies.Lumped,
    step: float,
) -> list[sw.Step]:
    """Compute a free bar of two elements, L = E = rho = v = 1, that hits a rigid wall at the distance 0.25."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=2),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.Uniform(value=1.0),
        mass=mass,
    )
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.0 + GAP, normal=-1.0))
    contact = sw.Contact(between=("bar.right", "wall"), timing=rule)
    return list(sw.march(sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(contact,)), until=3.0, step=step))


def example_2(stop: float | None, step: float = 0.01) -> list[sw.Step]:
    """Compute the bar fixed at its left end, with the velocity 1 at its tip, without or with a stop."""
    bar = sw.Solid(
        mesh=sw.meshes.Interval(length=1.0, cells=2),
        material=sw.LinearElastic(E=1.0),
        density=1.0,
        velocity=sw.bodies.OnTag(tag="right", value=1.0),
        supports=(sw.Fixed(on="left"),),
    )
    if stop is None:
        return list(sw.march(sw.Scene(bodies={"bar": bar}), until=10.0, step=step))
    wall = sw.Tool(shape=sw.obstacles.HalfSpace(point=1.0 + stop, normal=-1.0))
    contact = sw.Contact(between=("bar.right", "wall"), timing=sw.contact.Impulse())
    return list(sw.march(sw.Scene(bodies={"bar": bar, "wall": wall}, contacts=(contact,)), until=10.0, step=step))


def instant(steps: list[sw.Step], kind: str, number: int = 0) -> float:
    """Time of an event."""
    return [e.time for s in steps for e in s.events if e.kind == kind][number]


def curve(steps: list[sw.Step], node: int) -> tuple[np.ndarray, np.ndarray]:
    """Displacement of a node of the bar over time."""
    states = [steps[0].before] + [s.after for s in steps]
    return np.array([s.time for s in states]), np.array([s.displacement["bar"][node, 0] for s in states])


def massless_contact() -> float:
    """Exact contact duration of the two-element bar with a massless contact node.

    While the tip is held, M u'' + K u = 0 for the rear and the middle node. The bar is released when the middle
    returns.
    """
    s = np.sqrt(1.8)
    mass = np.array([[2.0, s], [s, 7.2]]) / (9.2 + 2.0 * s)
    square, modes = eigh(np.array([[2.0, -2.0], [-2.0, 4.0]]), mass)
    share = modes[1] * (modes.T @ mass @ np.ones(2)) / np.sqrt(square)
    return float(brentq(lambda t: share @ np.sin(np.sqrt(square) * t), 1.5, 3.0, xtol=1e-14))


def table(title: str) -> Table:
    """Empty table with columns for exact value, result and error."""
    made = Table(title=title, title_justify="left", title_style="bold")
    made.add_column("quantity")
    for name in ("exact", "ours", "error"):
        made.add_column(name, justify="right")
    return made


def row(into: Table, name: str, exact: float, ours: float) -> None:
    """Add a row to the table."""
    into.add_row(name, f"{exact:.8f}", f"{ours:.8f}", f"{ours - exact:+.1e}")


def show_example_1() -> None:
    """Print the table and save the figure of the first example (Fig. 5 of the paper)."""
    lines = table("Example 1: bar of two elements on a rigid wall (slab h = 0.005)")
    thrown = Thrown(gap=GAP)
    figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.2), sharey=True, layout="constrained")
    times = np.linspace(0.0, 3.0, 601)
    panels = iter(axes)
    for name, (rule, mass, reference) in RULES.items():
        steps = example_1(rule, mass, 0.005)
        row(lines, f"{name}: contact instant", GAP, instant(steps, "touch"))
        ledger = steps[-1].ledger
        if reference is not None:
            mesh = semidiscrete.bar(2, lumped=isinstance(mass, sw.bodies.Lumped))
            exact = semidiscrete.solve(mesh, np.zeros(3), np.ones(3), gap=GAP, until=3.0, rule=reference)
            loss = 1.0 - exact.energy(3.0) / exact.energy(0.0)
            row(lines, f"{name}: release", exact.times("release")[0], instant(steps, "release"))
            row(lines, f"{name}: energy lost", loss, 1.0 - 2.0 * (ledger.energy_kinetic + ledger.energy_strain))
        else:
            row(lines, f"{name}: release", GAP + massless_contact(), instant(steps, "release"))
            row(lines, f"{name}: energy lost", 0.0, 1.0 - 2.0 * (ledger.energy_kinetic + ledger.energy_strain))
        if name != "Impulse, lumped":
            panel = next(panels)
            panel.plot(times, 1.0 + thrown.tip(times), color="0.6", lw=4.0, label="exact (continuum)")
            panel.plot(times, thrown.rear(times), color="0.6", lw=4.0)
            for node, start, style in ((2, 1.0, "C0-"), (0, 0.0, "C1-")):
                t, u = curve(steps, node)
                panel.plot(t, start + u, style, lw=1.6, label=("front end", "rear end")[node == 0])
            panel.axhline(1.0 + GAP, color="k", lw=0.8)
            panel.set(title=name, xlabel="time", xlim=(0.0, 3.0))
            panel.grid(alpha=0.3)
    axes[0].set_ylabel("position of the ends")
    axes[0].legend(loc="lower left", frameon=False)
    figure.suptitle("A bar of two elements meets a rigid wall (Fig. 5 of the paper)")
    figure.savefig(OUT / "example_1.png", dpi=130)
    plt.close(figure)
    CONSOLE.print(lines)


def show_example_2() -> None:
    """Print the table and save the figure of the second example (Fig. 6 of the paper)."""
    lines = table("Example 2: fixed bar with a moving tip (slab h = 0.01)")
    mesh = semidiscrete.bar(2, fixed=True)
    figure, axes = plt.subplots(2, 1, figsize=(9.0, 7.0), sharex=True, layout="constrained")
    for panel, stop in zip(axes, (None, STOP), strict=True):
        steps = example_2(stop)
        gap = 1e9 if stop is None else stop
        exact = semidiscrete.solve(mesh, np.zeros(2), np.array([0.0, 1.0]), gap=gap, until=10.0, rule="impulse")
        sampled = np.linspace(0.0, 10.0, 81)
        values = np.array([exact.at(float(t))[0] for t in sampled])
        for node, name, width in ((2, "point of contact", 2.2), (1, "inner point", 1.0)):
            t, u = curve(steps, node)
            panel.plot(t, u, color="k", lw=width, label=name)
            panel.plot(sampled, values[:, node - 1], "o", ms=3.5, color="C1", label="exact" if node == 1 else None)
            row(
                lines, f"{'free' if stop is None else 'stop'}: u({name}, 10)", float(exact.at(10.0)[0][node - 1]), u[-1]
            )
        if stop is not None:
            panel.axhline(stop, color="C0", lw=0.8)
            panel.set_ylim(top=0.27)
            for k, kind in ((0, "touch"), (1, "touch"), (1, "release"), (2, "touch")):
                row(lines, f"stop: {kind} {k + 1}", exact.times(kind)[k], instant(steps, kind, k))
        panel.set(ylabel="displacement", title="without stop" if stop is None else f"stop at {stop} (Impulse)")
        panel.grid(alpha=0.3)
        panel.legend(loc="upper right", ncols=3, frameon=False, fontsize=8)
    axes[1].set(xlabel="time", xlim=(0.0, 10.0))
    figure.suptitle("A fixed bar of two elements whose tip starts with velocity 1 (Fig. 6 of the paper)")
    figure.savefig(OUT / "example_2.png", dpi=130)
    plt.close(figure)
    CONSOLE.print(lines)


def show_drop() -> None:
    """Compute the bracket dropped from 1 m: energy table and two pictures."""
    scenario = sw.load(ROOT / "scenarios" / "bracket_drop.toml")
    end, mark = scenario.time.end, [0.25]

    def progress(now: sw.Progress) -> None:
        if now.fraction >= mark[0]:
            CONSOLE.print(f"  bracket: {now.time * 1e6:.0f} of {end * 1e6:.0f} us")
            mark[0] += 0.25

    begun = time.perf_counter()
    run = sw.run(scenario, OUT / "bracket", progress=progress, overwrite=True)
    pictures(run, OUT / "bracket.png")
    history = run.history
    energy = history["energy_kinetic"] + history["energy_strain"]
    made = Table(title="A steel bracket dropped from 1 m on a corner", title_justify="left", title_style="bold")
    for name in ("kinetic [J]", "strain [J]", "work of gravity [J]", "balance error / initial", "peak force [kN]"):
        made.add_column(name, justify="right")
    force = history["contact.floor.force_n"]
    error = np.abs(history["energy_error"]).max() / energy[0]
    for k in (0, int(np.argmax(history["energy_strain"])), len(energy) - 1):
        made.add_row(
            f"{history['energy_kinetic'][k]:.6f}",
            f"{history['energy_strain'][k]:.6f}",
            f"{history['work_external'][k]:.6f}",
            f"{error:.1e}",
            f"{force.max() / 1e3:.2f}",
        )
    CONSOLE.print(made)
    CONSOLE.print(f"  {history.rows - 1} slabs in {time.perf_counter() - begun:.0f} s")


def main() -> None:
    """Run all examples."""
    OUT.mkdir(exist_ok=True)
    show_example_1()
    show_example_2()
    if "--quick" not in sys.argv[1:]:
        show_drop()
    CONSOLE.print(f"pictures: {', '.join(sorted(str(p.relative_to(ROOT)) for p in OUT.glob('*.png')))}")


if __name__ == "__main__":
    main()
