"""Central differences with all state on a device, for elastic solids with lumped masses on contact rows at rest."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from softway.arrays import Array, IntArray
from softway.kernels.device import explicit
from softway.kernels.device.arrays import DeviceMatrix, Sums, fetched, integers, numbers, zeros
from softway.kernels.device.device_cells import DeviceCells
from softway.kernels.device.door import wp
from softway.kernels.device.gradients import DeviceDescent, DeviceRows, SlabProduct


class Body(NamedTuple):
    """Arrays of a model in NumPy: nodal fields (n, d) but for ``mass``, ``light`` and ``edge`` (n,); ``passing``
    (n, n); ``ends`` (e, 2) of edges and the ``shortest`` (e,) initial one of their solids, where slabs are shortened.
    """

    points: Array
    load: Array
    inverse: Array
    free: Array
    mass: Array
    light: Array
    edge: Array
    passing: Any
    ends: IntArray
    shortest: Array


class Contacts(NamedTuple):
    """Contact rows (m,) in NumPy: ``gradient`` (m, n d), ``offset``, the overlap ``allowed`` of the free motion, and
    the ``first`` row of each contact and the end of the last one.
    """

    gradient: Any
    offset: Array
    allowed: Array
    first: IntArray


class Layer(NamedTuple):
    """Massless components (f,) of nodes in the cells around them, on a device.

    ``where`` are their places in the fields of all nodes, ``own`` in those of the ``nodes`` (k,) of the ``cells``.
    """

    cells: DeviceCells
    nodes: Any
    where: Any
    own: Any
    product: SlabProduct
    descent: DeviceDescent
    force: Any


class State(NamedTuple):
    """State on the device: time and length of the slab before [s], displacement, velocity, slope, internal force and
    handed force (n, d), contact forces on nodes (n, d) and on rows (m,), gaps (m,), and energies (parts,) in NumPy.
    """

    time: float
    u: Any
    v: Any
    slope: Any
    force: Any
    handed: Any
    push: Any
    pressure: Any
    gap: Any
    energy: Array


class Told(NamedTuple):
    """Numbers of a slab: ``sums`` (TALLIES,) of the nodes, sums ``met`` and greatest values ``worst`` of each contact,
    overlap of the free motion beyond the allowed one, greatest jerk in edges, ratio of the shortest edges, and if the
    equilibrium was found.
    """

    sums: Array
    met: Array
    worst: Array
    below: float
    jerk: float
    ratio: float
    found: bool


@dataclass(frozen=True, slots=True, eq=False)
class ExplicitSlabs:
    """Slabs of central differences on a device.

    ``extent`` is the greatest coordinate [m], ``corrections`` the number of Newton steps of the massless nodes in a
    slab, each solved to ``tolerance`` with at most ``limit`` products.
    """

    cells: DeviceCells
    layer: Layer | None
    body: Body
    rows: Contacts
    gradient: DeviceMatrix
    spread: DeviceMatrix
    passing: DeviceMatrix
    tallied: Sums
    met: Sums
    extent: float
    corrections: int
    tolerance: float
    limit: int

    @classmethod
    def of(
        cls, cells: DeviceCells, layer: Layer | None, body: Body, rows: Contacts, accuracy: tuple[int, float, int]
    ) -> "ExplicitSlabs":
        """Copy of the arrays of a model to the device of its ``cells``."""
        device, d = cells.device, cells.shape[1]
        placed = Body(
            numbers(body.points, device),
            numbers(body.load, device),
            numbers(body.inverse, device),
            integers(body.free.astype(int), device),
            numbers(body.mass, device),
            integers(body.light.astype(int), device),
            numbers(body.edge, device),
            body.passing,
            wp.array(np.ascontiguousarray(body.ends, np.int32).reshape(-1, 2), dtype=wp.int32, device=device),
            numbers(body.shortest, device),
        )
        own = Contacts(rows.gradient, numbers(rows.offset, device), numbers(rows.allowed, device), rows.first)
        assert d in (2, 3)
        return cls(
            cells,
            layer,
            placed,
            own,
            DeviceMatrix.of(rows.gradient, device),
            DeviceMatrix.of(sp.csr_array(rows.gradient.T), device),
            DeviceMatrix.of(body.passing, device),
            Sums.on(device, explicit.TALLIES),
            Sums.on(device, explicit.MET),
            float(np.abs(body.points).max(initial=0.0)),
            *accuracy,
        )

    @property
    def device(self) -> str:
        """Name of the device."""
        return self.cells.device

    def state(self, time: float, fields: tuple[Array, ...], pressure: Array, energy: Array) -> State:
        """State on the device from displacement, velocity, slope and internal force (n, d), and pressures (m,)."""
        u, v, slope, force = (numbers(field, self.device) for field in fields)
        push, p = zeros(self.cells.shape, self.device), numbers(pressure, self.device)
        self.spread.times(p, push.flatten())
        return State(time, u, v, slope, force, self._handed(force, push), push, p, self._gaps(u), energy)

    def advance(self, now: State, h: float, closed: DeviceRows | None, active: IntArray) -> tuple[State, Told]:
        """State after a slab of length h [s] with the ``closed`` rows ``active`` (c,), and its numbers."""
        body, shape = self.body, self.cells.shape
        slope, end, v, after, force, push = (zeros(shape, self.device) for _ in range(6))
        given = [h, body.load, now.handed, body.inverse, body.light, body.free]
        self._launch(explicit.predict, shape, [*given, now.u, now.v, now.slope, slope, end])
        below = self._below(end)
        found = self._equilibrium(end, closed)
        self.cells.force(end, force)
        energy = self.cells.part_energies()
        pressure = self._pressed(force, closed, active)
        self.spread.times(pressure, push.flatten())
        handed = self._handed(force, push)
        given[2] = handed
        self._launch(explicit.reach, shape, [*given, now.u, end, now.v, slope, v, after])
        new = State(now.time + h, end, v, after, force, handed, push, pressure, self._gaps(end), energy)
        met, worst = self._met(now, new, active)
        told = Told(self._tallied(h, now, new), met, worst, below, self._jerk(now, new), self._ratio(end), found)
        return new, told

    def _launch(self, kernel: Any, dim: Any, inputs: list[Any]) -> None:
        wp.launch(kernel, dim=dim, inputs=inputs, device=self.device)

    def _handed(self, force: Any, push: Any) -> Any:
        """Internal forces with the unbalanced ones of massless nodes on the nodes that they follow."""
        body, missing = self.body, zeros(self.cells.shape, self.device)
        self._launch(explicit.unbalanced, missing.shape, [force, body.load, push, body.light, body.free, missing])
        out = wp.clone(force)
        self.passing.times_nodes(missing, out, 1.0, 1.0)
        self._launch(explicit.balanced, out.shape, [body.load, push, body.light, body.free, out])
        return out

    def _gaps(self, u: Any) -> Any:
        gap = wp.clone(self.rows.offset)
        self.gradient.times(u.flatten(), gap, 1.0, 1.0)
        return gap

    def _equilibrium(self, u: Any, closed: DeviceRows | None) -> bool:
        """Move the massless nodes to their equilibrium with the closed rows at rest; false without convergence."""
        layer, found = self.layer, True
        if layer is None:
            return True
        x, size = layer.descent.fields.x, layer.where.shape
        if closed is not None:
            self._close(u, closed, x)
            self._launch(explicit.moved, size, [layer.where, x, u.flatten()])
        for _ in range(self.corrections):
            self._launch(explicit.picked, layer.product.u.shape, [layer.nodes, u, layer.product.u])
            layer.cells.force(layer.product.u, layer.force)
            flat = [self.body.load.flatten(), layer.force.flatten(), layer.where, layer.own, 1.0]
            self._launch(explicit.residual, size, [*flat, layer.descent.fields.r])
            layer.descent.begin(None)
            steps, first = layer.descent.descend(closed, self.tolerance, self.limit)
            found = found and (steps < self.limit or first == 0.0)
            self._launch(explicit.moved, size, [layer.where, x, u.flatten()])
        return found

    def _close(self, u: Any, closed: DeviceRows, x: Any) -> None:
        """Shortest motion x (f,) of the massless components after which the closed rows have no gap."""
        gap = self._gaps(u)
        self._launch(explicit.taken, closed.index.shape, [closed.index, gap, closed.wanted])
        closed.shortest(x)

    def _pressed(self, force: Any, closed: DeviceRows | None, active: IntArray) -> Any:
        """Forces (m,) of the rows: those of closed ones balance the internal force of the massless nodes best."""
        out = zeros(self.rows.offset.shape, self.device)
        if closed is not None and self.layer is not None:
            where, r = self.layer.where, self.layer.descent.fields.r
            self._launch(
                explicit.residual, where.shape, [self.body.load.flatten(), force.flatten(), where, where, -1.0, r]
            )
            self._launch(explicit.placed, len(active), [closed.index, closed.multipliers(r), out])
        return out

    def _below(self, end: Any) -> float:
        m = self.rows.offset.shape[0]
        if not m:
            return -np.inf
        out = zeros((1, m), self.device)
        self._launch(explicit.below, m, [self._gaps(end), self.rows.allowed, out])
        return float(self._most(out)[0])

    def _most(self, values: Any) -> Array:
        """Greatest value of each row."""
        rows = values.shape[0]
        narrow, one = zeros((rows, 256), self.device), zeros((rows, 1), self.device)
        self._launch(explicit.fold_most, narrow.shape, [values, narrow])
        self._launch(explicit.fold_most, one.shape, [narrow, one])
        return fetched(one)[:, 0]

    def _met(self, now: State, new: State, active: IntArray) -> tuple[Array, Array]:
        """Sums (contacts, MET) and greatest values (contacts, WORST) of the contacts."""
        first, m = self.rows.first, self.rows.offset.shape[0]
        met, worst = np.zeros((len(first) - 1, explicit.MET)), np.full((len(first) - 1, explicit.WORST), -np.inf)
        closed = np.zeros(m, int)
        closed[active] = 1
        for k, (a, b) in enumerate(zip(first[:-1].tolist(), first[1:].tolist(), strict=True)):
            if b > a:
                sums, most = zeros((explicit.MET, b - a), self.device), zeros((explicit.WORST, b - a), self.device)
                own = [x[a:b] for x in (now.gap, new.gap, now.pressure, new.pressure)]
                inputs = [integers(closed[a:b], self.device), self.floor, *own, sums, most]
                self._launch(explicit.meet, b - a, inputs)
                met[k], worst[k] = fetched(self.met.sums(sums))[:, 0], self._most(most)
        return met, worst

    @property
    def floor(self) -> float:
        """Overlap of open rows that is rounding [m]: a few units in the last place of the coordinates."""
        return 4.0 * float(np.finfo(float).eps) * self.extent

    def _tallied(self, h: float, now: State, new: State) -> Array:
        n, body = self.cells.shape[0], self.body
        out = zeros((explicit.TALLIES, n), self.device)
        fields = [now.u, new.u, now.v, new.v, now.handed, new.handed, now.push, new.push, out]
        self._launch(explicit.tally, n, [h, body.mass, body.points, body.load, body.free, *fields])
        return fetched(self.tallied.sums(out))[:, 0]

    def _jerk(self, now: State, new: State) -> float:
        out = zeros((1, self.cells.shape[0]), self.device)
        self._launch(explicit.jerk, out.shape[1], [self.body.mass, self.body.edge, now.slope, new.slope, out])
        return float(self._most(out)[0])

    def _ratio(self, u: Any) -> float:
        """Shortest present over shortest initial edge; at most 1."""
        e = self.body.ends.shape[0]
        if not e:
            return 1.0
        out = zeros((1, e), self.device)
        self._launch(explicit.shortened, e, [self.body.ends, self.body.shortest, self.body.points, u, out])
        return min(1.0, -float(self._most(out)[0]))
