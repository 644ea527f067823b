"""Applied forces of a run, and what they do at their frequencies, in words."""

from vehicle.digits import number
from vehicle.names import AXES, channel_words, point_words
from vehicle.signals.records.run_summary import OrderSummary, RunSummary, RunUpSummary

POINTS = ("seat_rail", "seat")
"""Points of the statements, the first of them that is recorded: that of the comfort."""


def force_rows(summary: RunSummary) -> list[tuple[str, str]]:
    """Return name and harmonics of each applied force, for a table."""
    rows = []
    for name, force in (summary.forces or {}).items():
        unit = force.unit
        at = "at the highest speed," if force.angle == "crank" and summary.run_up is not None else "at"
        parts = [f"{number(line.amplitude)} {unit} {at} {number(line.frequency_hz)} Hz" for line in force.lines]
        parts += ["recorded history"] if force.recorded else []
        parts += [f"mean {number(force.mean)} {unit}"] if force.mean else []
        rows.append((f"force {name} on {force.on}", ", ".join(parts)))
    return rows


def order_sentences(summary: RunSummary) -> list[str]:
    """Return text on each frequency of the applied forces: amplitudes at seat or seat rail."""
    sentences = [*filter(None, (_run_up_sentence(line) for line in summary.run_up or ()))]
    for line in summary.orders or ():
        point = next((name for name in POINTS if f"{name}_acc_z" in line.amplitude), None)
        if point is not None:
            axis = _axes(line, point)[0]
            name, frictions = f"{point}_acc_{axis}", line.frictions
            if line.amplitude[name] <= line.floor:
                continue
            stuck, free = (number(limit[name]) for limit in (line.stuck, line.without_friction))
            sentences.append(
                f"Forces at {line_words(line)} shake the {point_words(point)} by {amplitude_words(line, point)} "
                f"(amplitudes). Along {axis} {frictions} that stick would give {stuck} m/s², {frictions} without "
                f"friction {free} m/s².{_chance(line, name)}"
            )
    return sentences


def _run_up_sentence(line: RunUpSummary) -> str:
    """Return text on the peak of an order in a run-up, at seat or seat rail along z if it is recorded.

    It is empty for a peak below the accuracy of the engine.
    """
    names = [name for point in POINTS if (name := f"{point}_acc_z") in line.peak] or [*line.peak]
    if line.peak[names[0]] <= line.floor:
        return ""
    rpm = line.rpm[names[0]]
    frequency = number(line.order * rpm / 60.0)
    return (
        f"Order {line.order:g} of the crankshaft is largest at {number(rpm)}/min ({frequency} Hz): "
        f"{channel_words(names[0])} {number(line.peak[names[0]])} m/s² (amplitude, over 8 turns)."
    )


def _chance(line: OrderSummary, name: str) -> str:
    """Return text with the ranges of a channel over the phases of the wheels; empty for a single wheel."""
    if line.stuck_range is None or line.without_friction_range is None:
        return ""
    stuck, free = (
        f"{number(low)} to {number(high)} m/s²"
        for low, high in (line.stuck_range[name], line.without_friction_range[name])
    )
    return f" These values depend on the phase between the wheels: over all phases {stuck} and {free}."


def line_words(line: OrderSummary) -> str:
    """Return frequency and order of a line, as "15.9 Hz (order 1 of the wheels)"."""
    of = {"wheels": "the wheels", "crank": "the crankshaft"}.get(line.of)
    return f"{number(line.frequency_hz)} Hz" + (f" (order {line.order:g} of {of})" if of else "")


def amplitude_words(line: OrderSummary, point: str) -> str:
    """Return the amplitudes of a point by axis, the largest first, with errors above a hundredth.

    An axis below the accuracy of the engine is left out.
    """
    texts = []
    for axis in _axes(line, point):
        size, error = (each.get(f"{point}_acc_{axis}", 0.0) for each in (line.amplitude, line.standard_error))
        doubt = f" ± {number(error, 2)}" if error > 0.01 * size else ""
        if size > line.floor:
            texts.append(f"{number(size)}{doubt} m/s² along {axis}")
    return ", ".join(texts)


def _axes(line: OrderSummary, point: str) -> list[str]:
    """Return the axes of a point, that with the largest amplitude first."""
    return sorted(AXES, key=lambda axis: -line.amplitude.get(f"{point}_acc_{axis}", 0.0))
