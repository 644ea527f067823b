"""FRFs in the folder of a run, with the motions of its plates from the summary."""

from pathlib import Path

from vehicle.signals.analysis.response_name import ResponseName, parsed_name, plates_of
from vehicle.signals.formats.frf_file import FrfData, read_frf
from vehicle.signals.records.run_summary import MotionSummary, RunSummary

CHANNEL = "<channel>"
"""Output in the names of columns, see `MotionSummary`."""


def run_frf(path: Path, summary: RunSummary | None) -> FrfData:
    """Read the table of FRFs of a run under the names of its outputs and inputs.

    Args:
        summary: summary of the run, which contains the plates of each motion; None leaves them as the columns name
            them.

    Raises:
        ConfigurationError, DataError: see `read_frf`.
    """
    table = read_frf(path)
    estimate = None if summary is None else summary.frf
    if summary is None or estimate is None:
        return table
    motions = estimate.to or [MotionSummary(plates={summary.input.wheel: 1.0}, columns=CHANNEL)]
    ends = {motion.columns.removeprefix(CHANNEL): plates_of(motion.plates) for motion in motions}
    names = []
    for column in map(str, table.names):
        end = max((end for end in ends if column.endswith(end)), key=len, default=None)
        names.append(parsed_name(column) if end is None else ResponseName(column.removesuffix(end), ends[end]))
    return table.renamed(names)
