"""Mean magnitudes of FRFs in third-octave bands: the data of a posterior distribution."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.errors import DataError
from vehicle.runs.car import Car, Run
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.tuning.frf_target import FrfTarget

BATCH = 32
"""Number of cars of a batch: three channels of 60 s at 1 kHz are 46 MB."""

SEAT = ("seat_rail_acc_x", "seat_rail_acc_y", "seat_rail_acc_z")
"""Channels of the comfort value."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ResponseCells:
    """Means of ln|H| over third-octave bands of measured FRFs.

    With weights w_i = 1 / sigma_i^2 of the lines, y = sum w_i ln|H_i| / sum w_i has the variance 1 / sum w_i.
    """

    targets: tuple[FrfTarget, ...]  # measured FRFs
    weights: tuple[Vector, ...]  # for each target the normalised weights, (channels, bands, lines)
    data: Vector  # measured means, (cells,)
    noise: Vector  # standard deviations of the means from the coherence, (cells,)

    def of(self, responses: Sequence[Complex]) -> Vector:
        """Return the means of FRFs of each target, (channels, lines) -> (cells,).

        Raises:
            DataError: an FRF is zero or not finite at a line of the data.
        """
        means = []
        for weights, response in zip(self.weights, responses, strict=True):
            used = np.any(weights > 0.0, axis=1)
            size = np.where(used, np.abs(response), 1.0)
            if not (np.isfinite(size).all() and np.all(size > 0.0)):
                raise DataError("an FRF of the model is zero or not finite at a line of the data; narrow the --band")
            table = np.einsum("kbi,ki->kb", weights, np.log(size))
            means.append(table[np.any(weights > 0.0, axis=2)])
        return np.concatenate(means)


def response_cells(targets: Sequence[FrfTarget]) -> ResponseCells:
    """Return the means of measured FRFs with coherence or random error in third-octave bands."""
    if not targets:
        raise DataError(
            "--posterior needs measured FRFs; add --frf FILE (the uncertainty of the parameters is computed "
            "from FRFs in third-octave bands)"
        )
    all_weights, data, noise = [], [], []
    for target in targets:
        frequency = target.data.frequency
        has_noise = np.isfinite(target.data.random_error).any() or np.any(target.data.coherence < 1.0)
        if not has_noise:
            raise DataError(
                f"{target.name}: the FRFs have neither coherence nor random error, so their noise and the "
                "posterior are unknown; add the coherence to the file, or use time histories of accelerations "
                "and plate"
            )
        band = np.round(10.0 * np.log10(frequency)).astype(int)
        bands = np.unique(band)
        deviation = target.deviation
        usable = np.isfinite(deviation) & (np.abs(target.data.response) > 0.0)
        raw = np.where(usable, 1.0 / np.where(usable, deviation, 1.0) ** 2, 0.0)
        weights = np.stack([raw * (band == number) for number in bands], axis=1)
        sums = weights.sum(axis=2, keepdims=True)
        weights = np.divide(weights, sums, out=np.zeros_like(weights), where=sums > 0.0)
        size = np.where(usable, np.abs(target.data.response), 1.0)
        for row, column in zip(*np.nonzero(sums[:, :, 0] > 0.0), strict=True):
            data.append(float(weights[row, column] @ np.log(size[row])))
            noise.append(float(1.0 / np.sqrt(sums[row, column, 0])))
        all_weights.append(weights)
    return ResponseCells(targets=tuple(targets), weights=tuple(all_weights), data=np.array(data), noise=np.array(noise))


def evaluated_cars(
    cars: Sequence[Car], cells: ResponseCells, progress: Callable[[float], None] | None = None
) -> tuple[Vector, Vector]:
    """Return the cells of cars of one topology, and their comfort on each signal, by the reduced engine in batches.

    Returns:
        Means of ln|H|, (cars, cells), and comfort values [m/s2]: unweighted RMS of the seat rail, all axes, 2 to 50 Hz,
        (cars, signals).
    """
    rows, comfort = [], []
    signals = signals_of(cells)
    for first in range(0, len(cars), BATCH):
        batch = cars[first : first + BATCH]
        runs = [_batch_runs(batch, signal, cells) for signal in signals]
        for index, car in enumerate(batch):
            responses = [
                target.model_response(car)
                if target.signal is None
                else target.estimated(runs[signals.index(target.signal)][index])
                for target in cells.targets
            ]
            rows.append(cells.of(responses))
            comfort.append([each[index].comfort().unweighted.overall for each in runs])
        if progress is not None:
            progress(min(first + BATCH, len(cars)) / len(cars))
    return np.array(rows), np.array(comfort).reshape(len(cars), len(signals))


def signals_of(cells: ResponseCells) -> list[Signal]:
    """Return the distinct signals of the targets."""
    return list(dict.fromkeys(target.signal for target in cells.targets if target.signal is not None))


def _batch_runs(cars: Sequence[Car], signal: Signal, cells: ResponseCells) -> list[Run]:
    """Return runs of a batch of cars with the channels of all targets on this signal and of the seat rail."""
    needed = [name for target in cells.targets if target.signal is signal for name in target.recorded]
    batch = simulate_batch(
        [car.poles for car in cars],
        signal,
        dampers=[[damper.law for damper in car.vehicle.composition.dampers] for car in cars],
        record_rate=cars[0].vehicle.solver.record_rate,
        tyre_load=[car.static.tyre_load for car in cars],
        channels=tuple(dict.fromkeys([*needed, *SEAT])),
    )
    return [
        Run(car=car, signal=signal, recording=batch.recording(index), engine_reason="batch", skip=0.0)
        for index, car in enumerate(cars)
    ]
