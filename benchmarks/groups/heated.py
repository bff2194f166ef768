"""What heat costs in a slab."""

import sys
from collections.abc import Iterator

from processes.apart import HERE, Absent, Failed, environment, line
from record.figures import Figure

from groups.asked import Asked


def heated(asked: Asked) -> Iterator[Figure]:
    """Solids that hit a plane, with a temperature that expands them (E alpha^2 theta / c = .01) and without: one slab.

    Iterations are those of the fixed point, in which the heat is solved each time.
    """
    command = [sys.executable, str(HERE / "heated.py"), *(["--smallest"] if asked.smoke else [])]
    try:
        found = line(command, environment(1))
    except Absent as why:
        raise Failed(f"heated: {why}") from why
    for case in found["cases"]:
        name, (with_heat, without), (more, few) = f"heated/{case['case']}", case["times"], case["iterations"]
        words = f"ms of the processor, {case['unknowns']} unknowns; without heat"
        yield Figure(name=name, value=with_heat, unit=words, baseline=without, ratio=with_heat / without,
                     target="<= 1.6")  # fmt: skip
        yield Figure(name=f"{name}, iterations", value=more, unit="without heat", baseline=few, ratio=more / few,
                     target="<= 1.2")  # fmt: skip
