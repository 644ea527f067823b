"""What happens in a worker: the cases of a task become results, if it runs the same program."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_evaluation import evaluate
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.measure import Measure
from vehicle.studies.sweeps.program import require_same_program


def carry_out(cases: Sequence[Case], measure: Measure, program: str) -> list[Result]:
    """Carry out a task of a sweep.

    Args:
        cases, measure: the runs and what is kept of them.
        program: `program_digest` of the process that started the sweep.

    Returns:
        Results in the order of the cases.

    Raises:
        ConfigurationError: this process has another program.
    """
    require_same_program(program)
    return evaluate(cases, measure)
