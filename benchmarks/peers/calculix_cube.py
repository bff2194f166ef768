"""CalculiX: ``*DYNAMIC, NLGEOM`` with C3D8, its elastic law, SPOOLES and penalty contact of nodes with a face."""

import os
import pty
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from time import perf_counter

import numpy as np
from cube import DENSITY, NU, SPEED, Clock, E, chosen, lattice, slab


def deck(ask):
    """The input."""
    points, cubes = lattice(ask.cells)
    count, block = len(points), len(cubes) + 1
    rows = ["*NODE, NSET=ALL"]
    rows += [f"{k}, {p[0]:.12g}, {p[1]:.12g}, {p[2]:.12g}" for k, p in enumerate(np.vstack([points, slab(ask.gap)]), 1)]
    rows += ["*ELEMENT, TYPE=C3D8, ELSET=CUBE"]
    rows += [f"{k}, " + ", ".join(map(str, c + 1)) for k, c in enumerate(cubes, 1)]
    rows += ["*ELEMENT, TYPE=C3D8, ELSET=BLOCK", f"{block}, " + ", ".join(str(count + k) for k in range(1, 9))]
    rows += ["*NSET, NSET=MOVING, GENERATE", f"1, {count}", "*NSET, NSET=STILL, GENERATE", f"{count + 1}, {count + 8}"]
    rows += ["*ELSET, ELSET=BOTH", "CUBE, BLOCK"]
    rows += ["*MATERIAL, NAME=M", "*ELASTIC", f"{E}, {NU}", "*DENSITY", f"{DENSITY}"]
    rows += ["*SOLID SECTION, ELSET=BOTH, MATERIAL=M"]
    rows += ["*INITIAL CONDITIONS, TYPE=VELOCITY", f"MOVING, 3, {-SPEED}", "*BOUNDARY", "STILL, 1, 3"]
    rows += ["*SURFACE, NAME=LOWER", *(f"{k}, S1" for k in range(1, ask.cells**2 + 1))]
    rows += ["*SURFACE, NAME=PLANE", f"{block}, S2", "*SURFACE INTERACTION, NAME=TOUCH"]
    rows += ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{ask.penalty}, {0.001 * E}"]
    rows += ["*CONTACT PAIR, INTERACTION=TOUCH, TYPE=NODE TO SURFACE", "LOWER, PLANE"]
    steps = round(ask.end / ask.step)
    rows += [f"*STEP, NLGEOM, INC={10 * steps}", "*DYNAMIC, DIRECT, ALPHA=-0.05", f"{ask.step}, {steps * ask.step}"]
    rows += [f"*NODE FILE, NSET=MOVING, FREQUENCY={steps}", "U, V"]
    rows += ["*NODE PRINT, NSET=STILL, TOTALS=ONLY, FREQUENCY=1", "RF", "*END STEP", ""]
    return "\n".join(rows)


def lines(command, folder, environment):
    """Lines that a program prints, as they come: it takes its output for a terminal."""
    ours, its = pty.openpty()
    with subprocess.Popen(command, cwd=folder, env=environment, stdout=its, stderr=its):
        os.close(its)
        rest = ""
        while True:
            try:
                text = os.read(ours, 65536).decode(errors="replace")
            except OSError:
                return
            *whole, rest = (rest + text).split("\n")
            yield from whole


def last_velocity(file):
    """Mean velocity along z in the last result."""
    values, reading = [], False
    for line in file.read_text().splitlines():
        if line.startswith(" -4"):
            reading = line.split()[1] == "VELO"
            values = [] if reading else values
        elif reading and line.startswith(" -1"):
            values.append(float(line[37:49]))
    return np.mean(values)


def forces(file):
    """Times, and the force of the plane on the cube along z: what holds the block."""
    blocks = re.findall(r"total force.*?time\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)", file.read_text(), re.DOTALL)
    return np.array([(float(time), float(z)) for time, _, _, z in blocks]).reshape(-1, 2).T


def main():
    """Run, and print a line of JSON."""
    ask = chosen(__doc__)
    threads = {k: str(ask.threads) for k in ("OMP_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER")}
    version = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
    folder = Path(tempfile.mkdtemp())
    (folder / "cube.inp").write_text(deck(ask))
    clock, start, touching = Clock(), None, False
    for line in lines(["ccx", "cube"], folder, os.environ | threads):
        springs = re.search(r"[Nn]umber of contact spring elements\s*=\s*(\d+)", line)
        touching = int(springs[1]) > 0 if springs else touching
        if re.match(r"\s*increment \d+ attempt", line):
            if start is not None:
                clock.seconds.append(perf_counter() - start)
                clock.touching.append(touching)
            start = perf_counter()
    clock.seconds.append(perf_counter() - start)
    clock.touching.append(touching)
    velocity = last_velocity(folder / "cube.frd")
    time, force = forces(folder / "cube.dat")
    clock.time, clock.force = time.tolist(), force.tolist()
    mean = 0.5 * (force + np.concatenate([[0.0], force[:-1]]))
    clock.momentum = (np.cumsum(mean * np.diff(time, prepend=0.0)) - SPEED).tolist()
    shutil.rmtree(folder)
    if not np.isfinite(velocity) or clock.time[-1] < 0.999 * ask.step * round(ask.end / ask.step):
        raise SystemExit(f"CalculiX gave up in step {len(clock.seconds)}")
    found = re.search(r"[\d.]+", version)
    clock.told("CalculiX", found[0] if found else "unknown", 3 * (ask.cells + 1) ** 3, velocity, None)


if __name__ == "__main__":
    main()
