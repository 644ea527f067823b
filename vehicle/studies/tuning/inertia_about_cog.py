"""Fit of moments of inertia about the origin, begun with those about the centre of gravity.

I_O = I_C + m (|c|^2 1 - c c^T) with |I_O| of ten times |I_C|: with I_O held, a step of the mass m alone, or of the
centre of gravity c, leaves the real bodies, whose I_C has positive second moments. With I_C held it stays a real body.
A fit of I_C is therefore made first; a fit of I_O, with the bounds of the user, begins where it ends.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from vehicle.model.flexbody.inertia_tensor import about_origin, components
from vehicle.model.flexbody.rigid_body import cog_inertia
from vehicle.model.parameters.body import MOMENTS, TrimmedBody
from vehicle.model.parameters.paths import full_path, overrides_of
from vehicle.model.parameters.ranges import Range
from vehicle.runs.car import Car

LENGTH = 0.1
"""Minimum scale of a moment or product in the fit, over the largest moment: one of them may be zero."""


def about_cog(
    car: Car, ranges: Sequence[Range]
) -> tuple[Car, tuple[Range, ...], Callable[[Mapping[str, float]], dict[str, float]]] | None:
    """Return car and ranges of a fit of I_C, and the function that gives the values about the origin of its values.

    Returns:
        None for a car whose tensor is about the centre of gravity, or of which no moment is fitted. The bounds of
        I_C are as far from its start as the bounds of I_O.
    """
    names = {entry.path: full_path(car.vehicle.table, entry.path).removeprefix("body.inertia.") for entry in ranges}
    moments = {path: name for path, name in names.items() if name in MOMENTS}
    if not moments or car.vehicle.body.inertia.about == "cog":
        return None
    begin = components(cog_inertia(car.vehicle.body))
    texts = [f"body.inertia.{name}={value!r}" for name, value in begin.items()]
    restated, largest = car.with_(['body.inertia.about="cog"', *texts]), max(begin.values())

    def shifted(entry: Range) -> Range:
        start = begin[moments[entry.path]]
        shift, length = start - entry.start, max(abs(start), LENGTH * largest)
        return replace(entry, low=entry.low + shift, high=entry.high + shift, start=start, length=length)

    def values_about_origin(values: Mapping[str, float]) -> dict[str, float]:
        body: TrimmedBody = restated.with_(overrides_of(restated.vehicle, values)).vehicle.body
        of_origin = components(about_origin(cog_inertia(body), body.mass, body.cog))
        return {path: of_origin[moments[path]] if path in moments else value for path, value in values.items()}

    return restated, tuple(shifted(entry) if entry.path in moments else entry for entry in ranges), values_about_origin
