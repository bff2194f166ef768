"""One thread of OpenBLAS in slabs."""

from importlib import import_module

import pytest
from threadpoolctl import threadpool_limits

import softway as sw
from softway.solve.linear.blas_threads import _loaded, one_blas_thread

SLABS = import_module("softway.marching.slabs")


def numbers() -> set[int]:
    """Numbers of threads of every OpenBLAS."""
    return {each["num_threads"] for each in _loaded().info()}


def test_the_number_before_returns_after_an_error() -> None:
    with threadpool_limits(limits=2, user_api="blas"):
        before = numbers()
        within = set[int]()

        def failing() -> None:
            with one_blas_thread()():
                within.update(numbers())
                raise ZeroDivisionError

        with pytest.raises(ZeroDivisionError):
            failing()
        assert within <= {1}
        assert numbers() == before


def test_slabs_are_computed_with_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    seen, accept = [], SLABS.accept_slab

    def watched(*given: object) -> object:
        seen.append(numbers())
        return accept(*given)

    monkeypatch.setattr(SLABS, "accept_slab", watched)
    bar = sw.Solid(mesh=sw.meshes.Interval(length=1.0, cells=2), material=sw.LinearElastic(E=1.0), density=1.0)
    with threadpool_limits(limits=2, user_api="blas"):
        before = numbers()
        for _ in sw.march(sw.Scene(bodies={"bar": bar}), until=0.1, step=0.05):
            assert numbers() == before
    assert seen
    assert all(each <= {1} for each in seen)
