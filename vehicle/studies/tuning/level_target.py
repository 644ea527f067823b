"""FRFs in classes of the input level as a target of a fit: friction makes the response depend on the level."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.arrays import Complex, Mask, Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.car import Car, Run
from vehicle.signals.analysis.phase_delay import PhaseDelay
from vehicle.signals.analysis.response_name import ResponseName
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.formats.frf_file import FrfData
from vehicle.studies.tuning.frf_target import FLOOR, LEAST_COHERENCE, late, response_lags, scaled_ratio
from vehicle.studies.tuning.record_target import RecordTarget, RoadCar
from vehicle.studies.tuning.response_delays import ResponseDelays

Indices = npt.NDArray[np.int64]

LEAST_SEGMENTS = 8
"""Minimum number of windows of a class. With 8 the stated errors of fitted values are right within 10 % (12 records of
11 s, 3 % noise); with 4 they were too small by a factor of 1.4."""

SHARED = 1.0 / 36.0
"""Correlation of the spectra of two Hann windows with half overlap, squared (Welch 1967): neighbours of a class count
as 1 / (1 + 2 / 36) windows each."""

INDEPENDENT = 0.1
"""Minimum ratio of singular values of the spectra of two plates that count as two inputs: tracks with a coherence above
0.98 are one."""

LEAST_LINES = 20
"""Minimum number of lines of a row of the residuals; see `LEAST_SEGMENTS`, with 10 lines the errors came out 10 % too
small."""

SMOOTHED = 9
"""Number of lines over which the power of the noise is averaged: a class of few windows has few degrees of freedom at
one line, and weights that scatter with them would make the stated errors too small."""

RESOLUTION = 1.5
"""Minimum distance of the lines times the window length: the noise bandwidth of the Hann window."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LevelTarget:
    """Target of a fit: FRFs of a record in classes of the level of its input.

    The record is cut into Hann windows with half overlap. Windows with a similar RMS of the reference form a class,
    and each class has its FRF H1 = sum X* Y / sum |X|^2. The run of the model is cut at the same times, so that
    leakage and the other wheels of a road act alike on both. Residuals: see `FrfTarget`. The random error of H is that
    of the part of the response that is coherent with no plate of the axle (multiple coherence, Bendat and Piersol,
    section 7.3): the other plates are no noise.
    """

    histories: RecordTarget  # the record, its signal and its road
    reference: str  # input channel of the FRFs: a plate, or a measured channel of the record
    window: float  # length of the windows [s]
    starts: Indices  # first sample of each window, (windows,)
    classes: Indices  # class of each window, (windows,)
    lines: Indices  # lines of the spectrum of a window, (m,)
    data: FrfData  # measured FRFs; a channel for each channel of the record and class

    @property
    def name(self) -> str:
        """Name of the record."""
        return self.histories.name

    @property
    def signal(self) -> Signal:
        """Plate displacement."""
        return self.histories.signal

    @property
    def road(self) -> RoadCar | None:
        """Car on the road of the record; None on a rig."""
        return self.histories.road

    @property
    def quantity(self) -> str:
        """Quantity of the FRFs, for an axis."""
        unit = "m" if self.reference.endswith("_displacement") else "(m/s²)"
        return f"acceleration / {self.reference}\n[(m/s²)/{unit}]"

    @property
    def rows(self) -> tuple[str, ...]:
        """Return the names of the rows of the residuals."""
        first = self.data.frequency[:: self.lines_per_row]
        return tuple(
            f"{self.name}, {name}, {part}, from {low:.3g} Hz"
            for name in self.data.channels
            for part in ("magnitude", "phase")
            for low in first
        )

    @property
    def lines_per_row(self) -> int:
        """Return the number of lines of a row of the residuals.

        The noise of a sensor is flat over frequency, the error of a model is proportional: the fit estimates the size
        of the residuals in each part of the band by itself.
        """
        return -(-self.lines.size // max(self.lines.size // LEAST_LINES, 1))

    @property
    def recorded(self) -> tuple[str, ...]:
        """Return the names of the channels of a run that the target needs."""
        return tuple(dict.fromkeys((*self.histories.recorded, self.reference)))

    @property
    def deviation(self) -> Vector:
        """Return the standard deviation of ln H [-], (rows, m); NaN where the coherence is too low."""
        deviation = np.hypot(self.data.random_error / np.abs(self.data.response), FLOOR)
        return np.asarray(np.where(self.data.coherence >= LEAST_COHERENCE, deviation, np.nan))

    def run(self, car: Car, engine: str = "reduced") -> Run:
        """Return the run of a car on the signal; arguments: see `RecordTarget.run`."""
        return self.histories.run(car, engine, self.recorded)

    @property
    def delays(self) -> ResponseDelays:
        """Return the delays of the channels of the record."""
        return self.histories.delays

    @property
    def half_sample(self) -> float:
        """Return half the sampling interval of the measurement [s]."""
        return self.histories.half_sample

    @property
    def outputs(self) -> tuple[str, ...]:
        """Return the channel of the record for each FRF."""
        classes = int(self.classes.max()) + 1
        return tuple(name for name in _fitted(self.histories, self.reference) for _ in range(classes))

    def response(self, model: Car | Run) -> Complex:
        """Return the FRFs of the classes without delays, for a run, or for a car with the reduced engine, (rows, m)."""
        run = model if isinstance(model, Run) else self.histories.fast(model, self.recorded)
        histories = np.array([run[name] for name in _fitted(self.histories, self.reference)])
        length = round(self.window / self.histories.record.step)
        x, y = (_spectra(part, self.starts, self.lines, length) for part in (run[self.reference][None], histories))
        return np.array([_transfer(x[0], each, chosen) for each in y for chosen in _members(self.classes)])

    def model_response(self, model: Car | Run) -> Complex:
        """Return the FRFs of the classes with the known delays, (rows, m)."""
        return late(self.response(model), self.data.frequency, self._delays({}, {}))

    def _delays(self, groups: Mapping[str, float], lags: Mapping[str, float]) -> Vector:
        """Return the delay of each FRF against the reference, which is late itself if it is a measured channel [s]."""
        reference = self.delays.of([self.reference], groups, lags)
        return self.delays.of(self.outputs, groups, lags) - reference

    def misfit(self, response: Complex, groups: Mapping[str, float], lags: Mapping[str, float]) -> Vector:
        """Return the residuals of FRFs, see `FrfTarget.misfit`, in rows of `lines_per_row`, (rows, lines of a row).

        The windows are not moved: a delay of 1 % of their length lowers |H| by less than 0.1 %.
        """
        turned = late(response, self.data.frequency, self._delays(groups, lags))
        rows = scaled_ratio(self.data.response, turned, self.deviation)
        parts = -(-self.lines.size // self.lines_per_row)
        whole = np.zeros((rows.shape[0], parts * self.lines_per_row))
        whole[:, : self.lines.size] = rows
        return whole.reshape(-1, self.lines_per_row)

    def settled(self, groups: Mapping[str, float]) -> Self:
        """Return the target with known delays of all groups [s]."""
        return replace(self, histories=self.histories.settled(groups))

    def lags(self, model: Car) -> dict[str, PhaseDelay]:
        """Return the lag of best agreement with a car for each channel; only channels with the same motion."""
        lags = response_lags(self.data, self.response(model), self.deviation)
        named = dict(zip(self.data.channels, self.outputs, strict=True))
        return {named[channel]: lag for channel, lag in lags.items()}


def level_target(
    histories: RecordTarget,
    reference: str,
    excitation: Vector,
    plates: Vector,
    *,
    levels: int,
    window: float,
    band: tuple[float, float],
    spacing: float,
) -> LevelTarget:
    """Return the FRFs of a record in classes of the input level.

    Args:
        excitation: values of the reference at the times of the record, (n,).
        plates: displacements of the plates of the axle of the reference, (plates, n).
        levels: number of classes; each has the same number of windows.
        window: length of the windows [s].
        band: lowest and highest frequency [Hz].
        spacing: minimum distance of the frequencies [Hz].
    """
    if levels < 2:
        raise ConfigurationError(f"--levels {levels}: must be at least 2 classes; for one class use --frf")
    step, inside = histories.record.step, np.flatnonzero(histories.inside)
    length = round(window / step)
    hop = max(length // 2, 1)
    starts = inside[0] + hop * np.arange(max((inside.size - length) // hop + 1, 0))
    needed = levels * LEAST_SEGMENTS
    if starts.size < needed:
        raise DataError(
            f"{histories.name}: {inside.size * step:.4g} s contain {starts.size} windows of {window:g} s; {levels} "
            f"classes need {needed}, {(needed + 1) * hop * step:.4g} s: use a longer record, a shorter --window or "
            "fewer --levels"
        )
    rms = np.array([np.std(excitation[start : start + length]) for start in starts])
    order = np.argsort(rms, kind="stable")
    classes = np.empty(starts.size, dtype=np.int64)
    classes[order] = np.arange(starts.size) * levels // starts.size
    every = max(int(np.ceil(max(spacing, RESOLUTION / window) * window - 1e-9)), 1)
    lines = np.arange(int(np.ceil(band[0] * window - 1e-9)), int(band[1] * window + 1e-9) + 1, every)
    lines = lines[lines > 0]
    if lines.size < 2:
        raise ConfigurationError(
            f"--band {band[0]:g}:{band[1]:g}: windows of {window:g} s have fewer than 2 lines there"
        )
    fitted = _fitted(histories, reference)
    measured = np.array([histories.record.channels[name] for name in fitted])
    x, y, inputs = (_spectra(part, starts, lines, length) for part in (excitation[None], measured, plates))
    members = _members(classes)
    response = np.array([_transfer(x[0], each, chosen) for each in y for chosen in members])
    coherence = np.array([_coherence(x[0], each, chosen) for each in y for chosen in members])
    error = np.array([_random_error(x[0], each, inputs, chosen) for each in y for chosen in members])
    unit, factor = ("mm", 1e3) if reference.endswith("_displacement") else ("m/s2", 1.0)
    ranges = [factor * rms[chosen] for chosen in members]
    name = reference.removesuffix("_displacement")
    names = tuple(
        ResponseName(f"{channel}, {name} {each.min():.3g} to {each.max():.3g} {unit} RMS", ((name, 1.0),))
        for channel in fitted
        for each in ranges
    )
    target = LevelTarget(
        histories=histories,
        reference=reference,
        window=window,
        starts=starts,
        classes=classes,
        lines=lines,
        data=FrfData(frequency=lines / window, names=names, response=response, coherence=coherence, random_error=error),
    )
    if not np.isfinite(target.deviation).any():
        raise DataError(
            f"{histories.name}: no channel is coherent with the input {reference}; choose another --reference"
        )
    return target


def _fitted(histories: RecordTarget, reference: str) -> tuple[str, ...]:
    """Return the channels of the record without the reference."""
    return tuple(name for name in histories.record.channels if name != reference)


def _members(classes: Indices) -> list[Mask]:
    """Return the mask of the windows of each class."""
    return [classes == number for number in range(int(classes.max()) + 1)]


def _spectra(histories: Vector, starts: Indices, lines: Indices, length: int) -> Complex:
    """Return the spectra of the windows, (histories, windows, m)."""
    hann = scipy.signal.get_window("hann", length)
    pieces = histories[:, starts[:, None] + np.arange(length)]
    pieces = pieces - pieces.mean(axis=2, keepdims=True)
    return np.asarray(np.fft.rfft(hann * pieces, axis=2)[:, :, lines])


def _transfer(x: Complex, y: Complex, chosen: Mask) -> Complex:
    """Return H1 = sum X* Y / sum |X|^2 over the chosen windows, (m,); NaN without input."""
    power = np.sum(np.abs(x[chosen]) ** 2, axis=0)
    across = np.sum(np.conj(x[chosen]) * y[chosen], axis=0)
    return np.asarray(np.divide(across, power, out=np.full(power.shape, np.nan + 0j), where=power > 0.0))


def _coherence(x: Complex, y: Complex, chosen: Mask) -> Vector:
    """Return |sum X* Y|^2 / (sum |X|^2 sum |Y|^2) over the chosen windows, (m,)."""
    product = np.sum(np.abs(x[chosen]) ** 2, axis=0) * np.sum(np.abs(y[chosen]) ** 2, axis=0)
    across = np.abs(np.sum(np.conj(x[chosen]) * y[chosen], axis=0)) ** 2
    return np.asarray(np.divide(across, product, out=np.zeros(product.shape), where=product > 0.0))


def _random_error(x: Complex, y: Complex, inputs: Complex, chosen: Mask) -> Vector:
    """Return the standard error of Re H and Im H, (m,): sqrt(R / (2 n sum |X|^2 / n)).

    R is the mean power of the part of Y that no combination of the inputs explains, over n - p degrees of freedom with
    n independent windows and p inputs, averaged over neighbouring lines.

    Args:
        x, y: spectra of the reference and of the response, (windows, m).
        inputs: spectra of the plates, (p, windows, m).
    """
    members = np.flatnonzero(chosen)
    neighbours = int(np.count_nonzero(np.diff(members) == 1))
    independent = members.size / (1.0 + 2.0 * SHARED * neighbours / members.size)
    table = np.moveaxis(inputs[:, chosen], 2, 0).transpose(0, 2, 1)  # (m, windows, p)
    output = y[chosen].T[:, :, None]
    unexplained = output - table @ (np.linalg.pinv(table, rcond=INDEPENDENT) @ output)
    rank = np.linalg.matrix_rank(table, tol=INDEPENDENT * np.linalg.norm(table, axis=(1, 2)))
    power = np.sum(np.abs(unexplained[:, :, 0]) ** 2, axis=1) / np.maximum(independent - rank, 1.0)
    power = scipy.ndimage.uniform_filter1d(power, SMOOTHED, mode="nearest")
    return np.asarray(np.sqrt(0.5 * power / np.sum(np.abs(x[chosen]) ** 2, axis=0)))
