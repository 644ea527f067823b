"""Find exchanged channels: which simulated channel each measured channel moves like.

Of n measured and n simulated channels of one unit, r_ij is the largest |correlation coefficient| over all lags of
measured channel i and simulated channel j, so that neither sign nor delay of a sensor matters. The assignment of
measured to simulated channels with the largest sum of r (Hungarian method) shows exchanged channels; those of one cycle
are exchanged if each fits its new counterpart clearly better than the mapped one.
"""

import shlex
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.names import is_wheel
from vehicle.signals.analysis.fast_length import fast_length
from vehicle.signals.analysis.response_name import parsed_name
from vehicle.signals.analysis.samples import Complex
from vehicle.signals.formats.table import Record
from vehicle.signals.records.channel_words import map_words
from vehicle.signals.records.counterpart import SAME_MOTION
from vehicle.signals.records.finding import Finding
from vehicle.signals.records.resampled import at_times

BETTER = 0.1
"""Minimum difference of the correlations with the new and the own counterpart [-]."""

REMAINING = 0.5
"""Maximum ratio of 1 - r of the new to that of the own counterpart [-]: a wrong car changes both alike."""

MOST_SAMPLES = 2**17
"""Maximum number of samples that are compared: two minutes at 1 kHz."""


def exchanged_histories(measured: Record, simulated: Record, times: Vector) -> dict[str, str]:
    """Return measured channel -> the channel whose motion it contains, for exchanged time histories."""
    step = max(float(times[-1] - times[0]) / (times.size - 1), simulated.step)
    start, end = max(times[0], simulated.time[0]), min(times[-1], simulated.time[-1])
    count = min(int((end - start) / step + 1e-6) + 1, MOST_SAMPLES)
    if count < 2:
        return {}
    grid = start + step * np.arange(count)
    size = fast_length(2 * count)
    exchanged: dict[str, str] = {}
    for unit in dict.fromkeys(measured.units.values()):
        names = [name for name in measured.channels if measured.units[name] == unit and name in simulated.channels]
        spectra = []
        for record, clock in ((measured, times), (simulated, simulated.time)):
            curves = np.array([at_times(clock, record.channels[name], grid, step) for name in names])
            curves = curves - curves.mean(axis=1, keepdims=True) if names else curves
            spectra.append(np.fft.rfft(curves, size) if names else curves)
        exchanged |= _cycles(names, _correlations(spectra[0], spectra[1], size)) if len(names) > 1 else {}
    return exchanged


def exchanged_responses(names: Sequence[str], measured: Complex, simulated: Complex) -> dict[str, str]:
    """Return measured response -> the response whose phase and size it contains, for exchanged FRFs.

    Args:
        names: names of the responses to one input.
        measured, simulated: responses on even lines [m/s2 per m], (n, m); NaN where undefined.
    """
    if len(names) < 2:
        return {}
    defined = np.isfinite(measured).all(axis=0) & np.isfinite(simulated).all(axis=0)
    size = fast_length(4 * defined.size)
    return _cycles(
        list(names), _correlations(np.where(defined, measured, 0.0), np.where(defined, simulated, 0.0), size)
    )


def _correlations(measured: Complex, simulated: Complex, size: int) -> Vector:
    """Return the largest |correlation| over all lags of spectra (n, m) of records of this size, (n, n)."""
    table = np.zeros((len(measured), len(simulated)))
    powers = [np.sqrt(2.0 * np.sum(np.abs(each) ** 2, axis=1) / size) for each in (measured, simulated)]
    for i, first in enumerate(measured):
        for j, second in enumerate(simulated):
            power = powers[0][i] * powers[1][j]
            table[i, j] = np.max(np.abs(np.fft.irfft(first * np.conj(second), size))) / power if power > 0.0 else 0.0
    return np.minimum(table, 1.0)


def _cycles(names: Sequence[str], table: Vector) -> dict[str, str]:
    """Return name -> name of the exchanged channels of a table of correlations, (n, n)."""
    to = scipy.optimize.linear_sum_assignment(-table)[1].tolist()
    exchanged: dict[str, str] = {}
    left = set(range(len(names)))
    while left:
        cycle = [left.pop()]
        while (following := to[cycle[-1]]) != cycle[0]:
            cycle.append(following)
            left.discard(following)
        clear = all(
            table[i, to[i]] >= max(SAME_MOTION, table[i, i] + BETTER)
            and 1.0 - table[i, to[i]] <= REMAINING * (1.0 - table[i, i])
            for i in cycle
        )
        if len(cycle) > 1 and clear:
            exchanged |= {names[i]: names[to[i]] for i in cycle}
    return exchanged


def exchange_finding(exchanged: Mapping[str, str], mapped: Mapping[str, str], *, complete: bool) -> list[Finding]:
    """Return the finding on exchanged channels, with the options --map that put them right; [] without any.

    If the channels of all wheels are exchanged alike, the plates may be instead: the finding then has no options.

    Args:
        exchanged: measured channel -> channel whose motion it contains.
        mapped: channel of the model -> its channel in the file, as for --map; empty for a run.
        complete: --map must name all channels, because the file was read by their names.
    """
    options = _renamed(mapped, exchanged, complete=complete)
    if not options:
        return []
    pairs = ", ".join(f"{name} moves like {motion} of the run" for name, motion in exchanged.items())
    wheels = _exchanged_wheels(exchanged, [parsed_name(role).output for role in mapped])
    if wheels:
        # The run moves wheel b with the motion that its plate had at wheel a.
        plates = {f"plate_{b}_displacement": f"plate_{a}_displacement" for a, b in wheels.items()}
        plate_options = shlex.join(_renamed(mapped, plates, complete=complete))
        text = (
            f"the plates or all other channels are swapped: {pairs}; if the plates, "
            f"{f'set {plate_options}' if plate_options else 'swap the plate signals of the run between the wheels'}; "
            "if the channels, set "
            f"{shlex.join(options)}"
        )
        return [Finding(text, "exchanged")]
    return [Finding(f"swapped channels: {pairs}; set {shlex.join(options)}", "exchanged", options)]


def _renamed(mapped: Mapping[str, str], names: Mapping[str, str], *, complete: bool) -> tuple[str, ...]:
    """Return the options --map of channels under other names (old -> new), as words; () if none is mapped.

    A role keeps its plate: "knuckle_fl_acc_z/plate_fl".
    """
    outputs = {role: parsed_name(role).output for role in mapped}
    right = {names[output] + role[len(output) :]: mapped[role] for role, output in outputs.items() if output in names}
    if complete and right:
        kept = [role for role, output in outputs.items() if role in right or output not in names]
        right = {role: right.get(role, mapped[role]) for role in kept} | right
    return map_words(right)


def _exchanged_wheels(exchanged: Mapping[str, str], names: Iterable[str]) -> dict[str, str]:
    """Return wheel -> wheel if the channels of all wheels but their plates are exchanged alike, else {}."""
    wheels: dict[str, str] = {}
    for name in names:
        wheel, motion = _wheel(name), exchanged.get(name, name)
        if not wheel or name.startswith("plate_"):
            alike = motion == name
        else:
            other = wheels.setdefault(wheel, _wheel(motion))
            expected = "_".join(other if part == wheel else part for part in name.split("_"))
            alike = wheel != other and motion == expected
        if not alike:
            return {}
    return wheels


def _wheel(name: str) -> str:
    return next((part for part in name.split("_") if is_wheel(part)), "")


def put_right(record: Record, exchanged: Mapping[str, str]) -> Record:
    """Return a record with exchanged channels under the names of their motions."""
    motions = {exchanged.get(name, name): values for name, values in record.channels.items()}
    return replace(record, channels={name: motions[name] for name in record.channels})
