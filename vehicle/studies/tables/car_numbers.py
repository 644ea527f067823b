"""Numbers of a table as numbers of a new car: units, sizes, axles, and what follows from several of them.

    sprung and unsprung      m = m_s + m_uf + m_ur,   h = (m_s h_s + m_u r) / m,   x = (m_s x_s + m_ur L) / m
    moments about the CoG    I = I_s + m_s d_s^2 + sum m_u d_u^2   (wheels as points at their centres)
    spring at the wheel      K_w = i^2 K_s,   C_w = i_d^2 C_d      (i: spring travel per wheel travel)
    ride rate                K_w = K_r K_t / (K_t - K_r)
    bar                      K_phi = K_w t^2 / 2 + K_bar

Sources: Gillespie, Fundamentals of Vehicle Dynamics, chapter 5 and 6 (rates, roll stiffness); parallel axes.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from vehicle.digits import number as shown
from vehicle.errors import DataError
from vehicle.studies.tables.number_names import GUESSED, PER_WHEEL, QUANTITIES, SI, number_of
from vehicle.studies.tables.statements import Number, Statements
from vehicle.studies.tables.unit_factor import MASS, unit_factor

AXLES = ("front", "rear")
GRAVITY = 9.81
"""Acceleration of gravity that turns a wheel load in N into kg [m/s2]."""

ONE_WHEEL, WHOLE_AXLE = 55.0, 75.0
"""Unsprung mass without a word [kg]: up to the first that of a wheel, from the second on that of an axle."""

AGREE = 0.01
"""Relative difference of two statements of one number that is round-off."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Stated:
    """Number in SI units with its row: place, name and value as in the file."""

    value: float
    place: str
    text: str


@dataclass(slots=True)
class CarNumbers:
    """Numbers of a table.

    Attributes:
        stated: values by names of `StatedNumbers`.
        origins: place and text of the rows behind each of them.
        parameters: values and origins by axle and path, of parts without such a name.
        guessed, left_out: sentences with the place or "".
    """

    stated: dict[str, Any] = field(default_factory=dict)
    origins: dict[str, str] = field(default_factory=dict)
    parameters: dict[tuple[str, str], tuple[float, str]] = field(default_factory=dict)
    guessed: list[tuple[str, str]] = field(default_factory=list)
    left_out: list[tuple[str, str]] = field(default_factory=list)


Values = dict[tuple[str, str], Stated]
"""Numbers by key and axle, "" for the whole car or both axles."""


def read_numbers(found: Statements, result: CarNumbers) -> Values:
    """Return the numbers of a table in SI units by key and axle; enter guesses and what is left out.

    Raises:
        DataError: a unit of another dimension, an impossible size, or two different values of one number.
    """
    values: Values = {}
    corners: dict[tuple[str, str], dict[str, Stated]] = {}
    per_wheel, symbols = _by_the_sum(found), list[str]()
    for row in found.numbers:
        known = number_of(row.name)
        if isinstance(row.value, str):
            if row.name.has("tyre") or row.name.has("wheel"):
                _enter_size(row, result)
            else:
                result.left_out.append((row.place, f"{row.name.text!r}: no number of a car here"))
            continue
        if known is None:
            result.left_out.append((row.place, f"{row.name.text!r} = {row.value:g}: no number of a car here"))
            continue
        key, axle, symbol = known
        if key == "axle_load" and row.unit.strip() == "%":
            key = "front_share"
        value = Stated(value=_si(row, key, result), place=row.place, text=_text(row))
        if symbol and len(row.name.words) <= 2 and row.name.words != (key,):
            symbols.append(f"{row.name.text} {_words(key, axle)}")
        value = _of_axle(row, key, value, result, per_wheel)
        _require_size(row, key, value.value)
        if row.name.side in ("left", "right"):
            sides = corners.setdefault((key, axle), {})
            if row.name.side in sides:
                raise DataError(f"{row.place}: {row.name.text!r} is stated twice; remove one")
            sides[row.name.side] = value
            continue
        if (key, axle) in values and abs(values[key, axle].value - value.value) > 1e-6 * abs(value.value):
            raise DataError(
                f"{row.place}: {row.name.text!r} and {values[key, axle].text} ({values[key, axle].place}) are two "
                f"values of {_words(key, axle)}; remove one, or name the axle"
            )
        values[key, axle] = value
    if symbols:
        result.guessed.append(("", f"symbols: {', '.join(symbols)}"))
    for (key, axle), sides in corners.items():
        values[key, axle] = _both_sides(key, axle, sides, result)
    return values


def _si(row: Number, key: str, result: CarNumbers) -> float:
    """Return a number in its SI unit; a unit that is not stated must follow from the size."""
    quantity = QUANTITIES[key]
    assert isinstance(row.value, float)  # fmt: skip
    if row.unit:
        unit = unit_factor(row.unit, quantity.dimension)
        if key == "axle_load" and unit is not None and unit.dimension == (1, 1, -2, 0):
            return row.value * unit.factor / GRAVITY
        if key == "front_share" and row.unit == "kg":
            unit = None
        if unit is None or unit.dimension != quantity.dimension:
            raise DataError(f"{row.place}: {row.name.text!r} has the unit {row.unit!r}, but {_words(key, '')} needs one "
                            f"such as {' or '.join(GUESSED[quantity.dimension])}; correct name or unit")  # fmt: skip
        return row.value * unit.factor
    if key == "front_share" and row.value > 1.0:
        return 0.01 * row.value
    low, high = quantity.sizes
    fitting = [(text, unit.factor) for text in GUESSED[quantity.dimension]
               if (unit := unit_factor(text)) is not None and low <= row.value * unit.factor <= high]  # fmt: skip
    if len(fitting) != 1:
        raise DataError(f"{row.place}: {row.name.text!r} = {row.value:g} has no unit, and the size of "
                        f"{'several units' if fitting else 'none'} of {', '.join(GUESSED[quantity.dimension])}; write "
                        "its unit")  # fmt: skip
    if fitting[0][0] != "-":
        result.guessed.append((row.place, f"{row.name.text!r} = {row.value:g}: in {fitting[0][0]}, by its size"))
    return row.value * fitting[0][1]


def _by_the_sum(found: Statements) -> bool | None:
    """Return whether unsprung masses are those of a wheel, by the mass of the car and that of its body; None: unknown.

    m = m_s + m_uf + m_ur with masses of axles, m = m_s + 2 m_uf + 2 m_ur with those of wheels.
    """
    masses: dict[str, list[float]] = {}
    for row in found.numbers:
        known = number_of(row.name)
        if (
            known is not None
            and isinstance(row.value, float)
            and known[0] in ("kerb_mass", "sprung_mass", "unsprung_mass")
        ):
            unit = unit_factor(row.unit or "kg", MASS)
            masses.setdefault(known[0], []).append(row.value * (1.0 if unit is None else unit.factor))
    sizes = [len(masses.get(key, ())) for key in ("kerb_mass", "sprung_mass", "unsprung_mass")]
    if sizes not in ([1, 1, 2], [1, 1, 1]):
        return None
    (kerb,), (sprung,), unsprung = masses["kerb_mass"], masses["sprung_mass"], masses["unsprung_mass"]
    axles = sum(unsprung) * (2.0 if len(unsprung) == 1 else 1.0)
    errors = [abs(sprung + factor * axles - kerb) for factor in (1.0, 2.0)]
    return errors[1] < errors[0] if min(errors) < AGREE * kerb else None


def _of_axle(row: Number, key: str, value: Stated, result: CarNumbers, by_the_sum: bool | None) -> Stated:
    """Return masses of an axle from those of a wheel; `by_the_sum`: see `_by_the_sum`."""
    if key not in ("unsprung_mass", "axle_load", "sprung_mass") or row.name.side in ("left", "right"):
        return value
    words, axle = set(row.name.words) | set(row.unit.lower().split()), row.name.axle
    per_wheel = bool(words & set(PER_WHEEL))
    if key == "unsprung_mass" and by_the_sum is not None:
        per_wheel = by_the_sum
    elif not per_wheel and key == "unsprung_mass" and "axle" not in row.name.text.lower():
        if ONE_WHEEL < value.value < WHOLE_AXLE:
            raise DataError(f"{row.place}: {row.name.text!r} = {value.value:g} kg may be the mass of a wheel or of an "
                            "axle; write \"per wheel\" or \"axle\" in its name")  # fmt: skip
        per_wheel = value.value <= ONE_WHEEL
        result.guessed.append(
            (row.place, f"{row.name.text!r}: of {'a wheel' if per_wheel else 'an axle'}, by its size")
        )
    if per_wheel and (key != "sprung_mass" or axle or words & {"corner", "quarter"}):
        return Stated(value=2.0 * value.value, place=value.place, text=f"2 x {value.text}")
    return value


def _both_sides(key: str, axle: str, sides: Mapping[str, Stated], result: CarNumbers) -> Stated:
    """Return the number of an axle from those of its two wheels: the sum of masses, the mean of all others."""
    if set(sides) != {"left", "right"}:
        (one,) = sides.values()
        result.guessed.append((one.place, f"{one.text}: the same on the other side"))
        factor = 2.0 if key in ("axle_load", "unsprung_mass", "sprung_mass") else 1.0
        return Stated(value=factor * one.value, place=one.place, text=one.text)
    left, right = sides["left"], sides["right"]
    if abs(left.value - right.value) > AGREE * abs(left.value):
        result.left_out.append((left.place, f"difference of {left.text} and {right.text}: the car is symmetric"))
    factor = 1.0 if key in ("axle_load", "unsprung_mass", "sprung_mass") else 0.5
    return Stated(value=factor * (left.value + right.value), place=left.place, text=f"{left.text}, {right.text}")


def _require_size(row: Number, key: str, value: float) -> None:
    low, high = QUANTITIES[key].sizes
    if not (math.isfinite(value) and low <= value <= high):
        unit = SI[QUANTITIES[key].dimension]
        raise DataError(f"{row.place}: {_text(row)} is {shown(value, 4)} {unit}, must be {low:g} to {high:g} {unit}; check "
                        "value and unit")  # fmt: skip


def _text(row: Number) -> str:
    return f"{row.name.text} = {row.value:g} {row.unit}".strip() if isinstance(row.value, float) else row.name.text


def _words(key: str, axle: str) -> str:
    return f"{key.replace('_', ' ')} {axle}".strip()


def _enter_size(row: Number, result: CarNumbers) -> None:
    if row.name.axle == "rear" and "tyre_size" in result.stated:
        result.left_out.append((row.place, f"{row.name.text!r} {row.value}: the car has one radius, of the front"))
        return
    result.stated["tyre_size"], result.origins["tyre_size"] = row.value, f"{row.name.text} ({row.place})"


@dataclass(slots=True)
class _Numbers:
    """Numbers of a table on their way to those of a car."""

    values: Values
    result: CarNumbers
    used: set[tuple[str, str]] = field(default_factory=set)

    def get(self, key: str, axle: str = "") -> float | None:
        """Return a number of an axle, or that of both axles."""
        for of_axle in (axle, ""):
            if (entry := self.values.get((key, of_axle))) is not None:
                self.used.add((key, of_axle))
                return entry.value
        return None

    def put(self, name: str, value: float, *rows: tuple[str, str], why: str = "") -> None:
        """Enter a number of the car with the rows that it comes from."""
        self.result.stated[name] = value
        texts = [self.values[row].text for row in rows if row in self.values]
        self.result.origins[name] = ", ".join([*texts, why] if why else texts)

    def guess(self, key: str, axle: str, text: str) -> None:
        row = self.values.get((key, axle)) or self.values.get((key, ""))
        self.result.guessed.append((row.place if row else "", text))


def car_numbers(
    values: Values, result: CarNumbers, points: Mapping[str, Any], spring_points: Mapping[str, bool]
) -> None:
    """Enter the numbers of a new car.

    Args:
        values: numbers of the table.
        result: receives the numbers, guesses and what is left out.
        points: what the points give: "wheelbase", "track_front", "track_rear", "tyre_radius", "cog".
        spring_points: by axle, whether the table places the spring and the arms, so that a rate is one of the spring.

    Raises:
        DataError: numbers contradict each other, or one lacks another that it needs.
    """
    table = _Numbers(values=values, result=result)
    _lengths(table, points)
    _masses(table)
    _cog_and_inertia(table, points)
    for axle in AXLES:
        _rates(table, axle, at_spring=spring_points.get(axle, False))
    for row, entry in values.items():
        if row not in table.used:
            result.left_out.append((entry.place, f"{entry.text}: what it needs is not stated"))


def _lengths(table: _Numbers, points: Mapping[str, Any]) -> None:
    for name, key, axle in (("wheelbase", "wheelbase", ""), ("track_front", "track", "front"),
                            ("track_rear", "track", "rear"), ("tyre_radius", "tyre_radius", "front")):  # fmt: skip
        stated, placed = table.get(key, axle), points.get(name)
        if stated is not None and placed is not None and abs(stated / placed - 1.0) > AGREE:
            raise DataError(
                f"{_words(key, axle)}: stated {stated:g} m, but the points give {placed:.4f} m; correct one"
            )
        if placed is not None:
            table.put(name, round(placed, 9), why="points")
        elif stated is not None:
            table.put(name, stated, (key, axle), (key, ""))
    rear = table.get("tyre_radius", "rear")
    if rear is not None and abs(rear - table.result.stated.get("tyre_radius", rear)) > 1e-3:
        table.result.left_out.append(("", f"rear tyre radius {rear:g} m: the car has one radius, that of the front"))
    free = table.get("free_radius", "front") or table.get("free_radius", "rear")
    if free is not None and "tyre_radius" not in table.result.stated:
        row = next(key for key in (("free_radius", "front"), ("free_radius", ""), ("free_radius", "rear"))
                   if key in table.values)  # fmt: skip
        table.put("tyre_free_radius", free, row)
    elif free is not None:
        table.result.left_out.append(("", f"free radius {free:g} m: the loaded radius is known too"))


def _cog_distances(table: _Numbers) -> tuple[float | None, float | None, float | None]:
    """Return a, b and L: the CoG behind the front axle, before the rear axle, and the wheelbase [m]."""
    a = table.get("cog_x", "front") if ("cog_x", "front") in table.values else table.get("cog_x")
    b = table.values.get(("cog_x", "rear"))
    if b is not None:
        table.used.add(("cog_x", "rear"))
    return a, None if b is None else b.value, table.result.stated.get("wheelbase")


def _masses(table: _Numbers) -> None:
    stated, values = table.result.stated, table.values
    unsprung = {axle: table.get("unsprung_mass", axle) for axle in AXLES}
    for axle, mass in unsprung.items():
        if mass is not None:
            table.put(f"unsprung_mass_{axle}", mass, ("unsprung_mass", axle), ("unsprung_mass", ""))
    sprung = {axle: table.get("sprung_mass", axle) for axle in AXLES if ("sprung_mass", axle) in values}
    loads = {axle: table.get("axle_load", axle) for axle in AXLES}
    for axle, mass in sprung.items():
        if mass is None or unsprung[axle] is None:
            raise DataError(f"sprung mass {axle}: the axle load needs the unsprung mass of this axle too; add it")
        if loads[axle] is None:
            loads[axle] = mass + (unsprung[axle] or 0.0)
    kerb, whole = table.get("kerb_mass"), table.get("sprung_mass") if ("sprung_mass", "") in values else None
    if whole is not None and unsprung["front"] is not None and unsprung["rear"] is not None:
        total = whole + unsprung["front"] + unsprung["rear"]
        if kerb is not None and abs(total / kerb - 1.0) > AGREE:
            raise DataError(f"sprung mass {whole:g} kg and unsprung masses {unsprung['front']:g} and "
                            f"{unsprung['rear']:g} kg: together {total:g} kg instead of the mass of {kerb:g} kg; correct "
                            "one (unsprung masses: of an axle or of a wheel?)")  # fmt: skip
        kerb = total if kerb is None else kerb
        table.put("kerb_mass", kerb, ("kerb_mass", ""), ("sprung_mass", ""), why="with the unsprung masses")
    elif kerb is not None:
        table.put("kerb_mass", kerb, ("kerb_mass", ""))
    elif whole is not None:
        raise DataError(f"sprung mass {whole:g} kg: the mass of the car needs the unsprung masses too; add them")
    for axle, load in loads.items():
        if load is not None:
            table.put(f"{axle}_axle_load", load, ("axle_load", axle), ("sprung_mass", axle))
    share = next((table.get("front_share", axle) if axle != "rear" else 1.0 - (table.get("front_share", "rear") or 0.0)
                  for axle in ("front", "", "rear") if ("front_share", axle) in values), None)  # fmt: skip
    both = loads["front"] is not None and loads["rear"] is not None
    if both and kerb is not None:
        total = (loads["front"] or 0.0) + (loads["rear"] or 0.0)
        if abs(total / kerb - 1.0) > AGREE:
            raise DataError(f"axle loads: together {total:g} kg instead of the mass of {kerb:g} kg; correct one")
        del stated["kerb_mass"]
    if share is not None and not any(loads.values()):
        if kerb is None:
            raise DataError("mass distribution: needs the mass of the car; add it")
        table.put(
            "front_axle_load", share * kerb, ("front_share", "front"), ("front_share", ""), ("front_share", "rear")
        )


def _cog_and_inertia(table: _Numbers, points: Mapping[str, Any]) -> None:
    stated = table.result.stated
    mass = stated.get("kerb_mass") or stated.get("front_axle_load", 0.0) + stated.get("rear_axle_load", 0.0)
    front, rear = (stated.get(f"unsprung_mass_{axle}") for axle in AXLES)
    wheelbase, radius = stated.get("wheelbase"), stated.get("tyre_radius")
    a, b, _ = _cog_distances(table)
    if a is not None and b is not None:
        if wheelbase is None:
            stated["wheelbase"] = wheelbase = a + b
            table.result.origins["wheelbase"] = "distances of the centre of gravity from both axles"
        elif abs((a + b) / wheelbase - 1.0) > AGREE:
            raise DataError(f"centre of gravity: {a:g} and {b:g} m from the axles make {a + b:g} m instead of the "
                            f"wheelbase of {wheelbase:g} m; correct one")  # fmt: skip
    elif b is not None:
        if wheelbase is None:
            raise DataError("centre of gravity from the rear axle: needs the wheelbase; add it")
        a = wheelbase - b
    height, sprung_height = table.get("cog_height"), table.get("sprung_cog_height")
    sprung_a = table.get("sprung_cog_x", "front")
    cog = points.get("cog")
    if cog is not None:
        x, above, of_sprung = cog
        if radius is None:
            raise DataError("centre of gravity as a point: its height needs the tyre radius or the tyre patch; add it")
        if of_sprung:
            sprung_a, sprung_height = x, above + radius
        else:
            a, height = x, above + radius
    placed = any(name in stated for name in ("front_axle_load", "rear_axle_load"))
    complete = front is not None and rear is not None and mass and radius is not None
    sprung = mass - (front or 0.0) - (rear or 0.0)
    if height is None and sprung_height is not None and complete:
        height = (sprung * sprung_height + ((front or 0.0) + (rear or 0.0)) * (radius or 0.0)) / mass
    elif height is None and sprung_height is not None:
        height = sprung_height
        table.guess(
            "sprung_cog_height", "", "height of the sprung mass taken for the car: unsprung masses or radius missing"
        )
    if a is None and sprung_a is not None and not placed:
        if not (front is not None and rear is not None and wheelbase):
            raise DataError("centre of gravity of the sprung mass: needs unsprung masses and wheelbase; add them")
        a = (sprung * sprung_a + rear * wheelbase) / mass
    if height is not None:
        table.put("cog_height", round(height, 6), ("cog_height", ""), ("sprung_cog_height", ""))
    if a is not None and not placed:
        table.put("cog_x", round(a, 6), ("cog_x", ""), ("cog_x", "front"), ("cog_x", "rear"), ("sprung_cog_x", ""))
    elif a is not None:
        load = stated.get("front_axle_load") or mass - stated.get("rear_axle_load", 0.0)
        if wheelbase and mass and abs(1.0 - a / wheelbase - load / mass) > AGREE:
            raise DataError(f"centre of gravity {a:g} m behind the front axle: the axle loads give "
                            f"{wheelbase * (1.0 - load / mass):.3f} m; correct one")  # fmt: skip
    _inertia(table, mass, sprung, a, height, sprung_a, sprung_height)


def _inertia(table: _Numbers, mass: float, sprung: float, a: float | None, height: float | None,
             sprung_a: float | None, sprung_height: float | None) -> None:  # fmt: skip
    """Enter the moments of the car: stated, or of the sprung mass with the unsprung masses as points."""
    stated = table.result.stated
    for name in ("roll_inertia", "pitch_inertia", "yaw_inertia"):
        if (value := table.get(name)) is not None:
            table.put(name, value, (name, ""))
            continue
        if (own := table.get(f"sprung_{name}")) is None:
            continue
        needed = ("unsprung_mass_front", "unsprung_mass_rear", "track_front", "track_rear", "wheelbase", "tyre_radius")
        if a is None or height is None or any(key not in stated for key in needed):
            table.guess(f"sprung_{name}", "", f"{name.replace('_', ' ')} of the sprung mass left out: the moment of "
                        "the car needs unsprung masses, wheelbase, tracks, radius and centre of gravity")  # fmt: skip
            continue
        front, rear, track_f, track_r, wheelbase, radius = (stated[key] for key in needed)
        # The CoG of the sprung mass: stated, or what is left of the car.
        along = sprung_a if sprung_a is not None else (mass * a - rear * wheelbase) / sprung
        above = sprung_height if sprung_height is not None else (mass * height - (front + rear) * radius) / sprung
        x = (front * a**2 + rear * (wheelbase - a) ** 2) + sprung * (along - a) ** 2
        y = front * track_f**2 / 4.0 + rear * track_r**2 / 4.0
        z = (front + rear) * (radius - height) ** 2 + sprung * (above - height) ** 2
        extra = {"roll_inertia": y + z, "pitch_inertia": x + z, "yaw_inertia": x + y}[name]
        table.put(name, round(own + extra, 3), (f"sprung_{name}", ""), why="with the unsprung masses at the wheels")


def _rates(table: _Numbers, axle: str, *, at_spring: bool) -> None:
    """Enter rates, damping and frequencies of an axle."""
    tyre, ratio = table.get("tyre_rate", axle), table.get("motion_ratio", axle)
    damper_ratio = table.get("damper_ratio", axle) or ratio
    if tyre is not None:
        table.put(f"tyre_stiffness_{axle}", tyre, ("tyre_rate", axle), ("tyre_rate", ""))
    wheel, why = table.get("wheel_rate", axle), ("wheel_rate", axle)
    if wheel is None and (ride := table.get("ride_rate", axle)) is not None:
        if tyre is None or tyre <= ride:
            raise DataError(f"ride rate {axle} {ride:g} N/m: the wheel rate needs the tyre stiffness, above it; add it")
        wheel, why = ride * tyre / (tyre - ride), ("ride_rate", axle)
    lumped = table.get("suspension_rate", axle)
    if wheel is None and lumped is not None:
        wheel, why = lumped, ("suspension_rate", axle)
        table.guess(*why, f"{_words(*why)}: at the wheel")
    spring = table.get("spring_rate", axle)
    if spring is not None and wheel is None:
        why = ("spring_rate", axle)
        if ratio is not None:
            wheel = ratio**2 * spring
        elif at_spring:
            table.put(f"spring_stiffness_{axle}", spring, why, ("spring_rate", ""))
        else:
            wheel = spring
            table.guess(*why, f"{_words(*why)}: at the wheel (motion ratio 1), as neither a motion ratio nor the points "
                        "of spring and arm are stated")  # fmt: skip
    elif spring is not None and wheel is not None and ratio is None and not at_spring:
        table.result.left_out.append(("", f"{_words('spring_rate', axle)}: the wheel rate is stated too"))
    if wheel is not None:
        table.put(f"wheel_rate_{axle}", wheel, why, (why[0], ""), *((("motion_ratio", axle),) if ratio else ()))
    if (frequency := table.get("ride_frequency", axle)) is not None:
        if f"wheel_rate_{axle}" in table.result.stated or f"spring_stiffness_{axle}" in table.result.stated:
            table.result.left_out.append(("", f"ride frequency {axle} {frequency:g} Hz: follows from the stated rate"))
        else:
            table.put(f"ride_frequency_{axle}", frequency, ("ride_frequency", axle))
    if axle == "front" and (pitch := table.get("pitch_frequency")) is not None:
        table.put("pitch_frequency", pitch, ("pitch_frequency", ""))
    if (hop := table.get("wheel_hop", axle)) is not None:
        if tyre is None:
            table.put(f"wheel_hop_{axle}", hop, ("wheel_hop", axle))
        else:
            table.result.left_out.append(("", f"wheel hop {axle} {hop:g} Hz: follows from the tyre stiffness"))
    _damping(table, axle, damper_ratio, at_spring=at_spring)
    _roll(table, axle, wheel)


def _damping(table: _Numbers, axle: str, ratio: float | None, *, at_spring: bool) -> None:
    share, wheel = table.get("damping_ratio", axle), table.get("wheel_damping", axle)
    damper = table.get("damper_constant", axle)
    if (rubber := table.get("tyre_damping", axle)) is not None:
        row = table.values.get(("tyre_damping", axle)) or table.values["tyre_damping", ""]
        table.result.parameters[axle, "tyre.damping.z"] = (rubber, row.text)
    if wheel is not None:
        table.put(f"wheel_damping_{axle}", wheel, ("wheel_damping", axle), ("wheel_damping", ""))
    elif damper is not None and ratio is not None:
        table.put(f"wheel_damping_{axle}", ratio**2 * damper, ("damper_constant", axle), ("damper_constant", ""))
    elif damper is not None and at_spring:
        table.put(f"damper_constant_{axle}", damper, ("damper_constant", axle), ("damper_constant", ""))
    elif damper is not None:
        table.put(f"wheel_damping_{axle}", damper, ("damper_constant", axle), ("damper_constant", ""))
        table.guess("damper_constant", axle, f"damper constant {axle}: at the wheel (motion ratio 1)")
    elif share is not None:
        table.put(f"damping_ratio_{axle}", share, ("damping_ratio", axle), ("damping_ratio", ""))


def _roll(table: _Numbers, axle: str, wheel: float | None) -> None:
    whole, bar = table.get("roll_rate", axle), table.get("bar_rate", axle)
    track = table.result.stated.get(f"track_{axle}")
    per_degree = math.pi / 180.0
    if whole is not None:
        table.put(f"roll_stiffness_{axle}", whole * per_degree, ("roll_rate", axle))
    elif bar is not None and wheel is not None and track is not None:
        table.put(f"roll_stiffness_{axle}", (bar + 0.5 * wheel * track**2) * per_degree, ("bar_rate", axle),
                  why="with the springs, K_w t^2 / 2")  # fmt: skip
    elif bar is not None:
        table.result.left_out.append(("", f"bar rate {axle}: the roll stiffness needs wheel rate and track too"))
