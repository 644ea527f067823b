"""Mass properties from accelerances as text: printed table, and lines of a vehicle file."""

from collections.abc import Callable

from vehicle.arrays import Vector
from vehicle.digits import aligned, number, rounded
from vehicle.model.flexbody.sources.accelerances import Accelerances
from vehicle.model.flexbody.sources.rigid_fit import NAMES, RigidFit

UNITS = ("kg", *3 * ("m",), *6 * ("kg m2",))
"""Units of `NAMES`."""

_DIGITS = 5
"""Significant digits of a value in a vehicle file; standard errors are rarely below 0.01 %."""


def summary_lines(fit: RigidFit, data: Accelerances, source: str) -> list[str]:
    """Return the printed table of mass properties with their standard errors, and how they were found."""
    chosen, left = fit.chosen, f", {data.left_out} other channels left out" if data.left_out else ""
    limits = [
        f"{description} {at:.4g} Hz"
        for description, at in (("support modes up to", chosen.below), ("first elastic resonance from", chosen.above))
        if at is not None
    ]
    range_text = "; ".join([f"range {chosen.low:.4g} to {chosen.high:.4g} Hz, {fit.lines} lines", *limits])
    rows = [("", "value", "standard error")]
    for name, value, error, unit in zip(NAMES, fit.values().tolist(), fit.errors.tolist(), UNITS, strict=True):
        decimals = 4 if unit == "m" else 2
        label = f"CoG {name} [m]" if unit == "m" else f"{name} [{unit}]"
        rows.append((label, f"{value:z.{decimals}f}", number(error, 2)))
    return [
        f"{source}: {len(data.names)} FRFs{left}",
        range_text,
        *aligned(rows),
        "moments and products (integrals) of inertia about the CoG, in the axes of the car",
        f"scatter {fit.scatter:.1%} of the FRFs, misfit of a rigid body {fit.misfit:.1%}, elastic motion "
        f"{fit.elastic:.0%} of the rigid motion at {chosen.high:.4g} Hz",
        f"modes on the support: {', '.join(number(each, 2) for each in fit.support)} Hz",
    ]


def _of_body(line: Callable[..., str]) -> list[str]:
    moments = [line(name, slice(index, index + 1)) for index, name in enumerate(NAMES[4:], 4)]
    return ["[body]", line("mass", slice(1)), line("cog", slice(1, 4)), "", "[body.inertia]", *moments]


def _of_engine(line: Callable[..., str]) -> list[str]:
    mass = [line("mass", slice(1)), line("inertia", slice(4, 7)), line("products", slice(7, 10))]
    return ["[engine.hardpoints]", line("engine_cog", slice(1, 4)), "", "[engine.parts.engine]", *mass]


PARTS = {"body": _of_body, "engine": _of_engine}
"""Parts of a car whose tables of a vehicle file have other names."""


def vehicle_text(fit: RigidFit, part: str, source: str) -> str:
    """Return the lines of a vehicle file.

    Args:
        part: name of `PARTS`.
        source: name of the measurement file, for the comments.
    """
    values = fit.values()

    def line(name: str, which: slice) -> str:
        def shown(numbers: Vector, digits: int) -> str:
            texts = [repr(rounded(each, digits) + 0.0) for each in numbers.tolist()]
            return texts[0] if len(texts) == 1 else f"[{', '.join(texts)}]"

        text, unit = shown(values[which], _DIGITS), UNITS[which.stop - 1]
        return f"{name} = {text}  # [{unit}] fitted to {source}, standard error {shown(fit.errors[which], 2)}"

    head = f"# {source}: rigid body, {fit.chosen.low:.4g} to {fit.chosen.high:.4g} Hz"
    return "\n".join([head, *PARTS[part](line)]) + "\n"
