"""Sections of a report: tables and figures of one run."""

import base64
import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from markupsafe import Markup

from vehicle.digits import number
from vehicle.drawing.rendering.figure import PAGE_WIDTH
from vehicle.drawing.rendering.frf_plot import plot_frfs
from vehicle.drawing.rendering.plots import plot_time
from vehicle.engines.linear.car_modes import Mode
from vehicle.mapped_table import release
from vehicle.model.parameters.shipped import VEHICLES
from vehicle.names import CORNERS, channel_words, point_words, side_of, slip_words
from vehicle.runs.report.comfort_class import REACTIONS, reactions
from vehicle.runs.report.differences import changed_parameters, parameter_rows, shipped_origin
from vehicle.runs.report.findings import findings, main_points, nearest_mode
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.general_notices import without_general
from vehicle.runs.report.markup import named, templates
from vehicle.runs.report.order_words import force_rows
from vehicle.runs.report.svg_figure import drawing
from vehicle.signals.records.law_band_summary import band_rows, band_sentence
from vehicle.signals.records.run_summary import interval_words

fill = templates(__file__)

ROAD_WORDS = {
    "class": "class of ISO 8608",
    "profile": "profile",
    "speed_kmh": "speed [km/h]",
    "seed": "seed",
    "words": "road",
}

FRF_SIZE = (PAGE_WIDTH, 5.2)
"""Width and height of the figure of FRFs [inch]."""

STRONGEST = 6
"""Maximum number of resonances of an output point in a table."""

UNITS = {
    "low_hz": "from [Hz]",
    "high_hz": "to [Hz]",
    "magnitude_db": "magnitude, mean [dB]",
    "magnitude_rms_db": "magnitude, RMS [dB]",
    "phase_deg": "phase, RMS [deg]",
    "iso18571": "ISO 18571",
    "lag_s": "lag [s]",
    "drift_ppm": "drift [ppm]",
    "window_s": "window of ISO 18571 [s]",
}
"""Heads of columns with units."""

NO_FIGURE = Markup()


def tiles(run: FinishedRun) -> Markup:
    """Return the key figures of a run as tiles."""
    summary = run.summary
    shares, limits = summary.slip_shares, summary.slip_limits
    values = []
    for point, value in list(run.comfort.items())[:1]:
        total = value.weighted
        label = f"weighted acceleration at the {point.replace('_', ' ')}, {' to '.join(reactions(total))}"
        values.append((f"{number(total)} m/s²", label))
    for wheel, share in shares.items():
        slipping = "in slip" if run.friction else f"faster than {1e3 * limits[wheel]:g} mm/s"
        values.append((f"{number(100 * share, 2)} %", f"of the time {slipping}, {side_of(wheel, shares)} damper"))
    for wheel, plate, resonances in run.peaks[:1]:
        if peaks := resonances.get(f"knuckle_{wheel}_acc_z"):
            top = max(peaks, key=lambda peak: peak.magnitude)
            to_plate = f", FRF from the {plate}" if plate else ""
            label = f"highest resonance of the vertical motion of the knuckle{to_plate}"
            values.append((f"{top.frequency_hz:.1f} Hz", label))
    if summary.input.rms_m:
        plate = side_of(run.wheel, run.car.vehicle.wheels)
        values.append((f"{1e3 * summary.input.rms_m:.3g} mm", f"RMS displacement of the {plate} plate"))
    return fill("tiles", values=values)


def what_was_found(run: FinishedRun, modes: Mapping[str, Sequence[Mode]]) -> Markup:
    """Return findings by topic."""
    topics: dict[str, list[str]] = {}
    for finding in findings(run, modes):
        topics.setdefault(finding.topic, []).append(finding.text)
    return fill("findings", topics=topics)


def notices(run: FinishedRun) -> Markup | None:
    """Return the notices on this run; None without notices."""
    texts = without_general(run.summary.notices, run.car.vehicle)
    return fill("notices", texts=texts) if texts else None


def what_was_run(run: FinishedRun) -> Markup:
    """Return tables of car, signal and engine, and of parameters that differ from the shipped car."""
    excitation, solver, vehicle = run.summary.input, run.summary.solver, run.car.vehicle
    signal = [
        ("file", excitation.file),
        ("SHA-256", (excitation.sha256 or "–")[:16]),
        ("length", f"{excitation.duration_s:g} s"),
    ]
    signal += [
        (f"plate {side_of(wheel, vehicle.wheels)}", f"RMS {1e3 * rms:.4g} mm" if rms else "at rest")
        for wheel, rms in excitation.plate_rms_m.items()
    ]
    if run.span:
        signal.append(("comfort, slip shares, densities of", run.span))
    signal += force_rows(run.summary)
    road = excitation.road or {}
    signal += [(word, str(road[key])) for key, word in ROAD_WORDS.items() if road.get(key) is not None]
    engine = [
        ("engine", f"{solver.engine} ({solver.engine_reason})"),
        ("step", f"{1e3 * solver.timestep_s:g} ms, {solver.steps} steps"),
        ("computing time", f"{solver.wall_s:.3g} s, {number(solver.realtime_factor)} times real time"),
    ]
    if (residual := solver.energy_residual) is not None:
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
        changed=parameter_rows(changed_parameters([default, vehicle])) if default else [],
    )


def _origin(run: FinishedRun) -> str:
    """Return the vehicle file; no path for a shipped car, since it depends on the machine."""
    file = run.summary.vehicle.file
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
    """Return tables of slip, largest velocity and force of each damper, and of their band; None without dampers."""
    summary = run.summary
    share, first = summary.slip_share, summary.first_slip_s
    if not first:
        return None
    saturated, ended = summary.friction_saturated_share, summary.first_friction_saturated_s
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
    slip, limit = slip_words(summary.slip_limits, list(first)), 1e3 * summary.saturated_velocity
    text = band_sentence(summary)
    band = {"rows": band_rows(summary), "caption": text[:1].upper() + text[1:]}
    return fill("dampers", friction=run.friction, rows=rows, slip=slip, limit=limit, band=band)


def _when(value: float | None) -> str:
    return "never" if value is None else f"{value:.3f} s"


def responses(run: FinishedRun, modes: Mapping[str, Sequence[Mode]]) -> Markup:
    """Return FRFs and tables of resonances of a run with FRFs."""
    figure = drawing(
        lambda path: plot_frfs(path, run, run.responses, run.caption, FRF_SIZE), f"Frequency responses of {run.name}"
    )
    return fill("responses", figure=figure, tables=_resonances(run, modes))


def _resonances(
    run: FinishedRun, modes: Mapping[str, Sequence[Mode]]
) -> list[tuple[str, list[tuple[str, str, str, str]]]]:
    """Return captions and rows of the highest resonances of the main output points with the nearest modes."""
    tables = []
    main = [
        (f" from motion of the {plate}" if plate else "", point, resonances.get(channel, ()))
        for wheel, plate, resonances in run.peaks
        for channel, point in main_points(run, wheel).items()
    ]
    for plate, point, all_peaks in main:
        peaks = sorted(all_peaks, key=lambda peak: -peak.magnitude)[:STRONGEST]
        rows = []
        for peak in sorted(peaks, key=lambda peak: peak.frequency_hz):
            state, mode = nearest_mode(run, peak.frequency_hz, modes)
            near = "" if mode is None else f"{mode.frequency:.2f} Hz, {mode.description}"
            rows.append((near, f"{peak.frequency_hz:.2f}", number(peak.magnitude), number(peak.coherence)))
        if rows:
            count = f"the {len(rows)} highest" if len(rows) > 1 else "one found"
            caption = f"Vertical resonances at the {point}{plate}: {count}; modes with {state}"
            tables.append((caption, rows))
    return tables


def comfort(run: FinishedRun, bands: Markup = NO_FIGURE) -> Markup:
    """Return tables of weighted and unweighted accelerations, and of reactions with the values of this run.

    Args:
        bands: figure of the frequencies, left of the reactions; may be empty.
    """
    points, totals = [], {}
    for point, value in run.comfort.items():
        iso, (raw, (low, high)) = value.iso2631, value.unweighted
        totals[point_words(point)] = iso.overall
        rows = [
            (
                axis,
                values.weighting,
                *map(number, (values.weighted_rms, values.mtvv, values.crest_factor, values.vdv, values.msdv)),
                number(raw[axis]),
            )
            for axis, values in iso.axes.items()
        ]
        half = {name: f" ± {number(width, 2)}" for name, width in (value.half_interval or {}).items()}
        weighted = number(iso.overall) + half.get("weighted", "")
        unweighted = number(raw["overall"]) + half.get("unweighted", "")
        rows.append(
            (
                "all",
                "",
                weighted,
                "",
                "",
                number(None if iso.vector_sum is None else iso.vector_sum.vdv),
                "",
                unweighted,
            )
        )
        reasons = [*iso.reasons, *([interval_words(run.summary, value)] if half else [])]
        span = f", {run.span} of the run" if run.span else ""
        caption = f"{point_words(point).capitalize()}, {iso.standard}{span}"
        points.append((caption, low, high, rows, reasons))
    matches = [
        (_range(low, high), word, [point for point, total in totals.items() if word in reactions(total)])
        for word, low, high in REACTIONS
    ]
    return fill("comfort", bands=bands, points=points, reactions=matches, seat=run.summary.seat_value)


def _range(low: float, high: float) -> str:
    if low == 0.0:
        return f"below {high:g} m/s²"
    return f"above {low:g} m/s²" if high == float("inf") else f"{low:g} to {high:g} m/s²"


def measured(run: FinishedRun) -> Markup | None:
    """Return the table of differences, largest first, and the pictures; None without a measurement."""
    comparison = run.summary.measured
    if not comparison:
        return None
    heads = list(dict.fromkeys(key for row in comparison.table for key in row))
    rows = [
        [_channel_title(str(row[key])) if key == "channel" else _cell(row.get(key)) for key in heads]
        for row in comparison.table
    ]
    titles = [UNITS.get(head, head.replace("_", " ")) for head in heads]
    pictures = [
        (base64.b64encode(path.read_bytes()).decode("ascii"), purpose.replace("_", " "))
        for purpose, name in run.summary.files.items()
        if purpose.startswith("compare_") and (path := run.folder / name).suffix == ".png" and path.is_file()
    ]
    return fill("measured", file=comparison.file, heads=titles, rows=rows, pictures=pictures)


def _channel_title(name: str, plate: str = "") -> Markup:
    """Return a channel in words, "front right damper velocity", with its name."""
    parts = channel_words(name).split("_")
    corner = next((corner for corner, wheel in CORNERS.items() if wheel in parts), "")
    text = " ".join([corner, *(part for part in parts if part != CORNERS.get(corner)), plate])
    return named(name, text.replace("_", " ").strip())


def _cell(value: object) -> str:
    if isinstance(value, list | tuple):
        return " to ".join(_cell(item) for item in value)
    return number(value) if isinstance(value, float) or value is None else str(value)


def tables(run: FinishedRun) -> Markup:
    """Return folded tables of levels, resonances and static loads."""
    summary, recording = run.summary, run.recording
    levels = []
    for name, values in recording.channels.items():
        numbers = (float(np.sqrt(np.mean(values**2))), float(values.min()), float(values.max()))
        levels.append((_channel_title(name), recording.units[name], *(number(value, 4) for value in numbers)))
        release(values)
    peaks = [
        (
            _channel_title(channel, f"to the {plate}" if plate else ""),
            ", ".join(f"{peak.frequency_hz:.2f} ({number(peak.magnitude)})" for peak in peaks),
        )
        for _, plate, resonances in run.peaks
        for channel, peaks in resonances.items()
        if peaks
    ]
    static = summary.static
    wheels = run.car.vehicle.wheels
    loads = [(f"tyre {side_of(wheel, wheels)}", f"{load:.0f}") for wheel, load in static.tyre_load_n.items()]
    loads += [(f"rear support {name}", f"{load:.0f}") for name, load in static.rear_support_load_n.items()]
    return fill("values", levels=levels, peaks=peaks, loads=loads)


def repeating(run: FinishedRun) -> Markup:
    """Return the command of the run, and a command that repeats the run from its folder."""
    again = ["python", "-m", "vehicle.shaker", "--vehicle", f"{run.place}/vehicle.toml", *_signal_again(run)]
    again += ["--engine", run.summary.solver.engine]
    files = ", ".join(run.summary.files.values())
    return fill("repeat", command=run.summary.command, again=shlex.join(again), files=files)


def _signal_again(run: FinishedRun) -> list[str]:
    """Return options for the same plate displacements; for a road the recorded displacements."""
    if run.summary.input.road:
        again = ["--input", f"{run.place}/{run.summary.files['time']}", "--any-level"]
    else:
        again = ["--input", run.summary.input.file]
    return [*again, "--skip", f"{run.summary.evaluated_s[0]:g}"] if run.span else again
