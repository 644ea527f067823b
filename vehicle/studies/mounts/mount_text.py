"""Fits of mounts as text: lines of a vehicle file, table of the points, printed summary."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from vehicle.digits import number, rounded
from vehicle.model.parameters.tested_range import range_lines
from vehicle.signals.formats.csv_table import table_text
from vehicle.studies.mounts.measured_stiffness import MeasuredStiffness
from vehicle.studies.mounts.mount_fit import MountFit

VECTORS = ("stiffness", "damping", "friction_force", "friction_stroke")
"""Parameters of a vehicle file with a value for each axis."""

MAXWELL = {"maxwell_stiffness": "N/m", "maxwell_damping": "N s/m", "friction_force": "N"}
ABSENT = {"rubber": {"damping": "N s/m"}, "hydromount": MAXWELL, "decoupler": MAXWELL}
"""Parameters that a law does not contain. Their zeros replace the values of a file that is the `base` of the car."""

POOR = 0.1
"""RMS error of the stiffness [-], and of the loss angle [rad], above which a fit is called poor: three times the
scatter of a good test rig."""

TITLES = {
    "rubber": "rubber with Maxwell branch and friction",
    "hydromount": "hydromount with inertia track",
    "decoupler": "hydromount with inertia track and decoupler",
}
"""Names of the laws in sentences."""


def caption_of(data: MeasuredStiffness, source: str) -> str:
    """Return the description of measured points in one line."""
    levels = [f"{1e3 * amplitude:.3g}" for amplitude, _ in data.levels()]
    several = f"amplitudes {', '.join(levels[:-1])} and {levels[-1]}" if len(levels) > 1 else f"amplitude {levels[0]}"
    low, high = np.min(data.frequency), np.max(data.frequency)
    return f"{source}: {len(data.frequency)} points, {several} mm peak, {low:g} to {high:g} Hz"


def vehicle_lines(fit: MountFit, caption: str, data: MeasuredStiffness) -> str:
    """Return the parameters as lines for a table of a bushing in a vehicle file, with their standard errors."""
    source = caption.split(":")[0]
    lines = [
        f"# {TITLES[fit.law.name]}, fitted to {caption}",
        "# z is the measured axis; x and y are set to the same values: replace them",
        "rotational_stiffness = 0.0  # [N m/rad] not measured",
    ]
    for name, unit in ABSENT[fit.law.name].items():
        zero = "[0.0, 0.0, 0.0]" if name in VECTORS else "0.0"
        lines.append(f"{name} = {zero}  # [{unit}] not in this law")
    for (name, unit), value, error, determined in zip(
        fit.law.parameters.items(), fit.values.tolist(), fit.errors.tolist(), fit.determined, strict=True
    ):
        text = repr(rounded(value, 5))
        shown = f"[{text}, {text}, {text}]" if name in VECTORS else text
        spread = f"standard error {number(error, 2)}" if determined else "not determined by these points"
        lines.append(f"{name} = {shown}  # [{unit}] fitted to {source}, {spread}")
    tested = {"amplitude": data.amplitude, "frequency": data.frequency}
    lines += range_lines({name: (float(np.min(each)), float(np.max(each))) for name, each in tested.items()})
    return "\n".join(lines) + "\n"


def fit_json(fits: Sequence[MountFit], caption: str, data: MeasuredStiffness) -> dict[str, Any]:
    """Return the first fit for `--json`: law, parameters, lines for `--set`, errors, and the criteria of all laws."""
    best = fits[0]
    lines = (line.partition("#")[0].strip() for line in vehicle_lines(best, caption, data).splitlines())
    return {
        "chosen": best.law.name,
        "parameters": [
            {
                "path": f"MOUNT.{name}{'.z' if name in VECTORS else ''}",
                "value": value,
                "standard_error": error if math.isfinite(error) else None,
                "unit": unit,
            }
            for (name, unit), value, error in zip(
                best.law.parameters.items(), best.values.tolist(), best.errors.tolist(), strict=True
            )
        ],
        "set": [f"MOUNT.{line.replace(' = ', '=', 1)}" for line in lines if line],
        "stiffness_error": dict(zip(("rms", "largest"), best.stiffness_error.tolist(), strict=True)),
        "loss_angle_error_rad": dict(zip(("rms", "largest"), best.angle_error.tolist(), strict=True)),
        "bic": {fit.law.name: fit.criterion for fit in fits},
    }


def points_text(fit: MountFit, data: MeasuredStiffness) -> str:
    """Return the measured and fitted values of all points as CSV text."""
    heads = ("frequency [Hz]", "amplitude [mm]", "stiffness [N/mm]", "loss_angle [deg]")
    rows: list[Sequence[Any]] = [[*heads, "fitted_stiffness [N/mm]", "fitted_loss_angle [deg]"]]
    fitted = fit.stiffness(data.frequency, data.amplitude)
    for index in np.concatenate([level for _, level in data.levels()]):
        values = [data.frequency[index], 1e3 * data.amplitude[index]]
        for stiffness in (data.stiffness[index], fitted[index]):
            values += [1e-3 * abs(stiffness), np.degrees(np.angle(stiffness))]
        rows.append(values)
    return table_text(rows)


def summary_lines(fits: Sequence[MountFit], caption: str) -> list[str]:
    """Return the printed summary: laws with their criteria and residuals, and the parameters of the first."""
    lines = [caption, f"{'law':<12}{'BIC':>9}   stiffness, RMS and max   loss angle, RMS and max"]
    for fit in fits:
        stiffness, angle = 100.0 * fit.stiffness_error, np.degrees(fit.angle_error)
        lines.append(
            f"{fit.law.name:<12}{fit.criterion:>9.1f}{f'{stiffness[0]:.1f} %, {stiffness[1]:.1f} %':>25}"
            f"{f'{angle[0]:.1f} deg, {angle[1]:.1f} deg':>26}"
        )
    best = fits[0]
    others = (
        f", the best fit for its number of parameters (BIC lower by {fits[1].criterion - best.criterion:.1f})"
        if len(fits) > 1
        else ""
    )
    lines.append(f"chosen: {TITLES[best.law.name]}{others}")
    if max(best.stiffness_error[0], best.angle_error[0]) > POOR:
        lines.append(
            f"poor fit: the RMS error is above {100.0 * POOR:.0f} % or {np.degrees(POOR):.0f} deg; check units, "
            "amplitudes (half of peak to peak) and scatter of the points: otherwise none of these laws fits"
        )
    criteria = {fit.law.name: fit.criterion for fit in fits}
    if best.law.name == "hydromount" and "decoupler" in criteria:
        lines.append(
            "these points show no decoupler: its five parameters do not improve the fit enough (BIC larger by "
            f"{criteria['decoupler'] - best.criterion:.1f})"
        )
    lines.append(f"{'parameter':<20}{'value':>12}   standard error")
    for (name, unit), value, error, determined in zip(
        best.law.parameters.items(), best.values, best.errors, best.determined, strict=True
    ):
        spread = f"{number(error, 2)} {unit}" if determined else "not determined by these points"
        lines.append(f"{name:<20}{value:>12.5g}   {spread}")
    return lines
