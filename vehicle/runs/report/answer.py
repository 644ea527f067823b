"""First screen of a report: comfort of a run as a statement, or effect of a change with a picture."""

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
from markupsafe import Markup

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.drawing.rendering.answer_plot import Change, plot_bands, plot_changes
from vehicle.engines.linear.car_modes import Mode
from vehicle.engines.linear.motion_names import leading_motions
from vehicle.names import AXES, point_words, side_of, slip_words
from vehicle.runs.report.band_causes import main_path, paths, strongest
from vehicle.runs.report.base_run import OF_THE_RUN
from vehicle.runs.report.comfort_class import reactions
from vehicle.runs.report.differences import MISSING, changed_parameters, difference, parameter_words
from vehicle.runs.report.findings import damper_state
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.main_band import MainBand, main_band, weighted_bands
from vehicle.runs.report.markup import templates
from vehicle.runs.report.run_input import change_half_width, input_text, references
from vehicle.runs.report.svg_figure import drawing
from vehicle.signals.analysis.modal_assurance import mac

fill = templates(__file__)

Modes = Mapping[str, Sequence[Mode]]
Changed = tuple[str, str, list[str]]
"""Path, unit and values of a parameter in which cars differ."""

MOST_CHANGES = 2
"""Maximum number of listed parameters; more are counted."""

SMALL = 0.05
"""Change [%] below which comfort counts as unchanged."""

NOTICED = 11.0
"""Change [%] up to which many persons do not notice a vibration: the largest median of `threshold.html`."""

SLIP = 0.1
"""Change of the time in slip [percentage points] from which it is named."""

DIRECTIONS = {"x": "fore-aft", "y": "lateral", "z": "vertical"}

BY_MODE = "caused mainly by the mode"
"""Words before the mode that a statement names."""


def answer(runs: Sequence[FinishedRun], modes: Sequence[Modes]) -> Markup:
    """Return the statement on a single run, or statements and a picture of each further run against the first.

    Each run is compared with the first run on its input (`references`).

    Args:
        modes: modes of the car of each run, for dampers "stuck" and "sliding".
    """
    if len(runs) == 1:
        return _of_one(runs[0], modes[0])
    statements, figure, changes = [], Markup(), {}
    compared = references(runs)
    for number_of_run, (run, run_modes, reference) in enumerate(zip(runs, modes, compared, strict=True)):
        if reference is None:
            if number_of_run not in compared:
                value = f" ({number(_weighted(run))} m/s² weighted at the seat rail)" if _weighted(run) else ""
                statements.append(f"{run.name}{value} is not compared: no other run here is on {input_text(run)}.")
            continue
        before = runs[reference]
        texts = [_effect(before, run)]
        if abs(_percent(before, run) or 0.0) >= SMALL:
            texts.append(_reason(before, run, modes[reference], run_modes))
        statements.append(" ".join(texts))
        changes[f"{run.name} against {before.name}"] = _changes(before, run)
    if changes and all(changes.values()):
        title = "Change of comfort and loads"
        caption = "blue: smaller vibration or load, amber: larger; grey: no rating"
        figure = drawing(partial(plot_changes, changes=changes, title=title, caption=caption), title)
    pairs = [(runs[first], run) for run, first in zip(runs, compared, strict=True) if first is not None]
    changed = [abs(_percent(*pair) or 0.0) for pair in pairs if input_text(pair[0]) == input_text(pair[1])]
    if any(SMALL <= percent <= NOTICED for percent in changed):
        figure = fill("threshold") + figure
    return fill("answer", texts=statements, figure=figure)


def explained(statements: Markup) -> Markup:
    """Return statements with the explanation of mode and path, if they name a mode."""
    return statements + fill("explained") if BY_MODE in statements else statements


def _of_one(run: FinishedRun, modes: Modes) -> Markup:
    spectra = weighted_bands(run)
    comfort = run.summary.comfort.get("seat_rail")
    if comfort is None or not spectra:
        return fill("no_comfort")
    total = comfort.weighted
    texts = [
        f"{number(total)} m/s² weighted acceleration at the seat rail of the {run.car.vehicle.name} on "
        f"{input_text(run)}: {' to '.join(reactions(total))} (ISO 2631-1; lower is better)."
    ]
    band = main_band(spectra)
    if band is not None:
        mode = strongest(run, band, modes.get(damper_state(run), ()))
        parts = [f"{100.0 * band.share:.0f} % of its mean square {_is_within(band)}"]
        if mode is not None:
            # The linear model has the smallest slope of sliding dampers, and no friction.
            named = mode_words(mode, "at least " if damper_state(run) == "sliding" else "")
            parts += [f"{BY_MODE} of {named}", *_path_words(run, band, mode)]
        texts.append(f"{', '.join(parts)}{_damper_words(run)}.")
    return fill("answer", texts=[" ".join(texts)], figure="")


def comfort_bands(run: FinishedRun, modes: Modes, width: float) -> Markup:
    """Return the figure of the shares of one-third octaves in the weighted acceleration; empty without comfort.

    Args:
        modes: modes of its car for dampers "stuck" and "sliding"; the strongest one in the main band is marked.
        width: width of the figure [inch].
    """
    spectra = weighted_bands(run)
    if not spectra:
        return Markup()
    band = main_band(spectra)
    mode = band and strongest(run, band, modes.get(damper_state(run), ()))
    marked = {f"{mode.frequency:.1f} Hz\n{_motion(mode)}": mode.frequency} if mode else {}
    bands = next(iter(spectra.values())).third_octaves
    powers = {axis: np.nan_to_num(spectrum.third_octaves.rms) ** 2 for axis, spectrum in spectra.items()}
    return drawing(
        partial(plot_bands, edges=bands.edges, powers=powers, modes=marked, caption=run.caption, width=width),
        f"Frequencies of the weighted acceleration of {run.name}",
    )


def _is_within(band: MainBand) -> str:
    """Return direction and frequencies of a band as text."""
    return f"is {DIRECTIONS[band.axis]} between {number(band.low, 2)} and {number(band.high, 2)} Hz"


def _damper_words(run: FinishedRun) -> str:
    """Return the text on the slip of the dampers; empty without dampers."""
    shares = run.summary.slip_shares
    if not shares:
        return ""
    low, high = (100.0 * limit(shares.values()) for limit in (min, max))
    ends = " to ".join(dict.fromkeys(number(share, 2) for share in (low, high)))
    if not run.friction:
        limit = slip_words(run.summary.slip_limits, shares)
        return f"; the dampers are faster than {limit} mm/s for {ends} % of the time"
    if high < 1.0 <= 100.0 * max(run.summary.friction_saturated_share.values()):
        return "; the dampers slide slowly at times"
    if high < 1.0:
        return "; the dampers stick, so they dissipate almost no energy"
    return f"; the dampers slip for {ends} % of the time"


def _path_words(run: FinishedRun, band: MainBand, mode: Mode) -> list[str]:
    """Return the main path of a mode into the body as text; empty if no path carries most of it."""
    path = main_path(paths(run, band.axis, mode))
    return [f"carried into the body by {path}"] if path else []


def mode_words(mode: Mode, bound: str = "") -> str:
    """Return a mode in words: frequency, largest motion, damping ratio, with a word before it as "at least "."""
    return f"{mode.frequency:.1f} Hz ({_motion(mode)}, damping ratio {bound}{number(100.0 * mode.damping_ratio, 2)} %)"


def _motion(mode: Mode) -> str:
    """Return the motions that name a mode, without their axes in brackets."""
    return " with ".join(name.partition(" (")[0] for name in leading_motions(mode.motions))


def _effect(first: FinishedRun, run: FinishedRun) -> str:
    """Return a statement on the change of comfort; empty without a seat rail."""
    percent = _percent(first, run)
    if percent is None:
        return ""
    before, after = (_weighted(each) for each in (first, run))
    if abs(percent) < SMALL:
        effect = f"stays at {number(before)} m/s²"
    else:
        word, rating = ("rises", ", worse") if percent > 0.0 else ("falls", ", better")
        if input_text(first) != input_text(run):
            rating = ""  # of the inputs, not of the cars
        change, width = difference(before, after), change_half_width(first, run)
        if width is not None:
            change = f"{change.removesuffix(' %')} ± {number(width, 2)} %"
            rating = rating if abs(percent) > width else ", not more than its error: take a longer road"
        effect = f"{word} from {number(before)} to {number(after)} m/s² ({change}{rating})"
    return f"{what_changed(first, run)}: the weighted acceleration at the seat rail (ISO 2631-1) {effect}."


def _weighted(run: FinishedRun) -> float | None:
    """Return the weighted acceleration at the seat rail [m/s2]; None if it is not recorded."""
    value = run.summary.comfort.get("seat_rail")
    return None if value is None else value.weighted


def _percent(first: FinishedRun, run: FinishedRun) -> float | None:
    """Return the change of the weighted acceleration at the seat rail [%]; None without a value."""
    before, after = (_weighted(each) for each in (first, run))
    return None if before is None or after is None or before == 0.0 else 100.0 * (after / before - 1.0)


def what_changed(first: FinishedRun, run: FinishedRun) -> str:
    """Return what differs between two runs: car, parameters, input, engine."""
    parts = []
    vehicles, inputs = [first.car.vehicle, run.car.vehicle], [input_text(each) for each in (first, run)]
    changed = _without_followers(
        first, run, [row for row in changed_parameters(vehicles) if not row[0].startswith(OF_THE_RUN)]
    )
    if inputs[0] != inputs[1]:
        # Set by the road, as tyres that lift off an obstacle.
        changed = [row for row in changed if not row[0].endswith(".one_sided")]
    if len(changed) > MOST_CHANGES and vehicles[0].name != vehicles[1].name:
        parts.append(f"car {vehicles[1].name} instead of {vehicles[0].name}")
    elif len(changed) > MOST_CHANGES:
        parts.append(f"{len(changed)} other parameters, among them {parameter_words(changed[0][0])}")
    else:
        parts += [_change_words(path, unit, old, new) for path, unit, (old, new) in changed]
    if inputs[0] != inputs[1]:
        parts.append(f"{inputs[1]} instead of {inputs[0]}")
    engines = [each.summary.solver.engine for each in (first, run)]
    if engines[0] != engines[1]:
        parts.append(f"engine {engines[1]} instead of {engines[0]}")
    text = ", ".join(parts) or "equal car, input and engine"
    return f"{run.name} against {first.name} ({text})"


def _without_followers(first: FinishedRun, run: FinishedRun, changed: Sequence[Changed]) -> list[Changed]:
    """Return the changed parameters set in either run; all if they set none, or have other vehicle files.

    Others follow them, as the inertia of the body follows its mass.
    """
    origins = [each.summary.vehicle for each in (first, run)]
    old, new = (origin.overrides for origin in origins)
    texts = [text for text in [*new, *old] if text not in new or text not in old]
    paths = list(dict.fromkeys(text.partition("=")[0].strip() for text in texts))
    # A component of a vector, as stiffness.z, is a part of the parameter.
    paths = [path[:-2] if path[-2:] in (".x", ".y", ".z") else path for path in paths]
    rows_of = [[row for row in changed if f".{row[0]}".endswith(f".{path}")] for path in paths]
    if not rows_of or not all(rows_of) or origins[0].file != origins[1].file:
        return list(changed)
    return [row for row in changed if any(row in rows for rows in rows_of)]


def _change_words(path: str, unit: str, old: str, new: str) -> str:
    """Return a changed parameter in words: of a vector only the components that differ."""
    unit = unit.strip("-")
    values = [text[1:-1].split(", ") if text.startswith("[") else [text] for text in (old, new)]
    if len(values[0]) != len(values[1]) or len(values[1]) != len(AXES):
        return f"{parameter_words(path)} {new}{f' instead of {old}' if old != MISSING else ''} {unit}".rstrip()
    return ", ".join(
        f"{parameter_words(path)} {axis} {after} instead of {before} {unit}".rstrip()
        for axis, before, after in zip(AXES, *values, strict=True)
        if before != after
    )


def _reason(first: FinishedRun, run: FinishedRun, modes: Modes, run_modes: Modes) -> str:
    """Return a statement on band, mode, path and dampers of the change; empty without a change."""
    spectra = [weighted_bands(each) for each in (first, run)]
    if not all(spectra):
        return ""
    band = main_band(spectra[1], spectra[0])
    if band is None:
        return ""
    share = f"{100.0 * band.share:.0f} %" if band.share <= 1.0 else "More than all"
    parts = [f"{share} of the change of the mean square {_is_within(band)}"]
    mode = strongest(first, band, modes.get(damper_state(first), ()))
    if mode is not None:
        states = [damper_state(each) for each in (first, run)]
        other = counterpart(mode, run_modes.get(states[1], ()), first.car.matrices.system.mass)
        moved = (
            _moved(mode, other)
            if states[0] == states[1]
            else f"of {mode_words(mode)} with {states[0]} dampers, which are {states[1]} now"
        )
        parts += [f"{BY_MODE} {moved}", *_path_words(first, band, mode)]
    slips = [each.summary.slip_shares for each in (first, run)]
    limits = [first.summary.slip_limits, run.summary.slip_limits]
    alike = [wheel for wheel, limit in limits[0].items() if limits[1].get(wheel) == limit]
    if list(slips[0]) == list(slips[1]) and alike:
        wheel = max(alike, key=lambda name: abs(slips[1][name] - slips[0][name]))
        before, after = (100.0 * slip[wheel] for slip in slips)
        if abs(after - before) >= SLIP and number(after, 2) != number(before, 2):
            faster = f"is faster than {1e3 * limits[0][wheel]:g} mm/s"
            slipping = "slips" if first.friction and run.friction else faster
            return (
                f"{', '.join(parts)}; the {side_of(wheel, slips[0])} damper {slipping} for {number(after, 2)} % of the "
                f"time instead of {number(before, 2)} %."
            )
    return f"{', '.join(parts)}."


def _moved(mode: Mode, other: Mode | None) -> str:
    """Return a mode in words, with what changed in the mode of the other car: frequency, damping ratio."""
    if other is None or mode_words(other) == mode_words(mode):
        return f"of {mode_words(mode)}"
    frequencies = [f"{each.frequency:.3g}" for each in (mode, other)]
    ratios = [number(100.0 * each.damping_ratio, 2) for each in (mode, other)]
    parts = [f"which moves from {frequencies[0]} to {frequencies[1]} Hz"] if frequencies[0] != frequencies[1] else []
    parts += [f"whose damping ratio changes from {ratios[0]} to {ratios[1]} %"] if ratios[0] != ratios[1] else []
    return f"of {_motion(mode)}, {' and '.join(parts)}" if parts else f"of {mode_words(mode)}"


def counterpart(mode: Mode, modes: Sequence[Mode], mass: Vector) -> Mode | None:
    """Return the mode of another car with the most similar shape (MAC with the mass matrix above 0.5), or None.

    The coordinates are displacements [m], angles [rad] and modal coordinates; without the mass matrix the angles of
    rolling wheels, of 1/r rad for a travel of 1 m, decide which modes are similar.

    Args:
        mode: mode of the first car.
        modes: modes of the other car.
        mass: mass matrix of the first car at the coordinates of its modes; (n, n).
    """
    same = [other for other in modes if other.shape.shape == mode.shape.shape]
    if not same:
        return None
    criteria = mac([mode.shape], [other.shape for other in same], mass)[0]
    return same[int(np.argmax(criteria))] if criteria.max() > 0.5 else None


def _changes(first: FinishedRun, run: FinishedRun) -> list[Change]:
    """Return the changes of comfort and loads, in the order of the report."""
    before, after = _numbers(first), _numbers(run)
    equal_input = input_text(first) == input_text(run)  # otherwise the change is not that of a car
    changes = []
    for label, (old, unit, rated) in before.items():
        if label in after and old > 0.0:
            new = after[label][0]
            values = f"{number(old)} → {number(new)} {unit}".rstrip()
            changes.append(Change(f"{label}, {values}", 100.0 * (new / old - 1.0), rated and equal_input))
    return changes


def _numbers(run: FinishedRun) -> dict[str, tuple[float, str, bool]]:
    """Return label to value, unit, and whether a smaller value is better."""
    numbers: dict[str, tuple[float, str, bool]] = {}
    for point, value in run.comfort.items():
        iso, label = value.iso2631, point_words(point)
        numbers[f"{label}, weighted"] = iso.overall, "m/s²", True
        numbers |= {f"{label}, weighted, {axis}": (each.weighted_rms, "m/s²", True) for axis, each in iso.axes.items()}
        if iso.vector_sum is not None and iso.vector_sum.vdv is not None:
            numbers[f"{label}, VDV"] = iso.vector_sum.vdv, "m/s¹·⁷⁵", True
        if value.rms_2_50_hz["overall"] is not None:
            numbers[f"{label}, unweighted, 2 to 50 Hz"] = value.rms_2_50_hz["overall"], "m/s²", True
    seat = run.summary.seat_value
    if seat is not None:
        numbers["SEAT value"] = seat.rms, "", True
    wheels = run.car.vehicle.wheels
    for wheel in wheels:
        force = run.recording.channels.get(f"tyre_{wheel}_force_z")
        if force is not None:
            variation = float(np.std(force[run.evaluated]))
            numbers[f"tyre load {side_of(wheel, wheels)}, RMS of its variation"] = variation, "N", True
    for wheel in run.summary.slip_shares:
        force = run.recording.channels.get(f"damper_{wheel}_force")
        if force is not None:
            numbers[f"damper force {side_of(wheel, wheels)}, largest"] = (
                float(np.abs(force[run.evaluated]).max()),
                "N",
                True,
            )
    return numbers
