"""Factors of all units of measurement files against the constants of SciPy (CODATA, NIST SP 811)."""

import numpy as np
import pytest
from scipy import constants as c

from tests.validation import validated
from vehicle.signals.formats.units import QUANTITIES, UNITS

EXPECTED = {
    "time": {"s": 1.0, "sec": 1.0, "ms": c.milli, "us": c.micro, "ns": c.nano, "min": c.minute, "h": c.hour},
    "frequency": {"Hz": 1.0, "kHz": c.kilo},
    "displacement": {
        "m": 1.0, "cm": c.centi, "mm": c.milli, "um": c.micro, "nm": c.nano, "in": c.inch, "mil": c.mil, "ft": c.foot,
        "km": c.kilo,
    },
    "velocity": {
        "m/s": 1.0, "mm/s": c.milli, "cm/s": c.centi, "km/h": c.kmh, "mph": c.mph, "knots": c.knot, "in/s": c.inch,
    },
    "acceleration": {
        "m/s2": 1.0, "mm/s2": c.milli, "cm/s2": c.centi, "in/s2": c.inch, "g": c.g, "gn": c.g, "mg": c.milli * c.g,
    },
    "force": {"N": 1.0, "kN": c.kilo, "lbf": c.pound_force},
    "moment": {"Nm": 1.0, "kNm": c.kilo},
    "pressure": {
        "Pa": 1.0, "kPa": c.kilo, "MPa": c.mega, "bar": c.bar, "mbar": c.milli * c.bar, "psi": c.psi,
    },
    "angle": {"rad": 1.0, "deg": c.degree, "°": c.degree, "arcmin": c.arcminute},
    "angular velocity": {"rad/s": 1.0, "deg/s": c.degree, "°/s": c.degree},
    "voltage": {"V": 1.0, "mV": c.milli, "Volts": 1.0, "Volt": 1.0},
    "current": {"A": 1.0, "mA": c.milli},
    "strain": {"m/m": 1.0, "um/m": c.micro},
    "temperature": {"degC": 1.0, "°C": 1.0},
}  # fmt: skip


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_factors_of_the_units_of_a_quantity(quantity):
    expected = EXPECTED[quantity]
    factors = {text: unit.factor for text, unit in UNITS.items() if unit.quantity == quantity}
    assert set(factors) == set(expected)
    validated(
        "File readers", f"factors to {QUANTITIES[quantity]} of {', '.join(expected)}",
        np.array([factors[text] for text in expected]), np.array(list(expected.values())), rel=1e-12,
        source="foreign code: scipy, constants of CODATA and NIST SP 811",
    )  # fmt: skip
