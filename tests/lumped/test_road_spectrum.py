"""Road densities: closed form of the bands, classes of ISO 8608."""

import itertools

import numpy as np
import pytest
from scipy.integrate import quad

from vehicle.errors import ConfigurationError
from vehicle.lumped.road_spectrum import ROAD_CLASSES, band_amplitudes, exponential_density, iso_8608_density
from vehicle.parameters.damper_choice import ExponentialRoad, damper_choice_parameters

HIGHWAY = ExponentialRoad(roughness=4.85e-4, decay=0.19)


def test_band_amplitudes_are_the_roots_of_the_integrals():
    edges = np.array([0.0, 0.5, 2.0, 10.0])
    expected = [np.sqrt(quad(lambda f: 4.85e-4 * np.exp(-0.19 * f), a, b)[0]) for a, b in itertools.pairwise(edges)]
    np.testing.assert_allclose(band_amplitudes(HIGHWAY, edges), expected, rtol=1e-12)


def test_bands_add_up_in_square():
    whole = band_amplitudes(HIGHWAY, [0.0, 25.0])[0]
    parts = band_amplitudes(HIGHWAY, np.arange(26.0))
    assert np.sqrt(np.sum(parts**2)) == pytest.approx(whole, rel=1e-12)


def test_shipped_roads_are_those_of_table_1():
    parameters = damper_choice_parameters()
    assert exponential_density(parameters.highway, 0.0) == 4.85e-4
    assert exponential_density(parameters.city, 1.0) == pytest.approx(23.0244e-4 * np.exp(-0.213))


def test_class_a_at_the_reference_wavenumber():
    # ISO 8608 table C.1: Gd(n0) = 16e-6 m3 at n0 = 0.1 cycles/m; at 20 m/s that is 2 Hz, and G(f) = Gd / v
    assert iso_8608_density("A", 20.0, 2.0) == pytest.approx(16e-6 / 20.0, rel=1e-12)
    assert iso_8608_density("H", 20.0, 2.0) == pytest.approx(262144e-6 / 20.0, rel=1e-12)


def test_displacement_variance_does_not_depend_on_speed():
    """The same stretch of wavelengths has the same RMS at any speed."""

    def variance(speed):
        return quad(lambda f: float(iso_8608_density("C", speed, f)), 0.05 * speed, 2.0 * speed)[0]

    assert variance(10.0) == pytest.approx(variance(35.0), rel=1e-9)


def test_each_class_has_four_times_the_density():
    values = [float(iso_8608_density(name, 20.0, 3.0)) for name in ROAD_CLASSES]
    np.testing.assert_allclose(np.divide(values[1:], values[:-1]), 4.0, rtol=1e-12)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("I", 20.0, 1.0), "road class: found 'I', allowed are A, B, C, D, E, F, G, H"),
        (("AB", 20.0, 1.0), "road class: found 'AB', allowed are A, B, C, D, E, F, G, H"),
        (("A", 0.0, 1.0), "road: speed: found 0.0 m/s, must be greater than 0.0"),
        (("A", 20.0, 0.0), "road: frequency: must be finite numbers greater than 0.0 Hz"),
    ],
)
def test_bad_values_are_refused(arguments, message):
    with pytest.raises(ConfigurationError) as caught:
        iso_8608_density(*arguments)
    assert str(caught.value) == message
