"""The ring test of metal forming: force curves of upsetting, and calibration curves of the friction.

Run it with ``python examples/ring_test.py``.  A ring with the proportions 6 : 3 : 2 is pressed between platens.
The change of its hole is a measure of the friction.  The program prints the change of the inner radius at a reduction
of 30 per cent and draws ``demo/ring_test.png``, with the references of the verification cases E02 and E03 as points.
"""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np

from softway.apps.verify.case import sheet
from softway.apps.verify.cases.forming import e02_upsetting_with_friction
from softway.apps.verify.cases.forming.e03_ring_test import ALPHAS, ring
from softway.apps.verify.scenes.forming import Press

mpl.use("Agg")
import matplotlib.pyplot as plt

ROOT = Path(__file__).resolve().parents[1]
OUT = ROOT / "demo"
INK = ("#1b6ca8", "#3a923a", "#b3443c")


def picture(rings: dict[float, Press], upset: Press, file: Path) -> None:
    """Draw calibration curves and force curves side by side."""
    fig, (left, right) = plt.subplots(1, 2, figsize=(9.6, 3.8), layout="constrained")
    table = sheet("E03")["reference"]["table"]
    for (alpha, press), ink in zip(rings.items(), INK, strict=True):
        reduction, radius = press.bore
        left.plot(100 * reduction, 100 * (radius / press.inner - 1.0), color=ink, label=rf"$\alpha$ = {alpha:g}")
        points = np.array(table[str(alpha)])
        left.plot(100 * points[:, 0], 100 * (points[:, 4] / press.inner - 1.0), "o", ms=3.5, color=ink)
        right.plot(100 * press.reduction[1:], press.force[1:], color=ink)
        right.plot(100 * points[:, 0], points[:, 1], "o", ms=3.5, color=ink)
    left.axhline(0.0, color="0.7", lw=0.8, zorder=0)
    left.set(xlabel="reduction of the height [%]", ylabel="change of the inner radius [%]", title="Ring test 6 : 3 : 2")
    left.legend(frameon=False)
    points = np.array(sheet("E02")["reference"]["fine_12x10x24"])
    right.plot(100 * upset.reduction[1:], upset.force[1:], color="0.3", label="cylinder, E02")
    right.plot(100 * points[:, 0], points[:, 1], "o", ms=3.5, color="0.3", label="references")
    right.set(
        xlabel="reduction of the height [%]", ylabel=r"force of the platen [$K\,s^{-m} m^2$]", title="Force", ylim=0.0
    )
    right.legend(frameon=False)
    for ax in (left, right):
        ax.spines[["top", "right"]].set_visible(False)
    file.parent.mkdir(exist_ok=True)
    fig.savefig(file, dpi=150)


def main() -> int:
    """Press the rings and the cylinder."""
    rings = {alpha: ring(alpha, 24) for alpha in ALPHAS}
    for alpha, press in rings.items():
        change = press.radius("inner", "middle") - press.inner
        print(f"alpha = {alpha:4.2f}: inner radius {change:+.4f}, force {press.force_at(0.3):.2f}")
    picture(rings, e02_upsetting_with_friction.upset(), OUT / "ring_test.png")
    print(f"picture: {OUT / 'ring_test.png'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
