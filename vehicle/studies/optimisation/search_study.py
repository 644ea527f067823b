"""Studies of a search, run into a folder: a Pareto front, or the smallest change to reach targets."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle.model.parameters.car_choice import CarChoice
from vehicle.model.parameters.ranges import Range
from vehicle.runs.car import Car
from vehicle.runs.output.destination import Destination
from vehicle.runs.output.folder import study_folder, write_json, write_text
from vehicle.runs.output.own_files import parameters_text, write_own_files
from vehicle.runs.targets.verdict import read_targets
from vehicle.settings import part
from vehicle.signals.excitation.road_drive import USUAL_DURATION
from vehicle.studies.optimisation.car_search import plan_search
from vehicle.studies.optimisation.car_table import CARS
from vehicle.studies.optimisation.search_files import read_other_front
from vehicle.studies.optimisation.search_settings import SearchSettings
from vehicle.studies.optimisation.stored_search import SEARCH
from vehicle.studies.optimisation.target_search import meet_targets, outlook
from vehicle.studies.sweeps.sweep_inputs import Inputs
from vehicle.studies.sweeps.sweep_study import Begin, unseen

OUTPUT = Path("runs/optimise")
"""Folder of a search without a name."""

ROWS = (CARS, SEARCH)
"""Files of finished cars."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SearchStudy:
    """Study of a search for a Pareto front, see `optimise`."""

    car: CarChoice = part(CarChoice)  # the car
    vary: Mapping[str, Sequence[float]] | Sequence[Range]  # path to bounds, or ranges
    inputs: Inputs  # files, names of shipped files, roads or signals
    minimise: Sequence[str]  # objectives
    settings: SearchSettings = part(SearchSettings)  # settings of the search
    beside: Path | None = None  # folder of another search with these objectives, drawn with its distance
    destination: Destination = part(Destination)  # folder of the results

    def run(self, *, command: str = "", begin: Begin = unseen, note: Callable[[str], object] = unseen) -> str:
        """Run the search, write its files and return the printed table of its named cars.

        Args:
            command: command line of the study, for its files.
            begin: shows the progress.
            note: called with messages on durations chosen for a precision, and on the size of a search for targets.

        Raises:
            VehicleError: as in `optimise`; a folder that cannot be written.
        """
        car = Car.load(self.car.vehicle, self.car.overrides)
        plan = plan_search(car, self.vary, self.inputs, self.minimise, self.settings)
        for chosen in dict.fromkeys(getattr(source, "chosen", "") for source in plan.trials.inputs):
            if chosen:
                note(chosen)
        beside = None if self.beside is None else read_other_front(self.beside, plan.trials.problem)
        to = self.destination
        output = to.study_folder(OUTPUT, rows=ROWS)
        with to.held, study_folder(output, force=to.force, resume=to.resume, rows=ROWS) as folder:
            cars = plan.run(folder, progress=begin("optimise  "))
            cars.write(folder, beside=beside, command=command)
        return cars.text(output, beside)


@dataclass(frozen=True, kw_only=True, slots=True)
class TargetStudy:
    """Study of the smallest change with which a car reaches targets, see `meet_targets`."""

    car: CarChoice = part(CarChoice)  # the car
    vary: Sequence[Range]  # ranges of at most 8 parameters
    targets: Path  # file of figures with limits and inputs
    cost: Sequence[tuple[str, float]] = ()  # path and cost of the change of a parameter; 1 by default
    duration: float | None = None  # length of a road class [s]; by default the length of a run
    jobs: int = 1  # number of processes
    destination: Destination = part(Destination)  # folder of the results

    def run(self, *, command: str = "", begin: Begin = unseen, note: Callable[[str], object] = unseen) -> str:
        """Run the search, write its files and return the printed result; arguments as in `SearchStudy.run`.

        Raises:
            VehicleError: as in `meet_targets`; a wrong file of targets, a folder that cannot be written.
        """
        car, figures = Car.load(self.car.vehicle, self.car.overrides), read_targets(self.targets)
        to = self.destination
        output = to.study_folder(OUTPUT)
        note(outlook(len(self.vary), figures, USUAL_DURATION if self.duration is None else self.duration))
        with to.held, study_folder(output, force=to.force) as folder:
            result = meet_targets(
                car,
                figures,
                self.vary,
                duration=self.duration,
                costs=dict(self.cost),
                jobs=self.jobs,
                progress=begin("optimise  "),
            )
            write_text(folder / "vehicle.toml", parameters_text(result.car, result.sentence))
            write_own_files(folder, result.car)
            write_json(folder / "summary.json", {**result.summary(), "command": command})
        files = f"{output}: {result.change.runs} cars on {', '.join(result.inputs)}; vehicle.toml, summary.json"
        return f"{files}\n{result}"
