"""Numbers for people: significant digits without an exponent, in every text of the package."""

import re
from pathlib import Path

import pytest

from vehicle.digits import beside_limit, number

PACKAGE = Path(__file__).resolve().parents[1] / "vehicle"

FEW = re.compile(r"(float\(f\")?\{[^{}]*:[^{}]*\.[12]g\}")
"""One or two digits in a format, which writes 100 as 1e+02; a value that is only rounded, float(f"..."), is no text."""


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (100.0, 1, "100"),
        (96.0, 1, "100"),
        (1234.0, 2, "1200"),
        (0.01234, 2, "0.012"),
        (-3.46, 2, "-3.5"),
        (None, 2, "–"),
    ],
)
def test_digits_without_an_exponent(value, digits, text):
    assert number(value, digits) == text


@pytest.mark.parametrize(
    ("value", "limit", "shown"),
    [
        (0.1503, 0.15, ("0.1503", "0.15")),
        (-0.1503, 0.15, ("-0.1503", "0.15")),
        (0.3, 0.15, ("0.3", "0.15")),
        (2.8649, 2.86479, ("2.8649", "2.8648")),
        (123456.0, 1000.0, ("123000", "1000")),
        (0.15, 0.15, ("0.15", "0.15")),
    ],
)
def test_a_value_beside_its_limit_differs_from_it(value, limit, shown):
    assert beside_limit(value, limit) == shown


def test_no_text_of_the_package_has_one_or_two_digits_with_an_exponent():
    files = [path for path in PACKAGE.rglob("*.py") if path.name != "digits.py"]
    assert len(files) > 300
    found = [
        f"{path.relative_to(PACKAGE)}: {match[0]}"
        for path in files
        for match in FEW.finditer(path.read_text(encoding="utf-8"))
        if not match[1]
    ]
    assert found == []
