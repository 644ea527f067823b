"""Colours of a displacement."""

import numpy as np
import numpy.typing as npt

SCALE = "viridis"
"""Colour map of the displacement: equal steps look equally large, in print without colours and to colour-blind eyes too
(Smith and van der Walt, 2015). Violet is at rest, yellow the top of the scale."""

SHADES = 256
"""Number of colours in the table."""


def colours(values: npt.ArrayLike, top: float) -> npt.NDArray[np.float32]:
    """Return the colours of values between 0 and the top of the scale; larger values have the colour of the top.

    Args:
        values: values in the unit of `top`, (n,).
        top: maximum of the scale, above 0.

    Returns:
        Red, green, blue and opacity 1, (n, 4).
    """
    from matplotlib import colormaps

    table = np.array(colormaps[SCALE](np.linspace(0.0, 1.0, SHADES)))[:, :3]
    index = np.clip(np.atleast_1d(np.asarray(values, dtype=float)) / top, 0.0, 1.0) * (SHADES - 1)
    rgb = [np.interp(index, np.arange(SHADES), column) for column in table.T]
    return np.column_stack([*rgb, np.ones(len(index))]).astype(np.float32)
