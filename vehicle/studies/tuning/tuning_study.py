"""Study of a fit, run into a folder: fitted car, numbers, pictures, report, and the uncertainty of the parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from vehicle.model.parameters.car_choice import CarChoice
from vehicle.model.parameters.ranges import Range, parsed_variation
from vehicle.runs.car import Car
from vehicle.runs.output.destination import Destination
from vehicle.runs.output.folder import output_folder
from vehicle.settings import part
from vehicle.studies.tuning.car_fit import Bounds, ranges_of, require_fittable
from vehicle.studies.tuning.fit_settings import PosteriorSettings
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.measurement_settings import MeasurementSettings
from vehicle.studies.tuning.posterior import emulated_car, posterior_of, require_posterior
from vehicle.studies.tuning.posterior_text import NamedPosterior, posterior_lines
from vehicle.studies.tuning.tuned_car import TunedCar, tuned_car
from vehicle.studies.tuning.tuning_files import write_tuning
from vehicle.studies.tuning.tuning_text import tuning_text

OUTPUT = Path("runs/tune")
"""Folder of a fit without a name."""

Begin = Callable[[str], Callable[[float], None]]
"""Begins to show the progress of a work of this name; the result is called with the finished fraction."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TuningStudy:
    """Study of a fit, as the command runs it."""

    car: CarChoice = part(CarChoice)  # the car before the fit
    parameters: Mapping[str, Bounds]  # path to lower and upper bound, and optionally start value, see `vehicle.tune`
    measurements: MeasurementSettings  # measurement files and their settings
    engine: str = "mujoco"  # engine of the last steps
    posterior: bool = False  # also compute the distribution of the parameters
    uncertainty: PosteriorSettings = part(PosteriorSettings)  # settings of this distribution
    destination: Destination = part(Destination)  # folder of the results
    author: str = ""  # author, project: names in the head of the report
    project: str = ""

    def run(
        self,
        *,
        command: str = "",
        begin: Begin = lambda work: lambda fraction: None,
        noticed: Callable[[list[str]], None] = lambda notices: None,
    ) -> WrittenFit:
        """Fit the car and write the files of the fit.

        Args:
            command: command line of the study, for the files.
            begin: shows the progress.
            noticed: called with the notices on the measurements, before the fit.

        Raises:
            VehicleError: as in `vehicle.tune`; a measurement that cannot be read, a folder that cannot be written.
        """
        car = Car.load(self.car.vehicle, self.car.overrides)
        parameters = ranges_of(car.vehicle, self.parameters)
        require_fittable(parameters, car.vehicle)
        folder = self.destination.folder(OUTPUT, protect=self.measurements.protected)
        targets = self.measurements.targets(car)
        noticed(list(dict.fromkeys(text for target in targets for text in target.notices)))
        responses = [each.target for each in targets if isinstance(each.target, FrfTarget)]
        if self.posterior:
            require_posterior(responses)
        line = begin("fit       ")
        tuned = tuned_car(
            car,
            parameters,
            targets,
            engine=self.engine,
            # The number of cars is not known before: 12 for each parameter is usual.
            progress=lambda count, _: line(0.7 * count / (count + 6.0 * len(parameters))),
            simulated=lambda count: line(0.7 + 0.3 * count / (count + 2.0)),
        )
        posteriors = self._posteriors(car, parameters, responses, begin) if self.posterior else []
        line(1.0)
        to, protected = self.destination, self.measurements.protected
        with to.held, output_folder(folder, force=to.force, protect=protected) as work:
            files = write_tuning(work, tuned, command, posteriors, author=self.author, project=self.project)
        more = posterior_lines(posteriors, car.vehicle) if posteriors else []
        text = "\n".join([tuning_text(tuned), *more, f"{folder}: {', '.join(files)}"])
        return WrittenFit(text, tuned, folder)

    def _posteriors(
        self, car: Car, parameters: Sequence[Range], targets: Sequence[FrfTarget], begin: Begin
    ) -> list[NamedPosterior]:
        """Return the posteriors of the fitted law and of its rival."""
        laws, chosen = [("fitted law", car, parameters)], self.uncertainty
        if chosen.rival:
            laws.append(("rival law", *self._rival(parameters)))
        posteriors = []
        for name, law_car, law_parameters in laws:
            progress = begin(f"{name:<10}")
            emulated = emulated_car(law_car, law_parameters, targets, cars=chosen.samples, progress=progress)
            posteriors.append((name, posterior_of(emulated, discrepancy=chosen.discrepancy)))
        return posteriors

    def _rival(self, parameters: Sequence[Range]) -> tuple[Car, Sequence[Range]]:
        """Return the car with the rival law, and its parameters."""
        rival = [parsed_variation("--rival", text) for text in self.uncertainty.rival]
        settings = [f"{each.path}={each.values[0]}" for each in rival if each.bounds is None]
        fixed = {each.path for each in rival if each.bounds is None}
        car = Car.load(self.car.vehicle, [*self.car.overrides, *settings])
        bounds = {each.path: each.bounds for each in rival if each.bounds is not None}
        middles = {
            path: (low, high, (low * high) ** 0.5 if low > 0.0 else 0.5 * (low + high))
            for path, (low, high) in bounds.items()
        }
        shared = [entry for entry in parameters if entry.path not in {*fixed, *bounds}]
        return car, [*shared, *ranges_of(car.vehicle, middles)]


class WrittenFit(NamedTuple):
    """Fit whose files are written: the printed text, the fitted car, and the folder."""

    text: str
    tuned: TunedCar
    folder: Path

    def __str__(self) -> str:
        """Return the printed text: values, what the data leave open, posterior, files."""
        return self.text
