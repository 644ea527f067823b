"""A measurement put beside a run."""

from __future__ import annotations

from vehicle.comparison.frf_comparison import BANDS, FrfComparison, compare_responses
from vehicle.comparison.record_comparison import RecordComparison, compare_records, shifted
from vehicle.comparison.simulated import Simulated
from vehicle.comparison.tables import Comparison
from vehicle.errors import DataError
from vehicle.records.measured import Measured


def comparison_of(
    measured: Measured,
    simulated: Simulated,
    *,
    edges: tuple[float, ...] | None = None,
    delay: float = 0.0,
    window: float | None = None,
) -> Comparison:
    """Put a measurement beside a run.

    Args:
        measured: under the names of the run.
        simulated: the run.
        edges: of the bands [Hz]; octaves by default.
        delay: the measurement began this long after the run [s].
        window: as of `read_measured`, for both.

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
    if measured.record is not None:
        records = compare_records(measured.record, simulated.record, delay - measured.start)
        notices += shifted(records, delay)
    if not responses and not records:
        raise DataError(f"{measured.file.path}: nothing of it has a counterpart in the run {simulated.name}")
    return Comparison(
        measured=measured.file.path.name,
        simulated=simulated.name,
        responses=responses,
        signatures=signatures,
        records=records,
        notices=tuple(notices),
    )
