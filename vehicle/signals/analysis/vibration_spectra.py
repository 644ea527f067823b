"""Spectra of the accelerations of a run: density, third octaves and cumulative RMS, unweighted and weighted."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.analysis.cumulative_spectrum import CumulativeSpectrum, ThirdOctaves
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.spectra import power_spectral_density
from vehicle.signals.analysis.weighting import weighting

RANGE = (0.5, 80.0)
"""Frequencies of the spectra [Hz]: the range of ISO 2631-1 for comfort."""

WINDOW = 4.0
"""Length of the Hann windows of a density [s]; a record shorter than four windows is cut into four."""

WEIGHTED_POINTS = ("seat", "seat_rail")
"""Output points whose accelerations are also weighted, as on a seat (ISO 2631-1:1997: Wd for x and y, Wk for z)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ChannelSpectrum:
    """Spectra of an acceleration channel.

    Attributes:
        name: name of the channel.
        unit: its unit.
        weighting: frequency weighting, as "Wk"; empty for the unweighted channel.
        frequency: lines [Hz]; (m,).
        density: one-sided power spectral density [unit^2/Hz]; (m,).
        cumulative_rms: RMS from the lowest line up to each line [unit]; (m,).
        third_octaves: RMS in third octave bands [unit].
    """

    name: str
    unit: str
    weighting: str
    frequency: Vector
    density: Vector
    cumulative_rms: Vector
    third_octaves: ThirdOctaves

    @property
    def label(self) -> str:
        """Name of the channel, with the weighting."""
        return f"{self.name} {self.weighting}".rstrip()

    @property
    def rms(self) -> float:
        """RMS over the whole range [unit]."""
        return float(self.cumulative_rms[-1])


def weighting_of(channel: str) -> str:
    """Return the weighting of an acceleration channel of a seat or seat rail; empty for other channels."""
    point, _, axis = channel.rpartition("_acc_")
    return {"x": "Wd", "y": "Wd", "z": "Wk"}.get(axis, "") if point in WEIGHTED_POINTS else ""


def vibration_spectra(
    time_step: float,
    channels: Mapping[str, Vector],
    units: Mapping[str, str],
    frequency_range: tuple[float, float] = RANGE,
) -> tuple[ChannelSpectrum, ...]:
    """Return the spectra of channels, each followed by its weighted spectra if it is on a seat or seat rail.

    Densities are averaged over Hann windows (Welch). Cumulative RMS and third octaves come from the periodogram of
    the whole record, so that the bands add up to the RMS (`vehicle.signals.analysis.cumulative_spectrum`).

    Args:
        time_step: sampling interval [s].
        channels: name to the evaluated part of its time history, (n,).
        units: name to unit.
        frequency_range: lowest and highest frequency [Hz]; the highest is lowered to 0.4 of the sampling rate.
    """
    lowest, highest = frequency_range[0], min(frequency_range[1], 0.4 / time_step)
    if not 0.0 < lowest < highest:
        raise DataError(
            f"spectra: found {lowest:g} to {highest:g} Hz, must be an increasing range up to half the sampling "
            f"rate of {1.0 / time_step:g} Hz"
        )
    spectra = []
    for name, record in channels.items():
        density = power_spectral_density(time_step, record, window_s=min(WINDOW, record.size * time_step / 4.0))
        inside = (density.frequency >= lowest) & (density.frequency <= highest)
        if np.count_nonzero(inside) < 2:
            raise DataError(
                f"{name}: a record of {record.size * time_step:g} s has no two lines in {lowest:g} to {highest:g} Hz; "
                "use a longer record"
            )
        frequency = density.frequency[inside]
        for curve in dict.fromkeys(("", weighting_of(name))):
            # A density is multiplied by |H|^2.
            factor = weighting(curve).spectrum_factor(frequency) ** 2 if curve else 1.0
            below = CumulativeSpectrum(time_step, record, curve or None)
            spectra.append(
                ChannelSpectrum(
                    name=name,
                    unit=units[name],
                    weighting=curve,
                    frequency=frequency,
                    density=factor * density.density[0, inside],
                    cumulative_rms=below.cumulative_rms(frequency, lowest),
                    third_octaves=below.third_octaves(lowest, highest),
                )
            )
    return tuple(spectra)
