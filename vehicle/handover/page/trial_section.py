"""Section of the report in which the reader changes the car of the run, which then runs in the page."""

from __future__ import annotations

from vehicle.errors import ConfigurationError, VehicleError
from vehicle.handover.page.page_input import LONGEST, RunRoad
from vehicle.handover.page.trial_data import PAGE, WORKER, scripts, trial_data
from vehicle.runs.report.finished_run import FinishedRun, recorded_signal
from vehicle.runs.report.markup import Markup, joined, tag
from vehicle.runs.report.page import Trial


def trial(run: FinishedRun) -> Trial:
    """Return the section with its numbers and scripts.

    If the page cannot run this car on these plates, the numbers are empty and the content is the reason.

    Args:
        run: the run.
    """
    try:
        return Trial(content=_content(run), numbers=_numbers(run), script=scripts(PAGE), worker=scripts(WORKER))
    except KeyError as error:
        reason = f"the summary of the run lacks {error}"
    except VehicleError as error:
        reason = str(error)
    return Trial(content=tag("p", f"This report has no sliders for this car or input: {reason.rstrip('.')}."))


def _numbers(run: FinishedRun) -> str:
    """Return the numbers of the script as JSON.

    Args:
        run: the run.

    Raises:
        ConfigurationError: see `trial_data`; the road is seen through cams; a moving plate is not recorded.
        KeyError: the summary is that of an older version.
    """
    begin, _ = run.summary.get("evaluated_s") or (0.0, 0.0)
    road = run.summary["input"].get("road") or {}
    if road.get("tyre_contact"):
        raise ConfigurationError("the tyres see the obstacle through cams, whose slopes are not in the record")
    signal = recorded_signal(run)
    speed = road.get("speed_kmh")
    driven = RunRoad(road_class=road.get("class"), speed=speed, behind=road["behind_m"]) if speed else None
    return trial_data(run.car, signal, wheel=run.wheel, skip=begin, road=driven)


def _content(run: FinishedRun) -> Markup:
    """Return sentence, plots, table and controls, which the script of the page fills."""
    duration = min(float(run.recording.time[-1]), LONGEST)
    engine = run.summary["solver"]["engine"]
    other = "" if engine == "reduced" else " The run itself used the MuJoCo engine, so its numbers differ a little."
    plots = {
        "picture": "The moving car",
        "density": "Density of the acceleration of the seat rail",
        "frf": "Frequency response of the seat rail",
        "force": "Force of a damper over its velocity",
        "time": "Acceleration of the seat rail over a second",
    }
    canvases = [
        tag("canvas", id=f"trial-{name}", role="img", aria_label=f"{label}: A grey, B red")
        for name, label in plots.items()
    ]
    picture = [
        tag("label", "", for_="trial-factor", id="trial-factor-words"),
        Markup('<input type="range" id="trial-factor" min="0" max="1" step="1">'),
        tag("button", "Pause", type="button", id="trial-play"),
    ]
    return joined(
        [
            tag("p", "Computing ...", class_="answer", id="trial-words"),
            tag("noscript", tag("p", "This section needs JavaScript; the others do not.")),
            tag(
                "div",
                tag("div", tag("div", *canvases, class_="plots"), tag("table", id="trial-table")),
                tag("div", tag("div", id="trial-controls"), *picture, class_="controls"),
                class_="modes",
            ),
            tag("p", id="trial-notices"),
            tag(
                "p",
                "Grey: A, the reference; red: B, the car with these settings. The page computes the first "
                f"{duration:g} s. Friction, Stribeck parameters, level and road class recompute exactly. Stiffness and "
                "speed are stored in steps; change one of them at a time (histories within 0.02 % of their peaks). "
                "The damper curve is within 0.1 %; with Stribeck friction single peaks may differ by up to 4 %, "
                "comfort by 0.002 %. Comfort is the weighted acceleration of the seat rail (vector sum, ISO 2631-1); "
                "lower is better."
                f"{other} ",
                tag("span", id="trial-time-used"),
                class_="about",
            ),
        ]
    )
