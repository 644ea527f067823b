"""Units of measurement files: quantity and conversion to SI."""

import math
import re
from typing import NamedTuple

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity [m/s2], ISO 80000-3, for records in g."""


class Unit(NamedTuple):
    """Unit with its quantity: value in SI = value * factor."""

    quantity: str
    si: str
    factor: float


_TABLE = {
    ("time", "s"): {"s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0},
    ("frequency", "Hz"): {"Hz": 1.0, "kHz": 1e3},
    ("displacement", "m"): {
        "m": 1.0,
        "cm": 1e-2,
        "mm": 1e-3,
        "um": 1e-6,
        "nm": 1e-9,
        "in": 0.0254,
        "mil": 2.54e-5,
        "ft": 0.3048,
        "km": 1e3,
    },
    ("velocity", "m/s"): {
        "m/s": 1.0,
        "mm/s": 1e-3,
        "cm/s": 1e-2,
        "km/h": 1.0 / 3.6,
        "mph": 0.44704,
        "knots": 1852.0 / 3600.0,
        "in/s": 0.0254,
    },
    ("acceleration", "m/s2"): {
        "m/s2": 1.0,
        "mm/s2": 1e-3,
        "cm/s2": 1e-2,
        "in/s2": 0.0254,
        "g": STANDARD_GRAVITY,
        "gn": STANDARD_GRAVITY,
        "mg": 1e-3 * STANDARD_GRAVITY,
    },
    ("force", "N"): {"N": 1.0, "kN": 1e3, "lbf": 4.4482216152605},
    ("moment", "N m"): {"Nm": 1.0, "kNm": 1e3},
    ("pressure", "Pa"): {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "bar": 1e5, "mbar": 1e2, "psi": 6894.757293168},
    ("angle", "rad"): {"rad": 1.0, "deg": math.pi / 180.0, "°": math.pi / 180.0, "arcmin": math.pi / 10800.0},
    ("angular velocity", "rad/s"): {"rad/s": 1.0, "deg/s": math.pi / 180.0, "°/s": math.pi / 180.0},
    ("voltage", "V"): {"V": 1.0, "mV": 1e-3, "Volts": 1.0, "Volt": 1.0},
    ("current", "A"): {"A": 1.0, "mA": 1e-3},
    ("strain", "m/m"): {"m/m": 1.0, "um/m": 1e-6},
    ("temperature", "degC"): {"degC": 1.0, "°C": 1.0},
}

UNITS = {text: Unit(*kind, factor) for kind, units in _TABLE.items() for text, factor in units.items()}
"""Plain spelling -> unit. g is gravity, in which sensors are calibrated."""

QUANTITIES = {kind[0]: kind[1] for kind in _TABLE}
"""Quantity -> SI unit."""

_SPELLINGS = {
    **dict.fromkeys(("second", "seconds", "Seconds", "Sec", "Secs", "secs"), "s"),
    **dict.fromkeys(("msec", "mSec", "mSecs", "msecs", "milliseconds", "millisecond"), "ms"),
    **dict.fromkeys(("usec", "usecs", "microseconds"), "us"),
    **dict.fromkeys(("kmh", "Kmh", "KMH", "km/hr", "Km/h", "KM/H", "kph", "KPH", "km_h", "kmph"), "km/h"),
    **dict.fromkeys(("MPH", "mi/h"), "mph"),
    **dict.fromkeys(("knot", "kts", "kt"), "knots"),
    **dict.fromkeys(("metres", "meters", "metre", "meter", "Meters"), "m"),
    **dict.fromkeys(("Meters/second", "meters/second", "mps", "Meters/s"), "m/s"),
    **dict.fromkeys(("mps2", "m/s^2.", "ms-2", "ms^-2"), "m/s2"),
    **dict.fromkeys(("degree", "degrees", "Degrees", "Deg", "DEG"), "deg"),
    **dict.fromkeys(("dps", "degrees/second", "degrees/s", "degs/s"), "deg/s"),
    **dict.fromkeys(("radians", "Rad"), "rad"),
    **dict.fromkeys(("rads/s", "rad/second"), "rad/s"),
    **dict.fromkeys(("gee", "g's", "Gs", "G's", "gravities"), "g"),
    **dict.fromkeys(("newton", "newtons", "Newton", "Newtons"), "N"),
    **dict.fromkeys(("HZ", "hz"), "Hz"),
    **dict.fromkeys(("volt", "volts", "VOLT"), "V"),
    **dict.fromkeys(("celsius", "Celsius", "deg C", "degrees C", "degreesC", ".C", "℃", "degc"), "degC"),
    **dict.fromkeys(("kilopascals", "kpa", "KPa"), "kPa"),
    **dict.fromkeys(("PSI",), "psi"),
}
"""Spellings of loggers -> spelling in `_TABLE`."""

_SMALL = {text.lower(): text for text in UNITS if text not in ("nm", "Nm", "h")}
"""Spelling in small letters -> spelling of the table, for units all in capitals. NM is a moment or a length."""

_SECONDS_SQUARED = re.compile(r"/(s|sec)(\^2|²|\*\*2|\^\(2\)|/s|/sec)$")
_NEGATIVE = re.compile(r"[ .·*]?s(\^-|\^\(-|-|⁻)(?P<power>[12¹²])\)?$")
_SCALED = re.compile(r"(?P<number>[+-]?\d+(\.\d*)?([eE][+-]?\d+)?)[ *]+(?P<unit>\D.*)")
_INVERSE = re.compile(r"\(1/(?P<lower>[^()]+)\)[*·. ]\(?(?P<upper>[^()]+)\)?")


def plain_unit(text: str) -> str:
    """Return a unit in the spelling of the table: m/s^2, m/s², m/s/s, m.s-2 become m/s2, micro signs u."""
    unit = text.strip().strip("[]").strip()
    if unit.startswith("(") and unit.endswith(")") and unit.count("(") == 1:
        unit = unit[1:-1].strip()
    unit = _SPELLINGS.get(unit, unit)
    unit = unit.replace("µ", "u").replace("μ", "u").replace("sec", "s").replace("_", "")
    unit = re.sub(r"/\(s ?(\^2|²|2|\*s)\)$", "/s2", unit)
    unit = _SECONDS_SQUARED.sub("/s2", unit.replace(" / ", "/"))
    unit = _NEGATIVE.sub(lambda match: "/s2" if match["power"] in "2²" else "/s", unit)
    if unit in ("N m", "N*m", "N·m", "N.m", "kN m", "kN*m"):
        unit = re.sub(r"[ *·.]", "", unit)
    return "g" if unit == "G" else unit


def find_unit(text: str) -> Unit | None:
    """Return the unit for a text; None for an unknown unit.

    Args:
        text: unit in the file; with a number, as in "12.5 mm", the value 1 in the file means that number.
    """
    entry = UNITS.get(plain_unit(text))
    if entry is None and text.isupper():
        entry = UNITS.get(_SMALL.get(plain_unit(text.lower()).lower(), ""))
    scaled = _SCALED.fullmatch(text.strip()) if entry is None else None
    if scaled is None:
        return entry
    unit = UNITS.get(plain_unit(scaled["unit"]))
    return None if unit is None else unit._replace(factor=unit.factor * float(scaled["number"]))


def seconds_in(text: str) -> float:
    """Return the length of a unit of time [s]; 0 for other units."""
    unit = find_unit(text)
    return unit.factor if unit is not None and unit.quantity == "time" else 0.0


GRAMS = ("g/s", "mg/s", "g/km", "g/h", "g/min", "g/l")
"""Ratios in which g is the gram: flows of air and fuel."""


def find_ratio(text: str) -> Unit | None:
    """Return the unit for a text or a ratio of units, such as (m/s2)/N, g/m or m/s2/N; None if ambiguous or unknown."""
    whole = find_unit(text)
    if whole is not None or text.strip().lower() in GRAMS:
        return whole
    inverse = _INVERSE.fullmatch(text.strip())
    if inverse:
        text = f"({inverse['upper']})/({inverse['lower']})"
    ratios: list[Unit] = []
    for match in re.finditer("/", text):
        upper, lower = find_unit(text[: match.start()]), find_unit(text[match.end() :])
        if upper is not None and lower is not None:
            ratios.append(
                Unit(f"{upper.quantity}/{lower.quantity}", f"({upper.si})/({lower.si})", upper.factor / lower.factor)
            )
    return ratios[0] if len(set(ratios)) == 1 else None


def allowed_units(quantity: str | None = None) -> str:
    """List the units of a quantity, or all units, for messages."""
    return ", ".join(text for text, unit in UNITS.items() if quantity in (None, unit.quantity))
