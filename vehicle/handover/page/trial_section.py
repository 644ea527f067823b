"""Section of the report in which the reader changes the car of the run, which then runs in the page."""

from collections.abc import Sequence

from vehicle.errors import ConfigurationError, VehicleError
from vehicle.handover.page.page_input import LONGEST, RunRoad
from vehicle.handover.page.trial_data import PAGE, WORKER, scripts, trial_data
from vehicle.runs.output.saved_run import recorded_signal
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import templates
from vehicle.runs.report.page import Trial

fill = templates(__file__)


def trial(run: FinishedRun, measure: Sequence[str] = ()) -> Trial:
    """Return the section with its numbers and scripts.

    If the page cannot run this car on these plates, the numbers are empty and the content is the reason.

    Args:
        run: finished run.
        measure: further figures of the table by their names in the catalogue.
    """
    try:
        numbers = _numbers(run, measure)
    except KeyError as error:
        reason = f"the summary of the run lacks {error}"
    except VehicleError as error:
        reason = str(error)
    else:
        return trial_of(numbers, min(float(run.recording.time[-1]), LONGEST), run.summary.solver.engine)
    return Trial(content=fill("trial", reason=reason.rstrip(".")))


def trial_of(numbers: str, duration: float, engine: str = "reduced") -> Trial:
    """Return the section for given numbers.

    Args:
        numbers: numbers of its scripts (`trial_data`).
        duration: length of the record in the page [s].
        engine: engine of the run with which the page is compared.
    """
    content = fill("trial", reason="", duration=duration, engine=engine)
    return Trial(content=content, numbers=numbers, script=scripts(PAGE), worker=scripts(WORKER))


def _numbers(run: FinishedRun, measure: Sequence[str]) -> str:
    """Return the numbers of the script as JSON.

    Raises:
        ConfigurationError: see `trial_data`; the car has applied forces; the road is seen through cams; a moving plate
            is not recorded.
        KeyError: the summary is that of an older version.
    """
    if run.car.vehicle.composition.forces:
        raise ConfigurationError("the car in the browser has no forces of powertrain and wheels")
    road = run.summary.input.road or {}
    if road.get("tyre_contact"):
        raise ConfigurationError(
            "the tyres roll over the obstacle with cams, and the record does not contain the slopes of the cams"
        )
    signal = recorded_signal(run.summary, run.recording)
    speed = road.get("speed_kmh")
    driven = RunRoad(road_class=road.get("class"), speed=speed, behind=road["behind_m"]) if speed else None
    return trial_data(run.car, signal, wheel=run.wheel, skip=run.skip, road=driven, measure=measure)
