"""Density of the roads of the damper study: closed form of the bands."""

import itertools

import numpy as np
import pytest
from scipy.integrate import quad

from scenarios.lumped.damper_choice import ExponentialRoad, damper_choice_parameters
from scenarios.lumped.road_holding import band_amplitudes, exponential_density

HIGHWAY = ExponentialRoad(roughness=4.85e-4, decay=0.19)


def test_band_amplitudes_are_the_roots_of_the_integrals():
    edges = np.array([0.0, 0.5, 2.0, 10.0])
    expected = [np.sqrt(quad(lambda f: 4.85e-4 * np.exp(-0.19 * f), a, b)[0]) for a, b in itertools.pairwise(edges)]
    np.testing.assert_allclose(band_amplitudes(HIGHWAY, edges), expected, rtol=1e-12)


def test_shipped_roads_are_those_of_table_1():
    parameters = damper_choice_parameters()
    assert exponential_density(parameters.highway, 0.0) == 4.85e-4
    assert exponential_density(parameters.city, 1.0) == pytest.approx(23.0244e-4 * np.exp(-0.213))
