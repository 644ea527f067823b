"""Changes of the body that follow from a variation of its mass or of its centre of gravity.

    body.mass = f m:     I = f I about any point (CoG and radii of gyration stay); masses of the elastic model times f
    body.cog = c':       I about the CoG stays; about the origin I' = I + m (|c'|^2 1 - c' c''^T) - m (|c|^2 1 - c c^T)

Values that the same variation sets are kept; the others follow, also those that an earlier variation has set: each
variation acts on the result of the preceding variation. `body.model_mass` stores the mass to which the elastic model
belongs, also in `vehicle.toml` of a run (`TrimmedBody.model_factor`); a model that a variation sets belongs to the mass
of the body after it.
"""

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

from vehicle.model.parameters.body import MOMENTS
from vehicle.model.parameters.paths import Optional, meant, override
from vehicle.names import AXES

_PRODUCTS = {"ixy": (0, 1), "izx": (2, 0), "iyz": (1, 2)}


def varied_table(table: Mapping[str, Any], overrides: Sequence[str], optional: Optional = list) -> dict[str, Any]:
    """Return a vehicle file after one variation: with other values, and with the changes that follow for the body.

    Raises:
        ConfigurationError: see `override`.
    """
    varied = override(table, overrides, optional)
    if body_moves(table, varied):
        user_paths = {path for text in overrides for path in meant(varied, text.partition("=")[0].strip(), optional)}
        put(varied, followers(table["body"], varied["body"], user_paths))
    return varied


def restated(
    before: Mapping[str, Any], after: Mapping[str, Any], earlier: Iterable[str], optional: Optional = list
) -> list[str]:
    """Return texts that set the values which followed in a variation after others.

    With them, one variation with the texts of all steps makes the same car, bit for bit.

    Args:
        before: vehicle file before the variation.
        after: vehicle file after it.
        earlier: texts "path=value" of the variations before; if none sets a value of the body, the list is empty.
        optional: see `meant`.
    """
    names = dict.fromkeys(text.partition("=")[0].strip() for text in earlier)
    if not body_moves(before, after) or not any(
        path.startswith("body.") for name in names for path in meant(after, name, optional)
    ):
        return []
    body = after["body"]
    values = {f"inertia.{name}": body["inertia"][name] for name in MOMENTS if name in body["inertia"]}
    values |= {"model_mass": body["model_mass"]} if "model_mass" in body else {}
    return [f"body.{path}={float(value)!r}" for path, value in values.items()]


def put(table: dict[str, Any], values: Mapping[str, float], copies: set[int] | None = None) -> None:
    """Set numbers in a vehicle file.

    Args:
        table: the file, changed in place; inner tables on the path of a value are replaced by copies.
        values: whole path to value.
        copies: identities of the inner tables that are copies already; new ones are added.
    """
    copied = set[int]() if copies is None else copies
    for path, value in values.items():
        *parents, name = path.split(".")
        outer: Any = table
        for parent in parents:
            key: Any = AXES.index(parent) if isinstance(outer, list) else parent
            inner = outer.get(key, {}) if isinstance(outer, dict) else outer[key]
            if id(inner) not in copied:
                inner = inner.copy() if isinstance(inner, list) else dict(inner)
                copied.add(id(inner))
                outer[key] = inner
            outer = inner
        outer[AXES.index(name) if isinstance(outer, list) else name] = value


def body_moves(before: Mapping[str, Any], after: Mapping[str, Any]) -> bool:
    """Return True if mass, CoG or model of the body of two vehicle files differs."""
    first, second = (table["body"] if isinstance(table.get("body"), Mapping) else {} for table in (before, after))
    return any(first.get(key) != second.get(key) for key in ("mass", "cog", "superelement"))


def followers(before: Mapping[str, Any], after: Mapping[str, Any], user_paths: Collection[str]) -> dict[str, float]:
    """Return the values that follow from a change of mass or CoG, by their whole paths.

    Args:
        before: table [body] of a vehicle file.
        after: the table with other values of mass or CoG.
        user_paths: whole paths of values that are set and do not follow.
    """
    numbers, new_numbers = _numbers(before), _numbers(after)
    if numbers is None or new_numbers is None:
        return {}  # reading the table raises the error
    (mass, cog, moments, reference), (new_mass, new_cog, _, _) = numbers, new_numbers
    factor = new_mass / mass
    values = {f"body.inertia.{name}": factor * value for name, value in moments.items()}
    if reference == "origin" and cog != new_cog:
        for name, more in _of_point(new_mass, new_cog).items():
            path = f"body.inertia.{name}"
            values[path] = values.get(path, 0.0) + more - _of_point(new_mass, cog)[name]
    elif factor == 1.0:
        values = {}
    if "body.superelement" in user_paths and "model_mass" in before:
        values["body.model_mass"] = new_mass
    elif factor != 1.0 and "superelement" in after and "body.superelement" not in user_paths:
        values["body.model_mass"] = float(before.get("model_mass", mass))
    return {path: value for path, value in values.items() if path not in user_paths}


def _numbers(body: Mapping[str, Any]) -> tuple[float, list[float], dict[str, float], str] | None:
    """Return mass, CoG, moments and their point of reference; None if a value has the wrong type."""
    mass, cog, inertia = (body.get(key) for key in ("mass", "cog", "inertia"))
    if not isinstance(cog, list | tuple) or len(cog) != len(AXES) or not isinstance(inertia, Mapping):
        return None
    moments = {name: inertia[name] for name in MOMENTS if name in inertia}
    every = [mass, *cog, *moments.values(), body.get("model_mass", mass)]
    if any(isinstance(value, bool) or not isinstance(value, int | float) for value in every):
        return None
    try:
        mass, *others = (float(value) for value in every)
    except OverflowError:
        return None
    if not (mass > 0.0 and all(map(math.isfinite, (mass, *others)))):
        return None
    return (
        mass,
        [float(value) for value in cog],
        {name: float(value) for name, value in moments.items()},
        str(inertia.get("about", "cog")),
    )


def _of_point(mass: float, at: Sequence[float]) -> dict[str, float]:
    """Return moments and products about the origin of a point mass [kg] at coordinates [m]."""
    squares = [value * value for value in at]
    moments = {name: mass * (sum(squares) - squares[axis]) for axis, name in enumerate(MOMENTS[:3])}
    return moments | {name: mass * at[i] * at[j] for name, (i, j) in _PRODUCTS.items()}
