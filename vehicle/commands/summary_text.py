"""Printed text of the summary of a run."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

from vehicle.digits import number
from vehicle.names import side_of, slip_words
from vehicle.signals.records.law_band_summary import band_sentence

if TYPE_CHECKING:
    from vehicle.signals.records.run_summary import Peaks, RunSummary, SolverSummary


NAMED_SHARE = 1e-3
"""Share of the time with full friction from which it is named: 60 ms of a minute; below, a damper sticks."""


def _each(wheels: Collection[str], say: Callable[[str, str], str], last: str = ", ") -> str:
    """Return a list in words, with a text for each wheel from its name and its side."""
    texts = [say(wheel, side_of(wheel, wheels)) for wheel in wheels]
    return last.join(word for word in (", ".join(texts[:-1]), texts[-1]) if word)


def summary_text(summary: RunSummary) -> str:
    """Return the printed numbers and notes of a run from the content of its `summary.json`."""
    load = summary.static.tyre_load_n
    plates = summary.input.plate_rms_m
    moved = [f"{1e3 * rms:.4g} mm ({side_of(wheel, plates)})" for wheel, rms in plates.items() if rms > 0.0]
    begin, end = summary.evaluated_s
    span = f", evaluated from {begin:g} to {end:g} s" if begin > 0.0 else ""
    level = f"plate RMS {', '.join(moved)}" if moved else "plates at rest"
    lines = [
        f"input       {summary.input.file}, {summary.input.duration_s:g} s{span}, {level}; tyres {summary.tyre}",
        *_comfort(summary),
        *_obstacle(summary),
        *_forces(summary),
        *_dampers(summary),
        *([f"band        {text}"] if (text := band_sentence(summary)) else []),
    ]
    for wheel, plate, peaks in _peaks(summary) if summary.frf is not None else ():
        for channel in (f"knuckle_{wheel}_acc_z", "seat_rail_acc_z", "engine_acc_z"):
            if channel not in peaks:
                continue
            strongest = sorted(peaks[channel], key=lambda peak: -peak.magnitude)[:4]
            by_frequency = sorted(strongest, key=lambda peak: peak.frequency_hz)
            text = ", ".join(f"{peak.frequency_hz:.1f}" for peak in by_frequency)
            lines.append(f"resonances  {channel}{plate}: {text + ' Hz' if text else 'none found'}")
    lines += [
        f"static      tyre loads {_each(load, lambda w, side: f'{load[w]:.0f} N ({side})', ' and ')}",
        f"solver      {summary.solver.engine}, step {1e3 * summary.solver.timestep_s:g} ms, "
        f"{summary.solver.realtime_factor:.1f} times real time{_balance(summary.solver)}",
    ]
    lines += [f"warning     {text}" for text in summary.solver.warnings]
    lines += [f"note        {text}" for text in summary.notices]
    return "\n".join(lines)


def _dampers(summary: RunSummary) -> list[str]:
    """Return the lines of sticking, slipping and slowly sliding dampers; none without a damper."""
    share, first = summary.slip_share, summary.first_slip_s
    if not first:
        return []
    full = {wheel: summary.friction_saturated_share[wheel] for wheel in first}
    limit, fast = slip_words(summary.slip_limits, list(first)), 1e3 * summary.saturated_velocity
    started = {wheel: time for wheel, time in first.items() if time is not None}
    slow = max(full.values()) >= NAMED_SHARE
    every, ending = {1: ("the damper", "s"), 2: ("both dampers", "")}.get(len(first), ("all dampers", ""))
    if started:
        shares = _each(first, lambda w, side: f"{number(100 * share[w])} % ({side})", " and ")
        earliest = min(started, key=lambda wheel: started[wheel])
        lines = [
            f"damper      slip (|v| > {limit} mm/s) for {shares} of the time, first at {started[earliest]:.3g} s "
            f"({side_of(earliest, first)})"
        ]
    elif slow:
        lines = [f"damper      {every} slide{ending} slowly at times, never faster than {limit} mm/s"]
    else:
        lines = [f"damper      {every} stick{ending} all the time (|v| < {limit} mm/s)"]
    if slow:
        shares = _each(first, lambda w, side: f"{number(100 * full[w])} % ({side})", " and ")
        lines.append(f"            above {fast:g} mm/s, where friction reaches its full value, for {shares}")
    return lines


def _forces(summary: RunSummary) -> list[str]:
    """Return the lines of applied forces, and of the amplitudes at their frequencies."""
    from vehicle.runs.report.order_words import force_rows, order_sentences

    lines = [f"force       {name.removeprefix('force ')}: {text}" for name, text in force_rows(summary)]
    return lines + [f"order       {text}" for text in order_sentences(summary)]


def _comfort(summary: RunSummary) -> list[str]:
    """Return the lines of comfort at the seat rail and, for a car with seats, on the seat."""
    from vehicle.signals.records.run_summary import interval_words

    lines, points = [], summary.comfort
    if "seat_rail" in points:
        rms, (low, high) = points["seat_rail"].unweighted
        axes = ", ".join(f"{axis} {rms[axis]:.4f}" for axis in "xyz")
        half, values = points["seat_rail"].half_interval or {}, {"unweighted": rms["overall"]}
        values["weighted"] = points["seat_rail"].weighted
        plus = {name: f" ± {number(100.0 * half[name] / values[name], 2)} %" for name in values if half.get(name)}
        lines.append(
            f"comfort     seat rail {rms['overall']:.4f} m/s2{plus.get('unweighted', '')} unweighted RMS, {low:g} to "
            f"{high:g} Hz ({axes}); {values['weighted']:.4f} m/s2{plus.get('weighted', '')} weighted RMS (ISO 2631-1)"
            + (f"; {interval_words(summary, points['seat_rail'])}" if half else _event_words(summary))
        )
    over_class = points["seat_rail"].over_class if "seat_rail" in points else None
    if over_class:
        each = [
            f"{number(of['value'], 4)} m/s2 ± {number(100.0 * of['half_interval'] / of['value'], 2)} % {name}"
            for name, of in over_class.items()
        ]
        lines.append(
            f"            all roads of this class {', '.join(each)}: corrected by the linear car, which explains "
            f"{number(100.0 * min(of['explained'] for of in over_class.values()))} % of the scatter"
        )
    if (rim := summary.steering_wheel_rim) is not None:
        axes = ", ".join(f"{axis} {rim.weighted_rms[axis]:.4f}" for axis in "xyz")
        lines.append(
            f"            steering wheel rim {rim.weighted_rms['overall']:.4f} m/s2 weighted RMS "
            f"({rim.weighting}, {rim.standard}; {axes})"
        )
    if (ratio := summary.seat_value) is not None:
        lines.append(
            f"            seat {points['seat'].weighted:.4f} m/s2 weighted RMS (ISO 2631-1; x, y by Wd, z by Wk); "
            f"SEAT value {ratio.rms:.3f} (z, {ratio.weighting}; of doses {ratio.vdv:.3f})"
        )
    return lines


def _event_words(summary: RunSummary) -> str:
    """Return the time over which the RMS of an obstacle is taken; empty without an obstacle."""
    begin, end = summary.evaluated_s
    return "" if summary.obstacle is None else f"; over {end - begin:.3g} s: a longer --duration lowers both"


def _obstacle(summary: RunSummary) -> list[str]:
    """Return the lines of a run over an obstacle."""
    values = summary.obstacle
    if values is None:
        return []
    lines = [f"obstacle    {values.obstacle}, reached at {values.from_s:.2f} s, left at {values.to_s:.2f} s"]
    for point, size in values.peak_to_peak.items():
        dose, settled = values.vdv[point], values.settling_s[point]
        peaks = ", ".join(f"{axis} {size[axis]:.2f}" for axis in "xyz")
        lines.append(
            f"            {point.replace('_', ' ')} peak to peak {peaks} m/s2; "
            f"VDV {', '.join(f'{a} {dose[a]:.3f}' for a in 'xyz')}, sum {dose['overall']:.3f} m/s^1.75; z "
            + ("does not settle" if settled is None else f"settles in {settled:.2f} s")
        )
    knuckle = values.knuckle_peak
    if knuckle:
        lines.append(
            "            knuckle peak, z " + _each(knuckle, lambda w, side: f"{knuckle[w]:.1f} m/s2 ({side})", " and ")
        )
    return lines


def _balance(solver: SolverSummary) -> str:
    """Return the energy residual; empty for an engine without an energy balance."""
    return "" if solver.energy_residual is None else f", energy residual {solver.energy_residual:.1e}"


def _peaks(summary: RunSummary) -> list[tuple[str, str, Peaks]]:
    """Return the resonances to each input: its first wheel, "/plate_fr" if there are several inputs, the resonances."""
    inputs = summary.frf.to if summary.frf is not None else []
    if len(inputs) < 2:
        return [(summary.input.wheel, "", summary.peaks)]
    return [(next(iter(each.plates)), f"/{each.input}", each.peaks or {}) for each in inputs]
