"""Array aliases: shapes are written in docstrings with the letters of ARCHITECTURE.md."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
