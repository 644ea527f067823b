"""Start values of laws from laws with one part more."""

import numpy as np
import pytest

from vehicle.studies.dampers.damper_fit import DamperFit
from vehicle.studies.dampers.damper_law import DamperLaw
from vehicle.studies.dampers.damper_starts import starts_from_larger, without_bend

LARGE = [
    DamperLaw(bends=3, own_sides=True, friction="stribeck", series=True, gap=True, gas_stiffness=True),
    DamperLaw(bends=1, friction="presliding", elements=3, series=True, setting="saturating", delayed=True),
    DamperLaw(friction="presliding", elements=1),
]


def test_a_segment_between_two_bends_ends_at_the_same_force():
    slopes, widths = without_bend([6000.0, 3000.0, 900.0], [0.05, 0.04], 0)
    assert widths == pytest.approx([0.09]) and slopes[0] * widths[0] == pytest.approx(6000.0 * 0.05 + 3000.0 * 0.04)
    assert slopes[1] == 900.0
    slopes, widths = without_bend([6000.0, 3000.0, 900.0], [0.05, 0.04], 1)
    assert (slopes[0], widths) == (6000.0, [0.05]) and slopes[1] == pytest.approx(np.sqrt(3000.0 * 900.0))


@pytest.mark.parametrize("law", LARGE, ids=lambda law: law.title)
def test_each_smaller_law_starts_from_the_values_of_the_larger(law):
    """A part less means fewer parameters, and those of parts that remain keep their values."""
    values = np.arange(1.0, len(law.parameters) + 1.0)
    fit = DamperFit(law=law, parameters=values)
    known = dict(zip(law.parameters, values.tolist(), strict=True))
    smaller = list(law.smaller())
    assert len(smaller) >= 2
    for each in smaller:
        assert len(each.parameters) <= len(law.parameters) and each != law
        starts = starts_from_larger(each, fit)
        assert starts and all(start.size == len(each.parameters) for start in starts)
        for name in ("gas_force", "series_stiffness", "lag", "gap"):
            if name in each.parameters:
                assert all(start[list(each.parameters).index(name)] == known[name] for start in starts), name
