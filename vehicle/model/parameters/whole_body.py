"""What follows where the mass or the centre of gravity of the trimmed body is varied alone.

    body.mass = f m:     I = f I about any point (CoG and radii of gyration stay); masses of the elastic model times f
    body.cog = c':       I about the CoG stays; about the origin I' = I + m (|c'|^2 1 - c' c''^T) - m (|c|^2 1 - c c^T)

A number that is given in the same variation is what is given; the others follow. The elastic model keeps the mass that
it was made for as `body.model_mass`, which `vehicle.toml` of a run repeats (`TrimmedBody.model_factor`).
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.body import MOMENTS
from vehicle.model.parameters.paths import Optional, meant, override
from vehicle.names import AXES

if TYPE_CHECKING:
    from vehicle.model.parameters.vehicle import Vehicle

_PRODUCTS = {"ixy": (0, 1), "izx": (2, 0), "iyz": (1, 2)}


def varied_table(
    table: Mapping[str, Any], overrides: Sequence[str], optional: Optional = list, before: Iterable[str] = ()
) -> dict[str, Any]:
    """Return a vehicle file with other values in their places, and what follows of the body's mass and CoG.

    Args:
        table: as of `read_table`; not changed.
        overrides: texts "path=value".
        optional: see `meant`.
        before: overrides that the table has already; what they give does not follow either.

    Returns:
        A new table.

    Raises:
        ConfigurationError: see `override`.
    """
    found = override(table, overrides, optional)
    if body_moves(table, found):
        texts = (text.partition("=")[0].strip() for text in (*before, *overrides))
        given = {place for text in dict.fromkeys(texts) for place in meant(found, text, optional)}
        put(found, followers(table["body"], found["body"], given))
    return found


def put(table: dict[str, Any], values: Mapping[str, float]) -> None:
    """Put numbers into a vehicle file.

    Args:
        table: the file; its tables on the way to a value are replaced by copies.
        values: whole path to value.
    """
    for path, value in values.items():
        *parents, name = path.split(".")
        inner = table
        for key in parents:
            inner[key] = dict(inner.get(key, {}))
            inner = inner[key]
        inner[name] = value


def body_moves(before: Mapping[str, Any], after: Mapping[str, Any]) -> bool:
    """Return True if the mass or the CoG of the body of two vehicle files differs."""
    own, other = (one["body"] if isinstance(one.get("body"), Mapping) else {} for one in (before, after))
    return any(own.get(key) != other.get(key) for key in ("mass", "cog"))


def followers(before: Mapping[str, Any], after: Mapping[str, Any], given: Collection[str]) -> dict[str, float]:
    """Return what follows a change of mass or CoG: whole paths and values.

    Args:
        before: table [body] of a vehicle file.
        after: the table with other values of mass or CoG.
        given: whole paths of what is given beside; that does not follow.
    """
    own, other = _numbers(before), _numbers(after)
    if own is None or other is None:
        return {}  # what is wrong with them is said where the table is read
    (mass, cog, moments, about), (new_mass, new_cog, _, _) = own, other
    factor = new_mass / mass
    found = {f"body.inertia.{name}": factor * value for name, value in moments.items()}
    if about == "origin" and cog != new_cog:
        for name, more in _of_point(new_mass, new_cog).items():
            path = f"body.inertia.{name}"
            found[path] = found.get(path, 0.0) + more - _of_point(new_mass, cog)[name]
    elif factor == 1.0:
        found = {}
    if factor != 1.0 and "superelement" in after and "body.superelement" not in given:
        found["body.model_mass"] = float(before.get("model_mass", mass))
    return {path: value for path, value in found.items() if path not in given}


def _numbers(body: Mapping[str, Any]) -> tuple[float, list[float], dict[str, float], str] | None:
    """Mass, CoG, given moments and their point of reference; None where they are no numbers of a body."""
    mass, cog, inertia = (body.get(key) for key in ("mass", "cog", "inertia"))
    if not isinstance(cog, list | tuple) or len(cog) != len(AXES) or not isinstance(inertia, Mapping):
        return None
    moments = {name: inertia[name] for name in MOMENTS if name in inertia}
    every = [mass, *cog, *moments.values(), body.get("model_mass", mass)]
    if any(isinstance(one, bool) or not isinstance(one, int | float) for one in every):
        return None
    try:
        mass, *others = (float(one) for one in every)
    except OverflowError:
        return None
    if not (mass > 0.0 and all(map(math.isfinite, (mass, *others)))):
        return None
    return (
        mass,
        [float(one) for one in cog],
        {name: float(one) for name, one in moments.items()},
        str(inertia.get("about", "cog")),
    )


def _of_point(mass: float, at: Sequence[float]) -> dict[str, float]:
    """Moments and products about the origin of a point mass [kg] at coordinates [m]."""
    squares = [value * value for value in at]
    moments = {name: mass * (sum(squares) - squares[axis]) for axis, name in enumerate(MOMENTS[:3])}
    return moments | {name: mass * at[i] * at[j] for name, (i, j) in _PRODUCTS.items()}


def body_notices(vehicle: Vehicle, overrides: Iterable[str]) -> list[str]:
    """Return a sentence for each override of the mass or CoG of the body: what followed.

    Args:
        vehicle: the car.
        overrides: texts "path=value" that it was made with.
    """
    body, texts = vehicle.body, {text.partition("=")[0].strip(): text.strip() for text in overrides}
    said = _said(vehicle, texts)
    moments = ", ".join(f"{name} {getattr(body.inertia, name):.6g}" for name in MOMENTS[:3])
    now = f"{moments} kg m2 about the {'CoG' if body.inertia.about == 'cog' else 'origin'}"
    if body.flexible and body.model_mass is not None:
        root = body.model_factor**-0.5
        now += f"; masses of the body model times {body.model_factor:.6g}, its frequencies times {root:.6g}"
    return [f"{text}; {now}" for text in said]


def body_rules(vehicle: Vehicle, paths: Iterable[str]) -> list[str]:
    """Return a sentence for the mass and the CoG of the body where many cars vary them: what follows.

    Args:
        vehicle: the car.
        paths: what is varied.
    """
    return _said(vehicle, {path: path for path in paths})


def _said(vehicle: Vehicle, texts: Mapping[str, str]) -> list[str]:
    """What follows, by what stands for each path."""
    places: dict[str, str] = {}
    for path, text in texts.items():
        # An optional one may have its default again.
        with contextlib.suppress(ConfigurationError):
            places |= dict.fromkeys(meant(vehicle.table, path), text)
    given = any(path.startswith("body.inertia.") for path in places)
    apart = ", but for what is given of body.inertia" if given else ""
    moved = dict.fromkeys(text for path, text in places.items() if path == "body.cog" or path.startswith("body.cog."))
    found = (
        [f"{places['body.mass']}: the whole body is scaled, radii of gyration stay{apart}"]
        if ("body.mass" in places)
        else []
    )
    return found + ([f"{', '.join(moved)}: the inertia about the CoG stays{apart}"] if moved else [])
