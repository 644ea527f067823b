"""Frequency response of a linear model to roads that move in phase."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.lumped.energy_matrices import LinearModel


def in_phase_response(model: LinearModel, frequency: npt.ArrayLike) -> npt.NDArray[np.complex128]:
    """Motion of the coordinates per road height, the same road under every wheel at the same time.

    X / Z = (K - w^2 M + j w C)^-1 (Bk + j w Bc) 1,  w = 2 pi f

    Args:
        model: the linear model.
        frequency: lines [Hz], shape (m,).

    Returns:
        Complex response [m/m] or [rad/m], shape (n, m).

    Raises:
        ConfigurationError: a frequency is not a finite number of at least 0.

    Source: "Dynamic Modeling of Vehicles and Damper" (2014), sections II and III (equations derived anew).
    """
    lines = np.atleast_1d(np.asarray(frequency, dtype=float))
    if not (np.isfinite(lines) & (lines >= 0.0)).all():
        raise ConfigurationError("frequency: must be finite numbers of at least 0.0 Hz")
    omega = 2.0 * np.pi * lines[:, None, None]
    dynamic = model.stiffness - omega**2 * model.mass + 1j * omega * model.damping  # (m, n, n)
    drive = (model.road_stiffness + 1j * omega * model.road_damping).sum(axis=-1)  # (m, n)
    return np.asarray(np.linalg.solve(dynamic, drive[..., None])[..., 0].T)
