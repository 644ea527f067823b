"""Function that a worker runs: evaluate the cases of a task with the same program as the sweep."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_evaluation import evaluate
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.measure import Measure
from vehicle.studies.sweeps.program import require_same_program


def carry_out(cases: Sequence[Case], measure: Measure, program: str) -> list[Result]:
    """Run the cases of a task.

    Args:
        cases: the runs.
        measure: measure of the runs.
        program: `program_digest` of the process that started the sweep.

    Returns:
        Results in the order of the cases.

    Raises:
        ConfigurationError: the program of this process differs.
    """
    require_same_program(program)
    return evaluate(cases, measure)
