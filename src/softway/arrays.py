"""Array type aliases. Docstrings write shapes with the letters defined in ARCHITECTURE.md."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
