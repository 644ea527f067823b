"""A measurement put beside a run."""

from __future__ import annotations

import numpy as np

from vehicle.errors import DataError
from vehicle.runs.comparison.frf_comparison import BANDS, FrfComparison, compare_responses
from vehicle.runs.comparison.record_comparison import RecordComparison, compare_records, unlike_copies
from vehicle.runs.comparison.simulated import Simulated
from vehicle.runs.comparison.tables import Comparison
from vehicle.signals.records.counterpart import clock_advice, response_faults, run_times, sign_and_unit
from vehicle.signals.records.measured import Measured


def comparison_of(
    measured: Measured,
    simulated: Simulated,
    *,
    edges: tuple[float, ...] | None = None,
    delay: float = 0.0,
    drift: float = 0.0,
    window: float | None = None,
    command: str = "",
) -> Comparison:
    """Put a measurement beside a run.

    Args:
        measured: under the names of the run.
        simulated: the run.
        edges: of the bands [Hz]; octaves by default.
        delay: the measurement began this long after the run [s].
        drift: the clock of the measurement is slow by this share [-].
        window: as of `read_measured`, for both.
        command: what has the options --delay and --drift, where the one that was typed has not.

    Raises:
        DataError: nothing in common.
    """
    responses: tuple[FrfComparison, ...] = ()
    signatures, notices = None, list(measured.notices)
    if measured.frf is not None:
        names = [name for name in measured.frf.channels if name in simulated.record.channels]
        other = simulated.responses(names, window) if names else None
        if other is None:
            notices.append("the run has no responses to compare with")
        else:
            responses, signatures = compare_responses(measured.frf, other, edges or BANDS)
    records: tuple[RecordComparison, ...] = ()
    judged: set[str] = set()
    if measured.record is not None:
        times = run_times(measured.record, delay, drift, measured.start)
        records, parts = compare_records(measured.record, simulated.record, times)
        step = records[0].time[1] - records[0].time[0] if records else 0.0
        notices += clock_advice(parts, float(step), delay, drift, command)
        notices += [*sign_and_unit(parts), *unlike_copies(records)]
        judged = {part.channel for part in parts if part.reliable_shift}
    for one in responses:
        if one.channel not in judged:
            weight = np.nan_to_num(one.measured_coherence, nan=1.0) * np.nan_to_num(one.simulated_coherence, nan=1.0)
            notices += response_faults(one.channel, one.measured, one.simulated, weight)
    if not responses and not records:
        raise DataError(f"{measured.file.path}: nothing of it has a counterpart in the run {simulated.name}")
    return Comparison(
        measured=measured.file.path.name,
        simulated=simulated.name,
        responses=responses,
        signatures=signatures,
        records=records,
        notices=tuple(notices),
        tyres=simulated.tyres,
    )
