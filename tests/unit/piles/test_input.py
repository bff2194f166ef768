"""What piles refuse, with a remedy that works."""

from collections.abc import Callable

import pytest

from softway.errors import InputError
from softway.piles import Balls, Pile, Wall, box, lattice, march

ONE = Balls(centres=[[0.0, 0.0]], radius=0.1, density=1.0)


@pytest.mark.parametrize(
    ("wrong", "place"),
    [
        (lambda: Balls(centres=[], radius=1.0, density=1.0), "centres"),
        (lambda: Balls(centres=[[0.0]], radius=1.0, density=1.0), "centres"),
        (lambda: Balls(centres=[[0.0, float("nan")]], radius=1.0, density=1.0), "centres"),
        (lambda: Balls(centres=[[0.0, 0.0], [1.0]], radius=1.0, density=1.0), "centres"),
        (lambda: Balls(centres=[[0.0, 0.0]], radius=0.0, density=1.0), "radius"),
        (lambda: Balls(centres=[[0.0, 0.0]], radius=[1.0, 2.0], density=1.0), "radius"),
        (lambda: Balls(centres=[[0.0, 0.0]], radius=1.0, density=-1.0), "density"),
        (lambda: Balls(centres=[[0.0, 0.0]], radius=1.0, density=1.0, velocities=[0.0, 0.0]), "velocities"),
        (lambda: Balls(centres=[[0.0, 0.0]], radius=1.0, density=1.0, spins=[[0.0]]), "spins"),
        (lambda: lattice(count=(2,), radius=1.0, density=1.0, lowest=(0.0,)), "count"),
        (lambda: lattice(count=(2, 2), radius=1.0, density=1.0, lowest=(0.0,)), "lowest"),
        (lambda: lattice(count=(2, 2), radius=1.0, density=1.0, lowest=(0.0, 0.0), jitter=-1.0), "jitter"),
        (lambda: lattice(count=(2, 2), radius=1.0, density=1.0, lowest=(0.0, 0.0), spacing=1.5), "spacing"),
        (lambda: Wall(point=(0.0, 0.0), normal=(0.0, 0.0)), "normal"),
        (lambda: Wall(point=(0.0,), normal=(1.0,)), "point"),
        (lambda: Wall(point=(0.0, 0.0), normal=(0.0, 1.0), restitution=1.1), "restitution"),
        (lambda: box(lower=(0.0, 0.0), upper=(1.0, 0.0)), "upper"),
        (lambda: box(lower=(0.0, 0.0), upper=(1.0, 1.0, 1.0)), "upper"),
        (lambda: Pile(balls=ONE, friction=-0.1), "friction"),
        (lambda: Pile(balls=ONE, gravity=(0.0, 0.0, -9.81)), "gravity"),
        (lambda: Pile(balls=ONE, walls=(Wall(point=(0.0,) * 3, normal=(0.0, 0.0, 1.0)),)), "walls[0].point"),
        (lambda: march(Pile(balls=ONE), until=0.0, step=0.1), "until"),
        (lambda: march(Pile(balls=ONE), until=1.0, step=2.0), "step"),
        (lambda: march(Pile(balls=ONE), until=1.0, step=0.1, every=0), "every"),
        (lambda: march(Pile(balls=ONE), until=1.0, step=0.1, sweeps=0), "sweeps"),
    ],
)
def test_wrong_input_is_refused(wrong: Callable[[], object], place: str) -> None:
    with pytest.raises(InputError) as refusal:
        wrong()
    assert refusal.value.where == place
    assert refusal.value.remedy


def test_balls_that_overlap_are_refused_before_the_first_slab() -> None:
    two = Balls(centres=[[0.0, 0.0], [0.19, 0.0]], radius=0.1, density=1.0)
    with pytest.raises(InputError, match=r"ball 0 overlaps ball 1 by 0\.01 m"):
        march(Pile(balls=two), until=1.0, step=0.1)
    with pytest.raises(InputError, match=r"ball 0 overlaps wall 0 by 0\.1 m"):
        march(Pile(balls=ONE, walls=(Wall(point=(0.0, 0.0), normal=(0.0, 1.0)),)), until=1.0, step=0.1)
