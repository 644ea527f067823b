"""Dampers of drawn cars: the factor is the ratio of forces at 0.13 m/s, and all have the slope of the poles."""

import numpy as np
import pytest

from vehicle import Car
from vehicle.errors import ConfigurationError
from vehicle.model.laws.damper import damper_curve
from vehicle.studies.diagnosis.damper_force import REFERENCE_VELOCITY, drawn_damper, outer_slope, require_passive


@pytest.fixture(scope="module")
def laws():
    return {damper.name: damper.law for damper in Car.load("sedan").vehicle.composition.dampers}


@pytest.mark.parametrize("name", ["damper_fl", "damper_rl"])
@pytest.mark.parametrize(("factor", "bend", "rebound"), [(1.0, 0.0, 1.0), (0.3, 0.2, 1.2), (1.2, -0.2, 0.85)])
def test_the_factor_is_the_mean_ratio_of_forces_at_the_reference(laws, name, factor, bend, rebound):
    nominal, drawn = (damper_curve(law) for law in (laws[name], drawn_damper(laws[name], factor, bend, rebound, 1.0)))
    ratios = [drawn.force(v) / nominal.force(v) for v in (-REFERENCE_VELOCITY, REFERENCE_VELOCITY)]
    # Straight lines between velocities a factor 1.9 apart miss |v|^1.2 by up to 1 %, the table of the front by 3 %.
    assert np.sqrt(np.prod(ratios)) == pytest.approx(factor, rel=0.04)
    assert ratios[1] / ratios[0] == pytest.approx(rebound, rel=1e-6)
    assert drawn.least_slope == pytest.approx(outer_slope(laws[name]), rel=1e-9)


def test_a_linear_damper_stays_linear(laws):
    nominal = damper_curve(laws["damper_rl"])
    drawn = damper_curve(drawn_damper(laws["damper_rl"], 0.5, 0.0, 1.0, 1.0))
    v = np.linspace(-2.9, 2.9, 31)
    assert drawn.force(v) == pytest.approx(0.5 * nominal.force(v), rel=1e-9, abs=1e-9)


def test_controlled_dampers_are_refused():
    car = Car.load("focus_road", ["front.damper.control.law=skyhook"])
    with pytest.raises(ConfigurationError, match=r"front\..*damper is controlled"):
        require_passive(car.vehicle.composition)
