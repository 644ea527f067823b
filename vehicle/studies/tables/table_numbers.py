"""Numbers of a table in SI units: units stated or by size, masses of wheels and axles, both sides of an axle."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from vehicle.digits import number as shown
from vehicle.errors import DataError
from vehicle.studies.tables.name_words import words_of
from vehicle.studies.tables.number_names import DAMPING, GUESSED, PER_WHEEL, QUANTITIES, RATE, SI, STROKES, number_of
from vehicle.studies.tables.statements import Number, Statements
from vehicle.studies.tables.unit_factor import FORCE, MASS, NONE, unit_factor

AXLES = ("front", "rear")
GRAVITY = 9.81
"""Acceleration of gravity that turns a wheel load in N into kg [m/s2]."""

ONE_WHEEL, WHOLE_AXLE = 55.0, 75.0
"""Unsprung mass without a word [kg]: up to the first of a wheel, from the second on of an axle."""

LIGHT_AXLE, HEAVY_WHEEL = 250.0, 600.0
"""Sprung mass over an axle [kg]: lightest of an axle, and heaviest of a wheel."""

_OF_BOTH_WHEELS = re.compile(
    r"\b(per|each|pro|je) (axle|achse)\b|\(axle\)|\bboth\b|\bpair\b|\b(two|2|beide\w*) (wheels|räder)\b|"
    r"\btotal axle\b|\baxle total\b|\bleft ?[+] ?right\b"
)
"""Words of a rate of both wheels of an axle together."""

_SYSTEM = re.compile(r"(?P<si>\bSI[ -](units?|Einheiten)\b|\bin SI\b)|"
                     r"\b(US|imperial|english|customary) (customary )?units\b|"
                     r"\bunits?: *(US|imperial|english)\b|\bUS customary\b")  # fmt: skip
"""System of units that a remark states."""

_OF_THE_WHEEL = re.compile(r"\b(wheel|rad)(weg)?( travel| displacement| movement)? *(/|:|per|over|to) *(the )?"
                           r"(spring|damper|shock|feder|dämpfer)")  # fmt: skip
"""Words of a motion ratio of wheel travel per spring travel, the inverse of ours."""

LIMITS = {"max", "maximum", "permissible", "permitted", "zul", "zulässig"}
"""Words of a remark on a limit of a number, which is not the number."""

_AXLE = {"axle", "both", "pair"}
"""Words of a mass of an axle."""

ONE_AXLE = 120.0
"""Largest unsprung mass of each axle where no axle is named [kg]: four wheels of a light car have more."""

AGREE = 0.01
"""Relative difference of two statements of one number that is round-off."""


NO_BAR = {("bar_rate", 0.0), ("bar_wheel_rate", 0.0)}
_HALF = re.compile(r"\bhalf[ -]*(car|vehicle)|\bhalbfahrzeug", re.IGNORECASE)
LIGHT_BODY = 750.0
"""Sprung mass [kg] below which a lumped model may be one of a quarter or a half of a car; assumed: the bodies of
passenger cars weigh more, half of a body mostly less."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Stated:
    """Number in SI units with its row: place, name and value as in the file."""

    value: float
    where: str
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


def read_numbers(content: Statements, result: CarNumbers) -> Values:
    """Return the numbers of a table in SI units by key and axle; enter guesses and what is left out.

    Raises:
        DataError: a unit of another dimension, an impossible size, or two different values of one number.
    """
    values: Values = {}
    corners: dict[tuple[str, str], dict[str, Stated]] = {}
    per_wheel, symbols = _by_the_sum(content), list[str]()
    per_wheel = _by_the_sizes(content) if per_wheel is None else per_wheel
    for row in content.numbers:
        listed = number_of(row.name)
        if listed is None and row.name.axle and row.name.axle not in words_of(row.name.text):
            # The axle of a title above it does not hold for a number of the whole car.
            listed = number_of(replace(row.name, axle=""))
        if isinstance(row.value, str):
            if row.name.has("tyre") or row.name.has("wheel"):
                _enter_size(row, result)
            else:
                result.left_out.append((row.where, f"{row.name.text!r}: no number of a car here"))
            continue
        stroke = next((word for word in STROKES if word in row.name.terms), "")
        if stroke:
            listed = number_of(replace(row.name, terms=tuple(term for term in row.name.terms if term != stroke)))
            listed = listed if listed is not None and QUANTITIES[listed[0]].dimension == DAMPING else None
        if listed is None or LIMITS & set(words_of(row.note)):
            why = "no number of a car here" if listed is None else "a limit"
            result.left_out.append((row.where, f"{row.name.text!r} = {row.value:g}: {why}"))
            continue
        key, axle, symbol = listed
        if key == "axle_load" and row.unit.strip() == "%":
            key = "front_share"
        value = Stated(value=_si(row, key, content.remarks, result), where=row.where, text=_text(row))
        if key in ("motion_ratio", "damper_ratio") and _OF_THE_WHEEL.search(f"{row.name.text} {row.note}".lower()):
            value = replace(value, value=1.0 / value.value, text=f"1 / {value.text}")
        if key == "half_track":
            key, value = "track", replace(value, value=2.0 * value.value, text=f"2 x {value.text}")
        if symbol and len(row.name.terms) <= 2 and row.name.text.lower() not in ("mass", "wheelbase"):
            symbols.append(f"{row.name.text} {key_words(key, axle)}")
        value = _of_axle(row, key, value, result, per_wheel)
        _require_size(row, key, value.value)
        side = stroke or row.name.side
        if side in ("left", "right", *STROKES):
            sides = corners.setdefault((key, axle), {})
            if side in sides:
                raise DataError(f"{row.where}: {row.name.text!r} is stated twice; remove one")
            sides[side] = value
            continue
        if (key, axle) in values and abs(values[key, axle].value - value.value) > 1e-6 * abs(value.value):
            raise DataError(
                f"{row.where}: {row.name.text!r} and {values[key, axle].text} ({values[key, axle].where}) are two "
                f"values of {key_words(key, axle)}; remove one, or name the axle"
            )
        values[key, axle] = value
    if symbols:
        result.guessed.append(("", f"symbols: {', '.join(symbols)}"))
    for (key, axle), sides in corners.items():
        values[key, axle] = _both_strokes(sides, result) if set(STROKES) & set(sides) else (
            _both_sides(key, axle, sides, result))  # fmt: skip
    _require_whole_body(values, content.remarks)
    loaded = {axle for key, axle in values if key == "tyre_radius"}
    for axle in [axle for key, axle in values if key == "rolling_radius"]:
        rolling = values.pop(("rolling_radius", axle))
        if loaded:
            result.left_out.append((rolling.where, f"{rolling.text}: the loaded radius is stated"))
        else:
            values["tyre_radius", axle] = rolling
            result.guessed.append((rolling.where, f"{rolling.text}: taken as the loaded radius"))
    return values


def _require_whole_body(values: Values, remarks: Sequence[str]) -> None:
    """Refuse a sprung mass that may be one of a quarter or a half of a car, where the mass of the car is not stated."""
    body = values.get(("sprung_mass", ""))
    if body is None or ("kerb_mass", "") in values or body.text.startswith("4 x") or \
            {"vehicle", "total"} & set(words_of(body.text)):  # fmt: skip
        return
    if body.value < LIGHT_BODY or _HALF.search(" ".join(remarks)):
        raise DataError(f"{body.where}: {body.text} may be of a quarter, a half or the whole of a car; write "
                        "\"quarter\" or \"vehicle\" in its name, or add the mass of the car")  # fmt: skip


def _si(row: Number, key: str, remarks: Sequence[str], result: CarNumbers) -> float:
    """Return a number in its SI unit; a unit that is not stated must follow from the size."""
    quantity = QUANTITIES[key]
    if not row.unit and quantity.dimension != NONE and (stated := _SYSTEM.search(" ".join(remarks))):
        if not stated["si"]:
            raise DataError(f"{row.where}: {row.name.text!r} = {row.value:g} has no unit, and the file states "
                            f"{stated[0]!r}; write its unit")  # fmt: skip
        row = replace(row, unit=SI[quantity.dimension])
    assert isinstance(row.value, float)  # fmt: skip
    if row.unit:
        unit = unit_factor(row.unit, quantity.dimension)
        if quantity.dimension == MASS and unit is not None and unit.dimension == FORCE:
            return row.value * unit.factor / GRAVITY
        if key == "front_share" and row.unit == "kg":
            unit = None
        if unit is None or unit.dimension != quantity.dimension:
            raise DataError(f"{row.where}: {row.name.text!r} has the unit {row.unit!r}, but {key_words(key, '')} needs "
                            f"one such as {' or '.join(GUESSED[quantity.dimension])}; correct one of both")  # fmt: skip
        return row.value * unit.factor
    if key in ("front_share", "roll_share") and row.value > 1.0:
        return 0.01 * row.value
    low, high = quantity.sizes
    fitting = [(text, unit.factor) for text in GUESSED[quantity.dimension]
               if (unit := unit_factor(text)) is not None and low <= row.value * unit.factor <= high]  # fmt: skip
    if len(fitting) != 1:
        raise DataError(f"{row.where}: {row.name.text!r} = {row.value:g} has no unit, and the size of "
                        f"{'several units' if fitting else 'none'} of {', '.join(GUESSED[quantity.dimension])}; write "
                        "its unit")  # fmt: skip
    if fitting[0][0] != "-":
        result.guessed.append((row.where, f"{row.name.text!r} = {row.value:g}: in {fitting[0][0]}, by its size"))
    return row.value * fitting[0][1]


def _by_the_sum(content: Statements) -> bool | None:
    """Return whether unsprung masses are of a wheel, by the masses of car and body; None: unknown.

    m = m_s + m_uf + m_ur with masses of axles, m = m_s + 2 m_uf + 2 m_ur with masses of wheels.
    """
    masses: dict[str, list[float]] = {}
    for row in content.numbers:
        listed = number_of(row.name)
        if (
            listed is not None
            and isinstance(row.value, float)
            and listed[0] in ("kerb_mass", "sprung_mass", "unsprung_mass")
        ):
            unit = unit_factor(row.unit or "kg", MASS)
            masses.setdefault(listed[0], []).append(row.value * (1.0 if unit is None else unit.factor))
    sizes = [len(masses.get(key, ())) for key in ("kerb_mass", "sprung_mass", "unsprung_mass")]
    if sizes not in ([1, 1, 2], [1, 1, 1]):
        return None
    (kerb,), (sprung,), unsprung = masses["kerb_mass"], masses["sprung_mass"], masses["unsprung_mass"]
    axles = sum(unsprung) * (2.0 if len(unsprung) == 1 else 1.0)
    errors = [abs(sprung + factor * axles - kerb) for factor in (1.0, 2.0)]
    return errors[1] < errors[0] if min(errors) < AGREE * kerb else None


def _by_the_sizes(content: Statements) -> bool | None:
    """Return True if the size of another mass shows that unsprung masses are of a wheel; None: unknown."""
    sizes = []
    for row in content.numbers:
        listed, unit = number_of(row.name), unit_factor(row.unit or "kg", MASS)
        said = {*row.name.terms, *words_of(row.name.text), *words_of(row.note)}
        if listed is not None and listed[0] == "unsprung_mass" and isinstance(row.value, float) and unit is not None \
                and (listed[1] or row.name.axle) and not row.name.side \
                and not said & (_AXLE | set(PER_WHEEL)):  # fmt: skip
            sizes.append(row.value * unit.factor)
    clear = {size <= ONE_WHEEL for size in sizes if not ONE_WHEEL < size < WHOLE_AXLE}
    return clear.pop() if len(clear) == 1 and any(ONE_WHEEL < size < WHOLE_AXLE for size in sizes) else None


def _of_axle(row: Number, key: str, value: Stated, result: CarNumbers, by_the_sum: bool | None) -> Stated:
    """Return the numbers of an axle with masses for both wheels and rates for one; by_the_sum: see above."""
    said, is_rate = f"{row.name.text} {row.note}".lower(), QUANTITIES[key].dimension in (RATE, DAMPING)
    if is_rate and _OF_BOTH_WHEELS.search(said):
        return replace(value, value=0.5 * value.value, text=f"1/2 x {value.text}")
    whole = row.name.has("heave") or "total" in words_of(row.name.text)
    if is_rate and whole and not set(words_of(said)) & set(PER_WHEEL):
        raise DataError(f"{row.where}: {row.name.text!r} may be of a wheel or of both; write \"per wheel\" or "
                        "\"per axle\" in its name")  # fmt: skip
    if key == "kerb_mass" and "occupied" in words_of(row.name.text):
        result.guessed.append((row.where, f"{row.name.text!r}: the mass of the car, with its driver"))
    if key not in ("unsprung_mass", "axle_load", "sprung_mass") or row.name.side in ("left", "right"):
        return value
    terms, axle = {*row.name.terms, *row.unit.lower().split(), *words_of(row.note)}, row.name.axle
    per_wheel = bool(terms & set(PER_WHEEL))
    if key == "unsprung_mass" and by_the_sum is not None:
        per_wheel = by_the_sum
    elif key == "unsprung_mass" and not (axle or per_wheel) and ("total" in terms or value.value > ONE_AXLE):
        raise DataError(f"{row.where}: {row.name.text!r} = {value.value:g} kg may be the mass of an axle or of all "
                        "wheels; write the mass of each axle")  # fmt: skip
    elif not per_wheel and key == "unsprung_mass" and not _AXLE & (terms | set(words_of(row.name.text))):
        if ONE_WHEEL < value.value < WHOLE_AXLE:
            raise DataError(f"{row.where}: {row.name.text!r} = {value.value:g} kg may be the mass of a wheel or of an "
                            "axle; write \"per wheel\" or \"axle\" in its name")  # fmt: skip
        per_wheel = value.value <= ONE_WHEEL
        result.guessed.append(
            (row.where, f"{row.name.text!r}: of {'a wheel' if per_wheel else 'an axle'}, by its size")
        )
    if key == "sprung_mass" and axle and not per_wheel and not _AXLE & (terms | set(words_of(row.name.text))):
        if LIGHT_AXLE < value.value < HEAVY_WHEEL:
            raise DataError(f"{row.where}: {row.name.text!r} = {value.value:g} kg may be of a wheel or of an axle; "
                            "write \"per wheel\" or \"axle\" in its name")  # fmt: skip
        per_wheel = value.value <= LIGHT_AXLE
        text = f"{row.name.text!r}: of {'a wheel' if per_wheel else 'an axle'}, by its size"
        result.guessed.append((row.where, text))
    if per_wheel:
        # The sprung mass of a quarter of the car, without an axle, is one of four.
        count = 4.0 if key == "sprung_mass" and not axle else 2.0
        return Stated(value=count * value.value, where=value.where, text=f"{count:g} x {value.text}")
    return value


def _both_sides(key: str, axle: str, sides: Mapping[str, Stated], result: CarNumbers) -> Stated:
    """Return the number of an axle from its two wheels: the sum of masses, the mean of all others."""
    if set(sides) != {"left", "right"}:
        (single,) = sides.values()
        result.guessed.append((single.where, f"{single.text}: the same on the other side"))
        factor = 2.0 if key in ("axle_load", "unsprung_mass", "sprung_mass") else 1.0
        return Stated(value=factor * single.value, where=single.where, text=single.text)
    left, right = sides["left"], sides["right"]
    if abs(left.value - right.value) > AGREE * abs(left.value):
        result.left_out.append((left.where, f"difference of {left.text} and {right.text}: the car is symmetric"))
    factor = 1.0 if key in ("axle_load", "unsprung_mass", "sprung_mass") else 0.5
    return Stated(value=factor * (left.value + right.value), where=left.where, text=f"{left.text}, {right.text}")


def _both_strokes(sides: Mapping[str, Stated], result: CarNumbers) -> Stated:
    """Return the mean of the damping in compression and rebound, the mean slope between equal velocities."""
    (first, *others) = sides.values()
    if not set(STROKES) <= set(sides):
        raise DataError(f"{first.where}: {first.text} is of one stroke; add the other one, or a damper curve")
    mean = sum(sides[stroke].value for stroke in STROKES) / 2.0
    text = f"({first.text} + {others[0].text}) / 2"
    result.guessed.append((first.where, f"{text}: the mean of both strokes"))
    return Stated(value=mean, where=first.where, text=text)


def _require_size(row: Number, key: str, value: float) -> None:
    low, high = QUANTITIES[key].sizes
    # An axle may have no bar.
    if not (math.isfinite(value) and low <= value <= high) and (key, value) not in NO_BAR:
        unit = SI[QUANTITIES[key].dimension]
        raise DataError(f"{row.where}: {_text(row)} is {shown(value, 4)} {unit}, must be {low:g} to {high:g} {unit}; "
                        "check value and unit")  # fmt: skip


def _text(row: Number) -> str:
    return f"{row.name.text} = {row.value:g} {row.unit}".strip() if isinstance(row.value, float) else row.name.text


def key_words(key: str, axle: str) -> str:
    """Return a number in words: "wheel rate front"."""
    return f"{key.replace('_', ' ')} {axle}".strip()


def _enter_size(row: Number, result: CarNumbers) -> None:
    if row.name.axle == "rear" and "tyre_size" in result.stated:
        result.left_out.append((row.where, f"{row.name.text!r} {row.value}: the car has one radius, of the front"))
        return
    result.stated["tyre_size"], result.origins["tyre_size"] = row.value, f"{row.name.text} ({row.where})"
