"""Rainflow counts: the example of the standard, sine loads in closed form, and the sentence without the package."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError, MissingPartError
from vehicle.signals.analysis.load_spectrum import Cycles, count_cycles


def test_the_example_of_the_standard():
    """ASTM E1049-85 (2017), figure 6 and table X1: -2 1 -3 5 -1 3 -4 4 -2."""
    pytest.importorskip("rainflow")
    found = count_cycles([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
    table = {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}
    astm = "standard: ASTM E1049-85 (2017), figure 6 and table X1"
    validated("Load histories", "ranges of the rainflow example", found.ranges, np.array(list(table)), source=astm)
    validated(
        "Load histories", "counts of the rainflow example", found.counts, np.array(list(table.values())), source=astm,
    )  # fmt: skip
    assert found.total == 4.0
    assert found.exceeded().tolist() == [4.0, 3.5, 2.0, 1.5, 0.5]


def test_cycles_of_a_sine_on_a_slow_sine():
    """A fast sine of amplitude a on a slow one of amplitude A: one of 2 (A + a) for each slow cycle."""
    pytest.importorskip("rainflow")
    time = np.arange(0.0, 10.0, 1e-3)
    # The crests meet: cos is 1 for both at the beginning of each slow cycle.
    load = 7.0 + 10.0 * np.cos(2 * np.pi * time) + 0.5 * np.cos(2 * np.pi * 50 * time)
    found = count_cycles(load)
    large = found.counts[found.ranges > 15.0].sum()
    assert large == pytest.approx(10.0, abs=0.5)
    validated(
        "Load histories", "largest range of a fast sine on a slow one", found.ranges[-1], 21.0, rel=1e-2,
        source="closed form: 2 (A + a)",
    )  # fmt: skip
    # Without slope of the slow one the small ones have a range of 1; 490 are left where the crests close.
    validated(
        "Load histories", "cycles of a fast sine on a slow one", found.total, 500.0, abs=1.0,
        source="closed form: 50 Hz for 10 s",
    )  # fmt: skip


@pytest.mark.parametrize("slope", [1.0, 5.0, 300.0])
def test_equivalent_amplitude_in_closed_form(slope):
    # n cycles in n seconds are worth their own amplitude; so are none but these in four times the time, times 4^(-1/k).
    sine = Cycles(ranges=np.array([600.0]), counts=np.array([25.0]))
    assert sine.equivalent_amplitude(slope, 25.0) == pytest.approx(300.0)
    validated(
        "Load histories", f"equivalent amplitude of a sine at 1 Hz in four times the time, slope {slope:g}",
        sine.equivalent_amplitude(slope, 100.0), 300.0 * 4.0 ** (-1.0 / slope), rel=1e-6, unit="N",
        source="closed form: Miner, (sum n a^k / N)^(1/k)",
    )  # fmt: skip
    two = Cycles(ranges=np.array([2.0, 4.0]), counts=np.array([3.0, 0.5]))
    validated(
        "Load histories", f"equivalent amplitude of two ranges, slope {slope:g}", two.equivalent_amplitude(slope, 2.0),
        2.0 * ((3.0 * 0.5**slope + 0.5) / 2.0) ** (1.0 / slope), rel=1e-6, unit="N",
        source="closed form: Miner, (sum n a^k / N)^(1/k)",
    )  # fmt: skip
    assert Cycles(ranges=np.zeros(0), counts=np.zeros(0)).equivalent_amplitude(slope, 1.0) == 0.0


def test_a_load_that_does_not_change_has_no_cycle():
    pytest.importorskip("rainflow")
    assert count_cycles(np.full(9, 3.0)).total == 0.0


def test_bad_numbers_are_refused():
    with pytest.raises(ConfigurationError, match=r"found slope 0\.5"):
        Cycles(ranges=np.ones(1), counts=np.ones(1)).equivalent_amplitude(0.5, 1.0)


def test_a_missing_package_is_named(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "rainflow", None)
    with pytest.raises(MissingPartError, match="the Python package rainflow is missing"):
        count_cycles([0.0, 1.0, 0.0])
