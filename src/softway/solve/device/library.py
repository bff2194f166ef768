"""Warp, which runs kernels on a device, where it is installed."""

import importlib
import importlib.util
from typing import Any

from softway.errors import InputError

INSTALL = "pip install 'softway[gpu]'"
DEVICES = "'auto', 'cpu' for the processor, or 'cuda:0' for a CUDA device"


def check_device(device: str) -> None:
    """Refuse a name that no device has.

    Raises
    ------
    InputError
        With the parameter ``device``.
    """
    kind, _, number = device.partition(":")
    if not (device in ("auto", "cpu") or (kind == "cuda" and number.isdecimal())):
        raise InputError("device", f"'{device}' is no device", DEVICES)


def available() -> bool:
    """True if Warp is installed."""
    return importlib.util.find_spec("warp") is not None


def device_named(device: str) -> str:
    """Device of this machine: ``auto`` is the first CUDA device, and the processor where there is none.

    Raises
    ------
    InputError
        If Warp is missing, or does not know the device.
    """
    if not available():
        raise InputError("", "a device without Warp", f"{INSTALL}, or no device")
    try:
        return str(arrays().place_of(device))
    except (ValueError, RuntimeError):
        raise InputError("", f"'{device}' is no device of this machine", DEVICES) from None


def arrays() -> Any:
    """Module of arrays on devices; it loads Warp."""
    return importlib.import_module("softway.kernels.device.arrays")


def launches() -> Any:
    """Module of the steps of conjugate gradients on devices; it loads Warp."""
    return importlib.import_module("softway.kernels.device.gradients")


def explicit_slabs() -> Any:
    """Module of central differences on devices; it loads Warp."""
    return importlib.import_module("softway.kernels.device.explicit_slabs")


def cells() -> Any:
    """Module of cells on devices; it loads Warp."""
    return importlib.import_module("softway.kernels.device.device_cells")
