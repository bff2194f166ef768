"""Model of a march whose method evaluates the internal forces on a device."""

import logging
from dataclasses import replace

from softway.bodies.internal_force.device_force import on_device
from softway.errors import within
from softway.marching.rules.slab_rule import Method
from softway.model.model import Model
from softway.solve.device.library import device_named
from softway.solve.methods.central_difference import Explicit
from softway.solve.operators.device import Device, require_served

log = logging.getLogger(__name__)


def placed(model: Model, method: Method) -> Model:
    """Model with its forces on the device of a method; the model itself without one.

    Raises
    ------
    InputError
        If Warp or the device is missing, or a solid has forces that no device evaluates.
    """
    if isinstance(method, Explicit):
        if method.device is None:
            return model
        with within("solver.device"):
            require_served(model, "Explicit on a device", "no device")
            device = device_named(method.device)
    elif isinstance(method.operator, Device):
        with within("solver.operator.device"):
            device = device_named(method.operator.device)
    else:
        return model
    log.info("forces on the device %s", device)
    parts = tuple(replace(part, internal=on_device(part.internal, device)) for part in model.parts)
    return replace(model, parts=parts)
