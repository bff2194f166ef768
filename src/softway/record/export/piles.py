"""Tables, arrays and animations of the motion of the balls of a pile."""

import csv
from pathlib import Path

import numpy as np

from softway.arrays import Array
from softway.record.export.animation import RIM, Parts, text_of, tracks
from softway.record.export.solids import ball, bar, merged
from softway.record.pile.motion import BallMotion
from softway.record.read.records import Records
from softway.record.storage.table import COUNT, RATIO, TEXT, header
from softway.record.view.style import CYCLE


def balls_csv(path: Path, run: Records) -> None:
    """Write a table with a line for each instant and ball."""
    motion, groups = run.balls, _names(run)
    axes = "xyz"[: motion.centres.shape[2]]
    spins = ["spin"] if len(axes) == 2 else [f"spin_{a}" for a in axes]
    columns = [
        *((a, "m") for a in axes),
        *((f"quaternion_{a}", RATIO) for a in "wxyz"),
        *((f"velocity_{a}", "m/s") for a in axes),
        *((name, "rad/s") for name in spins),
    ]
    radii = run.pile["radii"]
    with path.open("w", encoding="utf-8", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow(header([("time", "s"), ("ball", COUNT), ("group", TEXT), ("radius", "m"), *columns]))
        for row, time in enumerate(motion.times):
            parts = [part[row] for part in (motion.centres, motion.turns, motion.velocities, motion.spins)]
            for k, numbers in enumerate(np.concatenate(parts, axis=1).tolist()):
                lines.writerow([f"{time:.17g}", k, groups[k], *(f"{x:.17g}" for x in (radii[k], *numbers))])


def balls_npz(path: Path, run: Records) -> None:
    """Write arrays of NumPy: ``time``, ``centres``, ``turns``, ``velocities``, ``spins``, ``radii`` and ``groups``."""
    motion = run.balls
    np.savez_compressed(
        path,
        allow_pickle=False,
        time=motion.times,
        centres=motion.centres,
        turns=motion.turns,
        velocities=motion.velocities,
        spins=motion.spins,
        radii=np.asarray(run.pile["radii"], float),
        groups=np.array(_names(run)),
    )


def balls_gltf(path: Path, run: Records) -> None:
    """Write an animation in the format glTF, with a sphere for each ball or disc, in the colours of the groups."""
    motion, parts, names = run.balls, Parts(), _names(run)
    shapes: dict[tuple[str, float], int] = {}
    time, channels, samplers = parts.stored(motion.times, "SCALAR"), [], []
    colours = {name: CYCLE[k % len(CYCLE)] for k, name in enumerate(run.pile["groups"])}
    for k, (name, radius) in enumerate(zip(names, run.pile["radii"], strict=True)):
        if (name, radius) in shapes:
            parts.nodes.append({"name": name, "mesh": shapes[name, radius]})
        else:
            bars = (bar(-way, way, 0.1 * radius) for way in RIM * radius * np.eye(3))
            parts.shown(name, merged([ball(np.zeros(3), radius), *bars]), colours[name])
            shapes[name, radius] = len(parts.meshes) - 1
        for way, values, kind in tracks(_place(motion, k), motion.turns[:, k]):
            samplers.append({"input": time, "output": parts.stored(values, kind), "interpolation": "LINEAR"})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": len(parts.nodes) - 1, "path": way}})
    moved = {"name": "motion", "channels": channels, "samplers": samplers}
    path.write_text(text_of(run, parts, moved, run.pile["dim"]), encoding="utf-8")


def _place(motion: BallMotion, k: int) -> Array:
    """Places (t, 3) of a ball."""
    out = np.zeros((len(motion.times), 3))
    out[:, : motion.centres.shape[2]] = motion.centres[:, k]
    return out


def _names(run: Records) -> list[str]:
    """Group of each ball."""
    return [name for name, count in run.pile["groups"].items() for _ in range(count)]
