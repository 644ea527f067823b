"""Types of arrays of numbers, of any shape."""

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
"""Real numbers."""

Complex = NDArray[np.complex128]
"""Complex numbers."""
