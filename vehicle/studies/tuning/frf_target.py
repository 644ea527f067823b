"""Measured FRFs as a target of a fit, and the corresponding FRFs of the car."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Complex, Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.car import FRF_BAND, Car, Run
from vehicle.runs.car.fast_run import fast_run
from vehicle.signals.analysis.dependence import common_motions
from vehicle.signals.analysis.frf_agreement import log_ratio
from vehicle.signals.analysis.motion_response import motion_responses
from vehicle.signals.analysis.phase_delay import PhaseDelay, phase_delay
from vehicle.signals.analysis.response_name import PLATE, ResponseName, plates_of, row_of
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.formats.frf_file import FrfData, frf_data
from vehicle.signals.records.counterpart import SAME_MOTION
from vehicle.studies.tuning.response_delays import ResponseDelays

LEAST_COHERENCE = 0.1
"""Minimum coherence of an included point: at lower coherence the logarithm is biased, and the weight would be small."""

FLOOR = 0.005
"""Minimum standard deviation of ln|H| and of the phase [rad]: a coherence of exactly 1 does not make a calibration or
an estimator exact. Two estimators of one linear car differ by half a percent."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FrfTarget:
    """Target of a fit: measured FRFs of one excitation level.

    Residuals have two rows for each channel: Re and Im of ln(H / Hm) over sigma(gamma^2), see `log_ratio`.
    """

    name: str  # name of the level, for reports
    data: FrfData  # measured FRFs to plates that the signal drives, see `to_driven_plates`
    # displacements of the plates; None compares the linear car with stuck dampers, whose FRFs follow from its matrices
    signal: Signal | None
    averages: float = 1.0  # number of independent averages of data without a random error; 1 if unknown
    # length of the Hann windows of the H1 estimator [s]; None for an estimate on the whole record. FRFs of the model
    # use the same estimator, so its effect on a nonlinear car is in both.
    window: float | None = None
    # delays of the channels against the plate: the FRF of the model is turned by exp(-2 pi i f d)
    delays: ResponseDelays = ResponseDelays()
    sample: float = 0.0  # sampling interval of the measurement [s]; 0 if unknown
    # independent motions of the plates of the signal, see `motions_of`; without a signal, of the FRFs
    motions: tuple[dict[str, float], ...] = field(init=False)

    def __post_init__(self) -> None:
        if self.averages <= 0.0:
            raise ConfigurationError(f"{self.name}: found {self.averages:g} averages, must be above 0")
        unknown = next((str(name) for name in self.data.names if not name.motion), None)
        if unknown is not None:
            raise ConfigurationError(
                f"{self.name}: the FRF of {unknown} does not state its plate; name it, for example {unknown}/plate_fl"
            )
        if self.signal is not None:
            object.__setattr__(self, "motions", motions_of(self.signal))
            to_driven_plates(self.data, self.motions, self.name)
        else:
            inputs = dict.fromkeys(name.motion for name in self.data.names)
            motions = tuple({plate.removeprefix(PLATE): factor for plate, factor in each} for each in inputs)
            object.__setattr__(self, "motions", motions)
        if not np.isfinite(self.deviation).any():
            raise DataError(
                f"{self.name}: no FRF value has a coherence of {LEAST_COHERENCE:g} or more; measure with less noise"
            )

    @property
    def rows(self) -> tuple[str, ...]:
        """Return the names of the rows of the residuals."""
        return tuple(f"{self.name}, {name}, {part}" for name in self.data.labels for part in ("magnitude", "phase"))

    @property
    def recorded(self) -> tuple[str, ...]:
        """Return the names of the channels of a run that the target needs."""
        plates = [f"plate_{wheel}_displacement" for motion in self.motions for wheel in motion]
        return (*dict.fromkeys(self.data.channels), *plates)

    @property
    def deviation(self) -> Vector:
        """Return the standard deviation of ln H [-], (channels, frequencies); NaN where a point is excluded.

        The deviation follows from the random error of the data if the data contain one, else from coherence and
        averages.
        """
        deviation = log_deviation(self.data.coherence, self.averages)
        from_random_error = np.hypot(self.data.random_error / np.abs(self.data.response), FLOOR)
        deviation = np.where(np.isfinite(from_random_error) & np.isfinite(deviation), from_random_error, deviation)
        return np.where(np.isfinite(self.data.response), deviation, np.nan)

    @property
    def half_sample(self) -> float:
        """Return half the sampling interval of the measurement [s]; 0 if unknown."""
        return 0.5 * self.sample

    def model_response(self, model: Car | Run) -> Complex:
        """Return FRFs at the frequencies of the data, with the known delays, (channels, m)."""
        return late(self.response(model), self.data.frequency, self.delays.of(self.data.channels, {}, {}))

    def response(self, model: Car | Run) -> Complex:
        """Return FRFs at the frequencies of the data without delays, (channels, m).

        Args:
            model: a run of the signal; or a car, evaluated by its matrices (no signal) or by the reduced engine.
        """
        if isinstance(model, Run):
            return self.estimated(model)
        if self.signal is None:
            return np.array([self._of_matrices(model, name) for name in self.data.names])
        return self.estimated(fast_run(model, self.signal, self.recorded))

    def _of_matrices(self, car: Car, name: ResponseName) -> Complex:
        """Return an FRF of the linear car, (m,): sum of a_p H_p over the plates p of its input."""
        parts = [
            factor * car.matrix_frf((name.output,), self.data.frequency, wheel=plate.removeprefix(PLATE))[0]
            for plate, factor in name.motion
        ]
        return np.asarray(np.sum(parts, axis=0))

    def run(self, car: Car, engine: str = "reduced") -> Run:
        """Return the run of a car on the signal.

        Raises:
            ConfigurationError: stuck dampers have no signal.
        """
        if self.signal is None:
            raise ConfigurationError(f"{self.name}: FRFs with stuck dampers are computed without a run")
        return car.run(self.signal, engine=engine, channels=self.recorded)

    def estimated(self, run: Run) -> Complex:
        """Estimate the FRFs of a run at the frequencies of the data, (channels, m), with the estimator of the data."""
        frequency = self.data.frequency
        outputs = tuple(dict.fromkeys(self.data.channels))
        if self.window is None:
            band = (float(frequency[0]), float(frequency[-1]))
        else:
            margin = 1.0 / self.window
            band = (max(float(frequency[0]) - margin, margin), float(frequency[-1]) + margin)
        responses = motion_responses(
            run.recording.timestep,
            {wheel: run[f"plate_{wheel}_displacement"] for motion in self.motions for wheel in motion},
            [run[name] for name in outputs],
            names=outputs,
            band=band,
            window=self.window,
            resolution=float(np.min(np.diff(frequency))),
            motions=self.motions,
        )
        model = frf_data(responses, outputs)
        pairs = [pair for name in self.data.names if (pair := row_of(name, model.names)) is not None]
        return np.array([factor * np.interp(frequency, model.frequency, model.response[row]) for row, factor in pairs])

    def misfit(self, response: Complex, groups: Mapping[str, float], lags: Mapping[str, float]) -> Vector:
        """Return Re, Im of ln(H exp(-2 pi i f d) / Hm) over the deviation, (2 channels, m); 0 where undefined."""
        delays = self.delays.of(self.data.channels, groups, lags)
        return scaled_ratio(self.data.response, late(response, self.data.frequency, delays), self.deviation)

    def settled(self, groups: Mapping[str, float]) -> Self:
        """Return the target with known delays of all groups [s]."""
        return replace(self, delays=self.delays.settled(groups))

    def lags(self, model: Car) -> dict[str, PhaseDelay]:
        """Return the lag of best agreement with a car for each channel; only channels with the same motion."""
        return response_lags(self.data, self.response(model), self.deviation)


def scaled_ratio(measured: Complex, model: Complex, deviation: Vector) -> Vector:
    """Return Re and Im of ln(model / measured), (k, m), over its standard deviation, (2 k, m); 0 where undefined."""
    logarithm = log_ratio(measured, model)
    included = np.isfinite(logarithm) & np.isfinite(deviation)
    scaled = np.divide(logarithm, deviation, out=np.zeros(included.shape, dtype=complex), where=included)
    return np.stack([scaled.real, scaled.imag], axis=1).reshape(-1, scaled.shape[1])


def response_lags(data: FrfData, response: Complex, deviation: Vector) -> dict[str, PhaseDelay]:
    """Return the lags of measured FRFs against a model whose phases agree with them after the lag.

    Args:
        response: FRFs of the model, (k, m).
        deviation: standard deviation of ln H, (k, m); NaN where a point is excluded.
    """
    weight = np.nan_to_num(1.0 / deviation**2, nan=0.0)
    lags: dict[str, PhaseDelay] = {}
    for channel, measured, model, trust in zip(data.channels, data.response, response, weight, strict=True):
        lag = phase_delay(data.frequency, model, measured, trust)
        if lag is not None and lag.agreement >= SAME_MOTION:
            best = lags.get(channel)
            lags[channel] = lag if best is None or lag.error < best.error else best
    return lags


def late(response: Complex, frequency: Vector, delays: Vector) -> Complex:
    """Return FRFs H exp(-2 pi i f d) of responses with delays d [s], (k,)."""
    return np.asarray(response * np.exp(-2j * np.pi * delays[:, None] * frequency)) if delays.any() else response


def motions_of(signal: Signal) -> tuple[dict[str, float], ...]:
    """Return the independent motions of the plates of a signal: wheel to its factor, 1 for the first.

    Raises:
        DependentInputsError: a plate repeats another with a delay.
    """
    moving = [wheel for wheel in signal.wheels if signal.rms(wheel) > 0.0]
    if len(moving) < 2:
        return tuple({wheel: 1.0} for wheel in moving)
    plates = np.array([signal.displacement[wheel] for wheel in moving])
    labels = [f"plate_{wheel}_displacement" for wheel in moving]
    groups = common_motions(signal.timestep, plates, labels, signal.band(FRF_BAND))
    return tuple({moving[index]: factor for index, factor in group.items()} for group in groups)


def to_driven_plates(data: FrfData, motions: Sequence[Mapping[str, float]], where: str) -> FrfData:
    """Return FRFs of which every input is one of the motions of the plates; an unknown input is the only one."""
    driven = [plates_of(motion) for motion in motions]
    names = []
    for name in data.names:
        candidates = [ResponseName(name.output, motion) for motion in driven]
        try:
            pair = row_of(name, candidates)
        except DataError as error:
            raise DataError(f"{where}: {error}") from None
        if pair is None:
            raise DataError(
                f"{where}: {name}: is an FRF from the input {name.input}, but the signal drives "
                f"{', '.join(candidate.input for candidate in candidates)}; use the signal of this measurement, "
                "or choose other FRFs with --channels"
            )
        names.append(name if name.motion else candidates[pair[0]])
    return data.renamed(names)


def log_deviation(coherence: npt.ArrayLike, averages: npt.ArrayLike) -> Vector:
    """Return the standard deviation of ln|H| and of the phase [rad] of an estimated FRF.

    sigma^2 = (1 - gamma^2) / (2 gamma^2 n) + floor^2

    Args:
        coherence: gamma^2 [-].
        averages: number n of independent averages; an unknown number, taken as 1, changes only a common factor, which
            the fit estimates from the residuals.

    Returns:
        sigma [-]; NaN where the coherence is NaN or below `LEAST_COHERENCE`.

    Source: Bendat and Piersol, Random Data, 4th ed., section 9.2: the normalised random error of |H| and the standard
    deviation of the phase in radians are both sqrt(1 - gamma^2) / (|gamma| sqrt(2 n)).
    """
    gamma2 = np.asarray(coherence, dtype=float)
    gamma2 = np.where(gamma2 >= LEAST_COHERENCE, np.minimum(gamma2, 1.0), np.nan)
    return np.asarray(np.sqrt((1.0 - gamma2) / (2.0 * gamma2 * np.asarray(averages)) + FLOOR**2))
