"""`python -m scenarios.inputs.section_fit`: the stored factors of the body design are the minimum of the fit."""

import numpy as np
import pytest

from scenarios.inputs.section_fit import fit_factors, main, residuals
from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.body_design import read_design
from vehicle.model.flexbody.body_frame import body_frame
from vehicle.model.flexbody.body_model import BODY_DESIGN
from vehicle.model.flexbody.node_masses import NodeProperties
from vehicle.model.parameters.vehicle import load_vehicle


@pytest.fixture(scope="module")
def frame():
    vehicle, design = load_vehicle(), read_design(BODY_DESIGN)
    return body_frame(design, vehicle.points, NodeProperties.of_body(vehicle.body, design.least_ixx))


def test_the_stored_factors_are_the_minimum_of_the_fit(frame):
    stored = frame.design.factors
    start = {group: factor * (1.1 if group in frame.design.fitted_groups else 1.0) for group, factor in stored.items()}
    fitted = fit_factors(frame, start, weights=(30.0,))
    best = np.sum(residuals(frame, fitted, 30.0) ** 2)
    # the objective has kinks, so a new search may end slightly off the stored factors, but not clearly lower
    assert np.sum(residuals(frame, stored, 30.0) ** 2) < best + 1.0
    np.testing.assert_allclose(frame.modes(fitted, 9)[0], frame.modes(stored, 9)[0], atol=0.3)


def test_a_fit_that_misses_says_so(frame):
    start = dict.fromkeys(frame.design.factors, 0.031)
    with pytest.raises(ConfigurationError, match="first, last and torsion frequency differ by"):
        fit_factors(frame, start, weights=())


def test_the_command_prints_lines_of_a_design(monkeypatch, capsys):
    """The fit takes minutes and is tested above; here a stub replaces it."""
    design = read_design(BODY_DESIGN)
    monkeypatch.setattr(
        "scenarios.inputs.section_fit.fit_factors", lambda frame, start, weights: dict.fromkeys(start, 1.23456789)
    )
    assert main([]) == 0
    assert capsys.readouterr().out.splitlines() == [f"members.{name}.factor = 1.2346" for name in design.fitted_groups]
