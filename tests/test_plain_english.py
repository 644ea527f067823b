"""The sources stay as plain as they are: rates of private phrases and vague names may fall, and must not rise."""

from __future__ import annotations

import importlib.util
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]

LIMITS = {
    "vehicle": (3.5, 0.8, 4.5, 1.1),
    "scenarios": (1.6, 1.8, 0.5, 1.5),
}
"""Highest rates of a folder, in the order of `rates` of `tools/plainness.py`; lower them after an improvement."""


@pytest.fixture
def plainness():
    specification = importlib.util.spec_from_file_location("plainness", ROOT / "tools" / "plainness.py")
    assert specification is not None and specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def rates_of(plainness, paths):
    plainness.WORDS.clear()
    total: Counter[str] = Counter()
    for path in paths:
        counts, _ = plainness.examine(path)
        total += counts
    return plainness.rates(total)


@pytest.mark.parametrize("folder", LIMITS)
def test_rates_do_not_rise(plainness, folder):
    rates = rates_of(plainness, sorted((ROOT / folder).rglob("*.py")))
    above = {name: value for (name, value), limit in zip(rates.items(), LIMITS[folder], strict=True) if value > limit}
    assert above == {}, f"run: python tools/plainness.py {folder} --list 20"


def test_private_phrases_are_counted(plainness, tmp_path):
    file = tmp_path / "a.py"
    file.write_text(
        'def f(found):\n    """What each one of them answers, as of `g`."""\n    one = found\n    return one\n'
    )
    rates = rates_of(plainness, [file])
    assert all(value > 0.0 for name, value in rates.items() if "verb" not in name)
    file.write_text('def f(mass):\n    """Return the weight of a mass [N]."""\n    return 9.81 * mass\n')
    assert not any(rates_of(plainness, [file]).values())
