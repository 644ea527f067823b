"""Power spectral densities of road displacement: the exponential one of the damper study and ISO 8608."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.parameters.damper_choice import ExponentialRoad

ROAD_CLASSES = "ABCDEFGH"
"""Classes of ISO 8608 from very good to very poor."""

REFERENCE_WAVENUMBER = 0.1
"""n0 [cycles/m]."""

CLASS_A_ROUGHNESS = 16e-6
"""Gd(n0) of class A, geometric mean [m3]; each further class has four times as much."""


def exponential_density(road: ExponentialRoad, frequency: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """G(f) = a exp(-b f) [m2/Hz] at lines [Hz] of any shape. Source: Tamboli and Joshi (1999), as cited there."""
    return np.asarray(road.roughness * np.exp(-road.decay * np.asarray(frequency, dtype=float)))


def band_amplitudes(road: ExponentialRoad, edges: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Root mean square displacement in bands, in closed form.

    x_r = sqrt(int_f1^f2 a exp(-b f) df) = sqrt(a / b (exp(-b f1) - exp(-b f2)))

    Args:
        road: the density.
        edges: band edges, rising [Hz], shape (m + 1,).

    Returns:
        Amplitudes [m], shape (m,).

    Source: "Dynamic Modeling of Vehicles and Damper" (2014), equation 8.
    """
    return np.sqrt(-np.diff(exponential_density(road, edges)) / road.decay)


def iso_8608_density(road_class: str, speed: float, frequency: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Displacement density in time of a road of ISO 8608 driven at constant speed.

    Gd(n) = Gd(n0) (n / n0)^-2 with n = f / v, hence G(f) = Gd(n0) n0^2 v / f^2

    Args:
        road_class: "A" (very good) to "H" (very poor), geometric mean of the class.
        speed: v [m/s].
        frequency: lines above 0 [Hz], any shape.

    Returns:
        G(f) [m2/Hz].

    Raises:
        ConfigurationError: unknown class, speed or frequency not positive.

    Source: ISO 8608:2016, annex C (waviness 2).
    """
    if road_class not in ROAD_CLASSES or len(road_class) != 1:
        raise ConfigurationError(f"road class: found {road_class!r}, allowed are {', '.join(ROAD_CLASSES)}")
    if not (math.isfinite(speed) and speed > 0.0):
        raise ConfigurationError(f"road: speed: found {speed!r} m/s, must be greater than 0.0")
    lines = np.asarray(frequency, dtype=float)
    if not (np.isfinite(lines) & (lines > 0.0)).all():
        raise ConfigurationError("road: frequency: must be finite numbers greater than 0.0 Hz")
    roughness = CLASS_A_ROUGHNESS * 4.0 ** ROAD_CLASSES.index(road_class)
    return np.asarray(roughness * REFERENCE_WAVENUMBER**2 * speed / lines**2)
