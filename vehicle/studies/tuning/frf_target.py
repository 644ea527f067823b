"""A measured FRF that the car shall meet, and how the model gives its own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError, DataError
from vehicle.names import CORNERS, is_wheel
from vehicle.runs.car import Car, Run
from vehicle.signals.analysis.frf import FrequencyResponse, frequency_response
from vehicle.signals.analysis.frf_agreement import log_ratio
from vehicle.signals.analysis.local_rational import local_rational_response
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.records.frf_file import FrfData

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]


LEAST_COHERENCE = 0.1
"""Points below it are left out: with so much noise the logarithm is biased, and they would count next to nothing."""

FLOOR = 0.005
"""Least standard deviation of ln|H| and of the phase [rad]: a coherence of exactly 1 does not make a calibration or an
estimator exact. Half a percent is what two estimators of one linear car differ by."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FrfTarget:
    """FRFs of one excitation level.

    Residuals, two rows for each channel: Re and Im of ln(H / Hm) over sigma(gamma^2), as of `log_ratio`.

    Attributes:
        name: of the level, for reports.
        data: measured FRFs.
        signal: plate displacement that they were measured with; None takes the linear car with stuck dampers, straight
            from its matrices.
        averages: independent averages behind data without a random error [-]; 1 where unknown.
        window: of the estimator [s]: Hann windows (H1); None for the local rational model on the whole record. The
            FRFs of the model are estimated in the same way, so that what the estimator does to a nonlinear car it does
            to both.
        wheel: whose plate is driven.
    """

    name: str
    data: FrfData
    signal: Signal | None
    wheel: str
    averages: float = 1.0
    window: float | None = None

    def __post_init__(self) -> None:
        if self.averages <= 0.0:
            raise ConfigurationError(f"{self.name}: found {self.averages:g} averages; needed are more than 0")
        if not is_wheel(self.wheel):
            raise ConfigurationError(
                f"{self.name}: found wheel {self.wheel!r}, allowed are {', '.join(CORNERS.values())}"
            )
        if self.signal is not None and self.signal.wheels != (self.wheel,):
            raise ConfigurationError(f"{self.name}: the signal must drive the plate {self.wheel} alone")
        if not np.isfinite(self.deviation).any():
            raise DataError(f"{self.name}: no FRF value with a coherence that counts; measure with less noise")

    @property
    def rows(self) -> tuple[str, ...]:
        """What each row of the residuals is."""
        return tuple(f"{self.name}, {name}, {part}" for name in self.data.channels for part in ("magnitude", "phase"))

    @property
    def deviation(self) -> Vector:
        """Standard deviation of ln H [-], (channels, frequencies); NaN where a point does not count.

        By the random error of the data where they tell it, else by coherence and averages.
        """
        deviation = log_deviation(self.data.coherence, self.averages)
        told = np.hypot(self.data.random_error / np.abs(self.data.response), FLOOR)
        deviation = np.where(np.isfinite(told) & np.isfinite(deviation), told, deviation)
        return np.where(np.isfinite(self.data.response), deviation, np.nan)

    def model_response(self, model: Car | Run) -> Complex:
        """FRFs at the frequencies of the data, of a car by its fast models or of a run of the signal, (channels, m)."""
        if isinstance(model, Run):
            return self.estimated(model)
        if self.signal is None:
            return model.matrix_frf(self.data.channels, self.data.frequency, wheel=self.wheel)
        channels = [*self.data.channels, f"plate_{self.wheel}_displacement"]
        return self.estimated(model.run(self.signal, engine="reduced", channels=channels))

    def estimated(self, run: Run) -> Complex:
        """FRFs of a run, by the estimator of the data, at the frequencies of the data; (channels, frequencies)."""
        frequency = self.data.frequency
        plate = run[f"plate_{self.wheel}_displacement"]
        answers = np.array([run[name] for name in self.data.channels])
        step = run.recording.timestep
        found: FrequencyResponse
        if self.window is None:
            band = (float(frequency[0]), float(frequency[-1]))
            spacing = float(np.min(np.diff(frequency)))
            found = local_rational_response(step, plate, answers, band=band, resolution=spacing)
        else:
            margin = 1.0 / self.window
            band = (max(float(frequency[0]) - margin, margin), float(frequency[-1]) + margin)
            found = frequency_response(step, plate, answers, window_s=self.window, band=band)
        return np.array([np.interp(frequency, found.frequency, row) for row in found.response])

    def residuals(self, model: Car | Run) -> Vector:
        """ln(H / Hm) over its standard deviation: two rows a channel, (2 channels, frequencies); 0 where undefined."""
        logarithm = log_ratio(self.data.response, self.model_response(model))
        known = np.isfinite(logarithm) & np.isfinite(self.deviation) & (self.deviation > 0.0)
        scaled = np.divide(logarithm, self.deviation, out=np.full(known.shape, np.nan + 0j), where=known)
        rows = np.stack([scaled.real, scaled.imag], axis=1).reshape(-1, self.data.frequency.size)
        return np.where(np.isfinite(rows), rows, 0.0)


def log_deviation(coherence: npt.ArrayLike, averages: float) -> Vector:
    """Standard deviation of ln|H| and of the phase [rad] of an estimated FRF.

    sigma^2 = (1 - gamma^2) / (2 gamma^2 n) + floor^2

    Args:
        coherence: gamma^2 [-].
        averages: n, independent averages; an unknown number, taken as 1, changes a common factor only, which the fit
            finds from the residuals.

    Returns:
        sigma [-]; NaN below `LEAST_COHERENCE` and where the coherence is.

    Source: Bendat and Piersol, Random Data, 4th ed., section 9.2: the normalised random error of |H| and the standard
    deviation of the phase in radians are both sqrt(1 - gamma^2) / (|gamma| sqrt(2 n)).
    """
    gamma2 = np.asarray(coherence, dtype=float)
    gamma2 = np.where(gamma2 >= LEAST_COHERENCE, np.minimum(gamma2, 1.0), np.nan)
    return np.sqrt((1.0 - gamma2) / (2.0 * gamma2 * averages) + FLOOR**2)
