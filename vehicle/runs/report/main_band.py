"""Frequency band with most of the weighted vibration of a run, or of its difference from another run."""

from dataclasses import dataclass

import numpy as np

from vehicle.names import AXES
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.vibration_spectra import ChannelSpectrum, vibration_spectra

POINT = "seat_rail"

HALF = 0.5
"""Share of the mean square of an axis that the band contains."""


@dataclass(frozen=True, kw_only=True, slots=True)
class MainBand:
    """Band of third octaves of an axis with at least half of the mean square of this axis."""

    axis: str  # "x", "y" or "z"
    low: float  # low, high: edges [Hz]
    high: float
    peak: float  # midband frequency of the highest third octave [Hz]
    # mean square in the band over that of all axes; of a difference, over its total. May exceed 1 if other bands change
    # in the other direction [-].
    share: float
    edges: Vector  # of the third octaves in the band [Hz], (n + 1,)
    parts: Vector  # their mean square, or its change; positive in the direction of the whole [(m/s2)^2], (n,)

    def explained_by(self, frequency: float) -> bool:
        """Return True if a mode can cause the band: it is inside, and its third octave is not below the mean.

        In a third octave below the mean of the band the vibration has a hole, not a resonance; on a road the wheelbase
        makes such holes at the frequencies where front and rear wheels move against each other.

        Args:
            frequency: frequency of the mode [Hz].
        """
        if not self.low <= frequency < self.high:
            return False
        at = int(np.searchsorted(self.edges, frequency, side="right")) - 1
        return bool(self.parts[at] >= np.mean(self.parts))


def weighted_bands(run: FinishedRun) -> dict[str, ChannelSpectrum]:
    """Return axis to the weighted spectrum of the seat rail (ISO 2631-1: Wd, Wd, Wk); empty if it is not recorded."""
    names = {f"{POINT}_acc_{axis}": axis for axis in AXES}
    if not all(name in run.recording.channels for name in names):
        return {}
    histories = {name: run.recording.channels[name][run.evaluated] for name in names}
    spectra = vibration_spectra(run.recording.timestep, histories, run.recording.units)
    return {names[spectrum.name]: spectrum for spectrum in spectra if spectrum.weighting}


def main_band(spectra: dict[str, ChannelSpectrum], before: dict[str, ChannelSpectrum] | None = None) -> MainBand | None:
    """Return the band with most of the mean square of a run, or of its difference from a run before.

    The axis has the largest mean square (or change of it). The band begins as the third octave with the largest
    value and grows towards the larger neighbour until it contains `HALF` of the axis.

    Args:
        spectra: axis to its weighted spectrum.
        before: spectra of the other run; None for the run itself.

    Returns:
        The band; None without vibration, or without a change.
    """
    powers = {axis: _powers(spectrum) for axis, spectrum in spectra.items()}
    if before is not None:
        if any(power.shape != _powers(before[axis]).shape for axis, power in powers.items()):
            return None
        powers = {axis: power - _powers(before[axis]) for axis, power in powers.items()}
    total = sum(float(power.sum()) for power in powers.values())
    if total == 0.0:
        return None
    axis = max(powers, key=lambda name: abs(powers[name].sum()))
    along = np.sign(powers[axis].sum()) * powers[axis]
    low = high = int(np.argmax(along))
    while along[low : high + 1].sum() < HALF * along.sum():
        below = along[low - 1] if low else -np.inf
        above = along[high + 1] if high + 1 < along.size else -np.inf
        low, high = (low - 1, high) if below >= above else (low, high + 1)
    bands = spectra[axis].third_octaves
    return MainBand(
        axis=axis,
        low=float(bands.edges[low]),
        high=float(bands.edges[high + 1]),
        peak=float(bands.nominal[np.argmax(along)]),
        share=float(np.sign(powers[axis].sum()) * along[low : high + 1].sum() / total),
        edges=np.asarray(bands.edges[low : high + 2]),
        parts=np.asarray(along[low : high + 1]),
    )


def _powers(spectrum: ChannelSpectrum) -> Vector:
    """Return the mean square in each third octave [(m/s2)^2]."""
    return np.asarray(np.nan_to_num(spectrum.third_octaves.rms) ** 2)
