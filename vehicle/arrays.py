"""Types of arrays of any shape, for annotations."""

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Complex = NDArray[np.complex128]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]
"""Real and complex numbers, indices, truth values."""
