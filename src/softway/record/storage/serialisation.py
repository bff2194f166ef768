"""Conversion of data classes to a text and arrays, and back; reading never executes stored code.

Only the classes of ``KINDS`` are created, from numbers, strings, tuples, tables and arrays that fit their type hints.
"""

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from softway.bodies.internal_force.material_state import MaterialState
from softway.contact.contact_rows import ContactRows
from softway.contact.tangential_rows import TangentialRows
from softway.errors import InputError
from softway.heat.coupled.heat_of_solids import HeatOfSolids
from softway.heat.fronts.places import Fronts
from softway.heat.ledger import HeatLedger
from softway.heat.march import HeatState
from softway.marching.state.march_state import (
    AdaptedMeshes,
    EnergyAccount,
    MarchState,
    RemeshedMeshes,
    Settings,
    StepHistory,
)
from softway.marching.state.model_state import ModelState
from softway.marching.state.step_control import StepControl
from softway.mechanisms.arrays import MechanismState
from softway.meshes.adaptive.leaves import Leaves
from softway.meshes.mesh import Mesh
from softway.meshes.remeshed.remeshed_mesh import RemeshedMesh
from softway.meshes.topology import HangingNodes
from softway.model.field import FieldState
from softway.model.rigid.rigid_state import RigidState
from softway.model.time_weight import Collocation, EndPeaks, Momentum
from softway.piles.state import PileState
from softway.record.storage.gate.stored_types import require_fields
from softway.solve.equations.slab_values import SlabStart
from softway.solve.methods.central_difference import Explicit
from softway.solve.methods.fixed_point import FixedPoint
from softway.solve.methods.newton import Newton
from softway.solve.operators import ConjugateGradients, Device, Factored, MatrixFree, Multigrid, OperatorChoice
from softway.solve.operators.operator_memory import IterationCount, Near, OperatorMemory, OperatorOrigin, Skin

Arrays = dict[str, NDArray[Any]]

KINDS: Mapping[str, type] = MappingProxyType(
    {
        kind.__name__: kind
        for kind in (
            *(
                MarchState,
                MechanismState,
                PileState,
                HeatState,
                HeatLedger,
                Fronts,
                Settings,
                ModelState,
                SlabStart,
                RigidState,
                FieldState,
                MaterialState,
                EnergyAccount,
                HeatOfSolids,
                StepHistory,
                OperatorMemory,
                OperatorOrigin,
                OperatorChoice,
                StepControl,
                AdaptedMeshes,
                Leaves,
                RemeshedMeshes,
                RemeshedMesh,
                Mesh,
                HangingNodes,
            ),
            *(ContactRows, TangentialRows, IterationCount, Skin, Near),
            *(FixedPoint, Newton, Explicit, ConjugateGradients, Device, Factored, MatrixFree, Multigrid),
            *(Collocation, EndPeaks, Momentum),
        )
    }
)
"""Classes that the state of a march may contain."""


def packed(value: object) -> tuple[str, Arrays]:
    """Convert a value to a text and the arrays that the text names.

    Examples
    --------
    >>> packed(EndPeaks())
    ('{"kind": "EndPeaks", "with": {"theta": 0.5}}', {})
    """
    arrays: Arrays = {}
    known: dict[int, str] = {}
    return json.dumps(_plain(value, arrays, known)), arrays


def unpacked(text: str, arrays: Mapping[str, NDArray[Any]]) -> Any:
    """Restore a value from the result of :func:`packed`; its arrays are read-only.

    Raises
    ------
    ValueError
        If the text does not describe a value of these classes, with fields of their types.

    Examples
    --------
    >>> unpacked(*packed((1.5, None, np.ones(2))))
    (1.5, None, array([1., 1.]))
    """
    try:
        return _made(json.loads(text), arrays)
    except (KeyError, TypeError, AttributeError, IndexError, OverflowError, RecursionError, InputError) as error:
        raise ValueError(f"no stored value: {type(error).__name__}: {error}") from None


def _plain(value: Any, arrays: Arrays, known: dict[int, str]) -> Any:
    """Convert a value to JSON types; each array is stored once, with its axes in memory order."""
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.ndarray):
        order = sorted(range(value.ndim), key=lambda axis: -value.strides[axis])
        name = known.setdefault(id(value), f"array{len(known)}")
        arrays[name] = value.transpose(order)
        return {"array": name, "axes": order}
    if isinstance(value, np.bool_ | np.integer | np.floating):
        return value.item()
    if isinstance(value, sp.csr_array):
        parts = (value.data, value.indices, value.indptr)
        return {"rows": [_plain(part, arrays, known) for part in parts], "shape": list(value.shape)}
    if isinstance(value, tuple):
        return [_plain(v, arrays, known) for v in value]
    if isinstance(value, Mapping):
        return {"table": {k: _plain(v, arrays, known) for k, v in value.items()}}
    if is_dataclass(value) and KINDS.get(type(value).__name__) is type(value):
        content = {f.name: _plain(getattr(value, f.name), arrays, known) for f in fields(value)}
        return {"kind": type(value).__name__, "with": content}
    raise TypeError(f"a {type(value).__name__} cannot be stored")


def _made(plain: Any, arrays: Mapping[str, NDArray[Any]]) -> Any:
    if isinstance(plain, list):
        return tuple(_made(v, arrays) for v in plain)
    if not isinstance(plain, Mapping):
        return plain
    if "array" in plain:
        found = arrays[plain["array"]].transpose(np.argsort(plain["axes"]))
        found.flags.writeable = False
        return found
    if "rows" in plain:
        rows = sp.csr_array(_made(plain["rows"], arrays), shape=tuple(plain["shape"]))
        rows.check_format(full_check=True)
        return rows
    if "table" in plain:
        return {k: _made(v, arrays) for k, v in plain["table"].items()}
    kind, values = KINDS[plain["kind"]], {k: _made(v, arrays) for k, v in plain["with"].items()}
    require_fields(kind, values, KINDS)
    return kind(**values)
