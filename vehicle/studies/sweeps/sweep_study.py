"""Study of a sweep: a design on its inputs, run into a folder with the files and the report of its evaluation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.car import Car
from vehicle.runs.output.destination import Destination, ReportChoice
from vehicle.runs.output.folder import study_folder, write_files, write_text
from vehicle.settings import part
from vehicle.studies.sweeps.differences import DIFFERENCES
from vehicle.studies.sweeps.plan import Design
from vehicle.studies.sweeps.store import ROWS
from vehicle.studies.sweeps.sweep_inputs import Inputs
from vehicle.studies.sweeps.sweep_settings import SweepSettings

OUTPUT = Path("runs/sweep")
"""Folder of a sweep without a name."""

SHOWN = 5
"""Maximum number of failed runs in the printed lines."""

Begin = Callable[..., Callable[[float], None]]
"""Shows the progress of a work, by its name and the number of its `runs`; the result takes the finished fraction."""


def unseen(text: str, runs: int = 0) -> Callable[[float], None]:
    """Show no progress, and no message."""
    return lambda fraction: None


@dataclass(frozen=True, kw_only=True, slots=True)
class SweepStudy:
    """Study of a sweep, as the command runs it."""

    design: Design  # varied parameters, and evaluation of their table
    car: CarChoice = part(CarChoice)  # the car
    inputs: Inputs = ()  # files, names of shipped files, roads or signals; a `CaseFile` has its own
    runs: SweepSettings = part(SweepSettings)  # settings of the runs
    destination: Destination = part(Destination)  # folder of the results
    report: ReportChoice = part(ReportChoice)  # report of the evaluation
    allow_failed: bool = False  # accept a table with failed runs as success

    def run(
        self,
        *,
        command: str = "",
        begin: Begin = unseen,
        note: Callable[[str], object] = unseen,
        notice: Callable[[str], None] | None = None,
    ) -> StudyResult:
        """Run the sweep, and write the table, the files of its evaluation and the report.

        Args:
            command: command line of the study, for the report.
            begin: shows the progress.
            note: called with the messages on side effects of the varied parameters and on the engine, before the runs.
            notice: called with messages during the runs, for example that a cluster has no workers.

        Raises:
            VehicleError: as in `sweep`; a folder that cannot be written.
        """
        car = Car.load(self.design.vehicle or self.car.vehicle, self.car.overrides)
        plan = self.design.plan(car, self.inputs, self.runs)
        to = self.destination
        output = to.study_folder(OUTPUT, rows=(ROWS,))
        report = self.report.path(to, output)
        notes = (*plan.notes, *plan.engine_notes(), *plan.range_notes())
        for text in notes:
            note(text)
        caption = f"tyres {plan.tyres}, evaluated from {plan.skip:g} s on"
        with to.held, study_folder(output, force=to.force, resume=to.resume, rows=(ROWS,)) as folder:
            table = plan.run(folder=folder, progress=begin("sweep     ", runs=len(plan.cases)), notice=notice)
            evaluation = plan.evaluation_of(table, caption)
            write_files(folder, evaluation.files)
            if report is not None:
                from vehicle.studies.sweeps.sweep_page import sweep_page

                head = {"author": self.report.author, "project": self.report.project}
                page = sweep_page(table, evaluation, plan.name, caption=caption, command=command, notes=notes, **head)
                write_text(folder / report if report.parent == Path() else report, page)
            # Read before the folder of the rows gets its name.
            failed, differences = table.failed, (folder / DIFFERENCES).exists()
        files = ["table.csv", *([] if report is None else [str(report)]), *evaluation.files]
        files += [f"{DIFFERENCES} (comfort relative to the first car)"] if differences else []
        counts = f"{len(plan.cases)} runs, {len(failed)} failed, {caption}"
        first = f"{output}: {counts}; {', '.join([*files, 'sweep.json, rows.jsonl, timing.csv'])}"
        reasons = (f"failed      {case.label}: {reason}" for case, reason in failed[:SHOWN])
        return StudyResult("\n".join([first, *evaluation.lines, *reasons]), len(plan.cases), len(failed))


class StudyResult(NamedTuple):
    """Result of a study, whose numbers are in its folder: its printed text, number of runs, number of failed runs."""

    text: str
    runs: int
    failed: int

    def __str__(self) -> str:
        """Return the printed text."""
        return self.text
