"""Sections of a report: tables and figures of one run."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from markupsafe import Markup

from vehicle.digits import number
from vehicle.drawing.rendering.plots import plot_time
from vehicle.engines.linear.car_modes import Mode
from vehicle.model.parameters.shipped import VEHICLES
from vehicle.names import side_of
from vehicle.runs.report.comfort_class import reactions
from vehicle.runs.report.differences import changed_parameters, shipped_origin
from vehicle.runs.report.findings import findings
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.general_notices import without_general
from vehicle.runs.report.markup import templates
from vehicle.runs.report.order_words import force_rows
from vehicle.runs.report.svg_figure import drawing
from vehicle.signals.records.run_summary import slip_shares

fill = templates(__file__)

ROAD_WORDS = {
    "class": "class of ISO 8608",
    "profile": "profile",
    "speed_kmh": "speed [km/h]",
    "seed": "seed",
    "words": "road",
}


def tiles(run: FinishedRun) -> Markup:
    """Return the key figures of a run as tiles."""
    summary = run.summary
    shares = slip_shares(summary)
    values = []
    for point, value in list(run.comfort.items())[:1]:
        total = value["iso2631"]["vector_sum"]["weighted_rms"]
        label = f"weighted acceleration at the {point.replace('_', ' ')}, {' to '.join(reactions(total))}"
        values.append((f"{number(total)} m/s²", label))
    values += [
        (f"{number(100 * share, 2)} %", f"of the time in slip, {side_of(wheel, shares)} damper")
        for wheel, share in shares.items()
    ]
    for wheel, plate, resonances in run.peaks[:1]:
        if peaks := resonances.get(f"knuckle_{wheel}_acc_z"):
            top = max(peaks, key=lambda peak: peak["magnitude"])
            to_plate = f", FRF to the {plate}" if plate else ""
            label = f"highest resonance of the vertical motion of the knuckle{to_plate}"
            values.append((f"{top['frequency_hz']:.1f} Hz", label))
    if summary["input"]["rms_m"]:
        plate = side_of(run.wheel, run.car.vehicle.wheels)
        values.append((f"{1e3 * summary['input']['rms_m']:.3g} mm", f"RMS displacement of the {plate} plate"))
    return fill("tiles", values=values)


def what_was_found(run: FinishedRun, modes: Mapping[str, Sequence[Mode]]) -> Markup:
    """Return findings by topic."""
    topics: dict[str, list[str]] = {}
    for finding in findings(run, modes):
        topics.setdefault(finding.topic, []).append(finding.text)
    return fill("findings", topics=topics)


def notices(run: FinishedRun) -> Markup | None:
    """Return the notices on this run; None without notices."""
    texts = without_general(run.summary["notices"], run.car.vehicle)
    return fill("notices", texts=texts) if texts else None


def what_was_run(run: FinishedRun) -> Markup:
    """Return tables of car, signal and engine, and of parameters that differ from the shipped car."""
    excitation, solver, vehicle = run.summary["input"], run.summary["solver"], run.car.vehicle
    signal = [
        ("file", excitation["file"]),
        ("SHA-256", (excitation["sha256"] or "–")[:16]),
        ("length", f"{excitation['duration_s']:g} s"),
    ]
    signal += [
        (f"plate {side_of(wheel, vehicle.wheels)}", f"RMS {1e3 * rms:.4g} mm" if rms else "at rest")
        for wheel, rms in excitation["plate_rms_m"].items()
    ]
    if run.span:
        signal.append(("comfort, slip shares, densities of", run.span))
    signal += force_rows(run.summary)
    road = excitation.get("road") or {}
    signal += [(word, str(road[key])) for key, word in ROAD_WORDS.items() if road.get(key) is not None]
    engine = [
        ("engine", f"{solver['engine']} ({solver['engine_reason']})"),
        ("step", f"{1e3 * solver['timestep_s']:g} ms, {solver['steps']} steps"),
        ("computing time", f"{solver['wall_s']:.3g} s, {number(solver['realtime_factor'])} times real time"),
    ]
    if (residual := solver["energy_residual"]) is not None:
        engine.append(("energy error", f"{residual:.1e} of the input work"))
    car = [
        ("name", vehicle.name),
        ("file", _origin(run)),
        ("wheels on plates", ", ".join(side_of(wheel, vehicle.wheels) for wheel in vehicle.wheels)),
        ("tyres", vehicle.driving.words),
        ("trimmed body", f"{vehicle.body.mass:g} kg"),
    ]
    default = shipped_origin(vehicle)
    return fill(
        "run",
        tables={"Car": car, "Signal": signal, "Engine": engine},
        default=default and default.name,
        changed=[(path, unit, *values) for path, unit, values in changed_parameters([default, vehicle])]
        if default
        else [],
    )


def _origin(run: FinishedRun) -> str:
    """Return the vehicle file; no path for a shipped car, since it depends on the machine."""
    file = run.summary["vehicle"]["file"]
    if file is None or Path(file).resolve().parent.parent == VEHICLES.resolve():
        return "shipped with the program"
    return str(file)


def time_figure(run: FinishedRun, runs: Sequence[FinishedRun] = ()) -> Markup:
    """Return the plot of plate, seat rail and dampers over time, as in time.png.

    Args:
        runs: runs whose figures have equal scales, with this run among them; empty for a single run.
    """
    figure = drawing(lambda path: plot_time(path, run, page=True, others=runs), f"Time histories of {run.name}")
    return fill("time", title=run.name if runs else "", figure=figure)


def dampers(run: FinishedRun) -> Markup | None:
    """Return the table of slip, maximum velocity and maximum force of each damper; None without dampers."""
    summary = run.summary
    share, first = summary["slip_share"], summary["first_slip_s"]
    if not first:
        return None
    saturated, ended = summary["friction_saturated_share"], summary["first_friction_saturated_s"]
    rows = []
    for wheel in first:
        velocity, force = (
            np.abs(run.recording[f"damper_{wheel}_{quantity}"]).max() for quantity in ("velocity", "force")
        )
        rows.append(
            (
                side_of(wheel, list(first)),
                f"{100 * share[wheel]:.2f} %",
                _when(first[wheel]),
                f"{100 * saturated[wheel]:.2f} %",
                _when(ended[wheel]),
                f"{number(1e3 * velocity)} mm/s",
                f"{number(force)} N",
            )
        )
    return fill("dampers", slip=1e3 * share["slip_velocity"], limit=1e3 * summary["saturated_velocity"], rows=rows)


def _when(value: float | None) -> str:
    return "never" if value is None else f"{value:.3f} s"


def tables(run: FinishedRun) -> Markup:
    """Return folded tables of levels, resonances and static loads."""
    summary, recording = run.summary, run.recording
    levels = []
    for name, values in recording.channels.items():
        numbers = (float(np.sqrt(np.mean(values**2))), float(values.min()), float(values.max()))
        levels.append((name, recording.units[name], *(number(value, 4) for value in numbers)))
    peaks = [
        (
            channel + (f" to the {plate}" if plate else ""),
            ", ".join(f"{peak['frequency_hz']:.2f} ({number(peak['magnitude'])})" for peak in peaks),
        )
        for _, plate, resonances in run.peaks
        for channel, peaks in resonances.items()
        if peaks
    ]
    static = summary["static"]
    wheels = run.car.vehicle.wheels
    loads = [(f"tyre {side_of(wheel, wheels)}", f"{load:.0f}") for wheel, load in static["tyre_load_n"].items()]
    loads += [(f"rear support {name}", f"{load:.0f}") for name, load in static["rear_support_load_n"].items()]
    return fill("values", levels=levels, peaks=peaks, loads=loads)


def repeating(run: FinishedRun) -> Markup:
    """Return the command of the run, and a command that repeats the run from its folder."""
    again = ["python", "-m", "vehicle.shaker", "--vehicle", f"{run.place}/vehicle.toml", *_signal_again(run)]
    again += ["--engine", run.summary["solver"]["engine"]]
    files = ", ".join(run.summary["files"].values())
    return fill("repeat", command=run.summary.get("command"), again=shlex.join(again), files=files)


def _signal_again(run: FinishedRun) -> list[str]:
    """Return options for the same plate displacements; for a road the recorded displacements."""
    if run.summary["input"].get("road"):
        again = ["--input", f"{run.place}/{run.summary['files']['time']}", "--any-level"]
    else:
        again = ["--input", run.summary["input"]["file"]]
    return [*again, "--skip", f"{run.summary['evaluated_s'][0]:g}"] if run.span else again
