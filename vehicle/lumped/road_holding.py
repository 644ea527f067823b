"""How much the load of a tyre fluctuates on a road: the measure as printed, and the physical one beside it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle.lumped.road_holding_models import RoadHoldingModel
from vehicle.lumped.road_spectrum import band_amplitudes, exponential_density
from vehicle.parameters.damper_choice import ExponentialRoad, FrequencyBands

Array = npt.NDArray[np.float64]

LINES_PER_BAND = 10
"""Midpoints for the mean over a band; twice as many change R by less than 0.1 %."""

LINES_PER_HERTZ = 20
"""Midpoints for the integral of the physical measure; twice as many change it by less than 0.1 %."""


def printed_load_fluctuation(
    car: RoadHoldingModel, road: ExponentialRoad, bands: FrequencyBands, *, signed: bool = False
) -> Array:
    """Load fluctuation rate R of each tyre as printed: a plain sum of band amplitudes.

    R = kt sum_n |x_r,n - x_u,n| / (m g),  x_u,n = x_r,n mean_n |H_u|

    The magnitude bars are lost in the print. Without them bands with |H_u| > 1 count negative and R has no minimum.

    Args:
        car: model with tyres.
        road: displacement density.
        bands: frequency bands.
        signed: leave the magnitude bars out.

    Returns:
        R [-], one for each tyre.

    Source: "Dynamic Modeling of Vehicles and Damper" (2014), equation 10.
    """
    count = round(bands.highest / bands.width)
    lines = bands.width * (np.arange(count * LINES_PER_BAND) + 0.5) / LINES_PER_BAND
    amplitude = band_amplitudes(road, bands.width * np.arange(count + 1))
    response = np.abs(car.response(lines, *(tyre.wheel for tyre in car.tyres)))
    rates = []
    for tyre, found in zip(car.tyres, response, strict=True):
        magnitude = found.reshape(count, LINES_PER_BAND).mean(axis=1)
        difference = amplitude * (1.0 - magnitude)
        total = difference.sum() if signed else np.abs(difference).sum()
        rates.append(tyre.stiffness * total / tyre.static_load)
    return np.array(rates)


def tyre_load_ratio(car: RoadHoldingModel, road: ExponentialRoad, bands: FrequencyBands) -> Array:
    """Physical measure: RMS of the dynamic tyre force over the static load.

    sqrt(int |kt + j w ct|^2 |1 - H_u|^2 G df) / (m g)

    Args:
        car: model with tyres.
        road: displacement density.
        bands: its highest frequency ends the integral.

    Returns:
        Ratio [-], one for each tyre. Above about 1/3 the tyre leaves the road (three standard deviations).
    """
    width = 1.0 / LINES_PER_HERTZ
    lines = np.asarray(width * (np.arange(round(bands.highest * LINES_PER_HERTZ)) + 0.5), dtype=np.float64)
    return tyre_load_ratio_of_density(car, lines, exponential_density(road, lines), width)


def tyre_load_ratio_of_density(car: RoadHoldingModel, lines: Array, density: Array, width: Array | float) -> Array:
    """RMS tyre force over static load on a road given by its density at midpoints.

    Args:
        car: model with tyres.
        lines: midpoints [Hz], shape (m,).
        density: G at the midpoints [m2/Hz], shape (m,).
        width: width of each interval [Hz], shape (m,) or one for all.

    Returns:
        Ratio [-], one for each tyre.
    """
    response = car.response(lines, *(tyre.wheel for tyre in car.tyres))
    ratios = []
    for tyre, found in zip(car.tyres, response, strict=True):
        deflection = 1.0 - found
        rate = np.abs(tyre.stiffness + 2j * np.pi * lines * tyre.damping)
        ratios.append(np.sqrt(np.sum((rate * np.abs(deflection)) ** 2 * density * width)) / tyre.static_load)
    return np.array(ratios)
