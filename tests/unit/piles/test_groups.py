"""Groups of balls of scenario files, and their tables."""

from pathlib import Path

import numpy as np
import pytest

from softway.errors import InputError
from softway.piles import BallFile, BallLattice, BallList, Balls, Pile, box, lattice, march
from softway.piles.groups import together


def test_a_lattice_is_that_of_python() -> None:
    given = {"count": (3, 2, 2), "radius": 0.1, "density": 2.0, "lowest": (0.0, 0.0, 0.0), "jitter": 0.01, "seed": 3}
    group = BallLattice(**given, velocity=(1.0, 2.0, 3.0)).build()
    assert np.array_equal(group.centres, lattice(**given).centres)
    assert np.array_equal(group.velocities, np.tile([1.0, 2.0, 3.0], (12, 1)))


def test_groups_keep_their_order_and_their_motion() -> None:
    one = BallList(centres=((0.0, 0.0), (1.0, 0.0)), radius=(0.1, 0.2), density=(3.0,), spins=((5.0,), (6.0,))).build()
    other = BallList(centres=((2.0, 0.0),), radius=(0.3,), density=(4.0,), velocities=((7.0, 8.0),)).build()
    balls = together({"one": one, "other": other})
    assert balls.radii.tolist() == [0.1, 0.2, 0.3] and np.asarray(balls.density).tolist() == [3.0, 3.0, 4.0]
    assert np.asarray(balls.velocities).tolist() == [[0.0, 0.0], [0.0, 0.0], [7.0, 8.0]]
    assert np.asarray(balls.spins).tolist() == [5.0, 6.0, 0.0]


def test_a_table_is_read(tmp_path: Path) -> None:
    file = tmp_path / "balls.csv"
    lines = ("x [m],y,z,radius,density,spin_z [rad/s],velocity_y", "0,1,2,.1,3,4,5", "6,7,8,.2,9,1,2", "")
    file.write_text("\n".join(lines), encoding="utf-8")
    balls = BallFile(path=file).build()
    assert np.asarray(balls.centres).tolist() == [[0.0, 1.0, 2.0], [6.0, 7.0, 8.0]] and balls.radii.tolist() == [
        0.1,
        0.2,
    ]
    assert np.asarray(balls.spins).tolist() == [[0.0, 0.0, 4.0], [0.0, 0.0, 1.0]]
    assert np.asarray(balls.velocities).tolist() == [[0.0, 5.0, 0.0], [0.0, 2.0, 0.0]]
    assert BallFile(path=file, radius=0.5).build().radii.tolist() == [0.5, 0.5]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "has no column 'x'"),
        ("x,y,density\n0,0,1\n", "has no column 'radius'"),
        ("x,y,radius,density,colour\n0,0,1,1,1\n", "has a column 'colour'"),
        ("x,y,radius,density,x\n0,0,1,1,1\n", "has a column 'x' twice"),
        ("x,y,radius,density\n", "has 0 lines of balls"),
        ("x,y,radius,density\n0,0,1,1\n0,0,1\n", "line 3 of"),
        ("x,y,radius,density\n0,0,1 m,1\n", "line 2 of"),
        ("x,y,radius,density\n0,0,-1,1\n", "not positive"),
        ("x,y,radius,density\n0,0,nan,1\n", "not finite"),
    ],
)
def test_a_wrong_table_is_refused(text: str, problem: str, tmp_path: Path) -> None:
    (tmp_path / "balls.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=problem) as refusal:
        BallFile(path=tmp_path / "balls.csv").build()
    assert refusal.value.remedy


def test_files_that_are_none_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is a folder"):
        BallFile(path=tmp_path, radius=1.0, density=1.0).build()
    (tmp_path / "balls.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="cannot be read"):
        BallFile(path=tmp_path / "balls.csv", radius=1.0, density=1.0).build()


def test_a_march_goes_on_with_the_same_bits_and_refuses_the_state_of_another() -> None:
    balls = lattice(count=(3, 3), radius=0.1, density=1.0, lowest=(0.15, 0.15), spacing=0.25, jitter=0.02)
    walls = box(lower=(0.0, 0.0), upper=(0.8, None))
    pile = Pile(balls=balls, walls=walls, gravity=(0.0, -10.0), friction=0.3, restitution=0.2)
    whole = list(march(pile, until=0.5, step=0.005, every=7))
    middle = whole[6].state
    assert len(middle.pairs) > 3
    rest = list(march(pile, until=0.5, step=0.005, every=7, state=middle))
    assert [step.time for step in rest] == [step.time for step in whole[7:]]
    for one, other in zip(rest, whole[7:], strict=True):
        assert np.array_equal(one.centres, other.centres) and np.array_equal(one.spins, other.spins)
        assert (one.energy_error, one.touches, one.sweeps) == (other.energy_error, other.touches, other.sweeps)
    few = Pile(balls=Balls(centres=[[0.5, 0.5]], radius=0.1, density=1.0), walls=walls)
    with pytest.raises(InputError, match="not one of a march of this pile"):
        march(few, until=0.5, step=0.005, state=middle)
    with pytest.raises(InputError, match="not one of a march of this pile"):
        march(pile, until=0.1, step=0.005, state=middle)
