"""Units of bodies: consistent units, rejected units, and the option named in the message."""

from dataclasses import replace

import numpy as np
import pytest

from vehicle.engines.simulation.standing import require_body_modes
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.flexbody.mass_difference import require_unit_of_mass, vehicle_lines
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.sources.body_units import require_first_mode, require_level, require_mass, units_of
from vehicle.runs.car import Car

NEWTON = {("m", "kg"): 1.0, ("mm", "t"): 1.0, ("in", "lbf s2/in"): 4.4482216152605}
"""Unit of force by those of length and mass [N]; a pound-force is 0.45359237 kg times 9.80665 m/s2."""


@pytest.mark.parametrize("length", ["m", "mm", "in"])
def test_the_mass_follows_from_the_length_in_consistent_units(length):
    units = units_of(length, None)
    size, mass = units.sizes
    assert mass * size == pytest.approx(NEWTON[length, units.mass], rel=1e-8)
    assert "follows" in units.words and "as stated" in units_of(length, "kg").words
    assert units_of(None, None).length == "m"


@pytest.mark.parametrize(("mass", "length", "unit", "says"), [
    (0.81, "mm", "kg", 'Set --mass-unit "t"'),
    (0.81, "m", None, 'Set --mass-unit "t"'),
    (813e3, "mm", None, 'Set --mass-unit "kg"'),
    (813e6, "mm", None, 'Set --mass-unit "g"'),
    (1e11, "m", "kg", "Check the mass matrix"),
    (813.0 / 0.45 * 175.0, "in", None, 'Set --mass-unit "kg"'),
])  # fmt: skip
def test_another_unit_of_mass_is_refused_with_its_option(mass, length, unit, says):
    with pytest.raises(DataError, match=r"unit of mass is wrong|units of mass differ") as caught:
        require_mass(mass, 813.0, units_of(length, unit))
    assert says in str(caught.value)


def test_the_scale_of_shapes_tells_the_unit_of_mass():
    """A rigid translation of 813 kg with modal mass 1, too large by factors about the fourth root of 1000, 5.6."""
    shape = np.tile([0.0, 0.0, 813.0**-0.5], 10)[:, None]
    for factor in (1.0, 5.0, 1.0 / 5.0):
        require_level(factor * shape, np.ones(1), 813.0, units_of(None, "kg"))
    for factor in (6.5, 1.0 / 6.5):
        with pytest.raises(DataError, match=r"unit of mass is wrong|units of mass differ"):
            require_level(factor * shape, np.ones(1), 813.0, units_of(None, "kg"))


def test_mass_properties_of_parts_are_those_of_all_points():
    generator = np.random.default_rng(5)
    masses, places = generator.uniform(1.0, 9.0, 12), generator.standard_normal((12, 3))
    whole, some = MassProperties.of_points(masses, places), MassProperties.of_points(masses[:7], places[:7])
    for found, wanted in (
        (some.with_points(masses[7:], places[7:]), whole),
        (whole.without(MassProperties.of_points(masses[7:], places[7:])), some),
    ):
        assert found.mass == pytest.approx(wanted.mass)
        np.testing.assert_allclose(found.cog, wanted.cog, atol=1e-12)
        np.testing.assert_allclose(found.inertia, wanted.inertia, rtol=1e-9, atol=1e-9)


def test_other_bodies_pass():
    for mass in (300.0, 813.0, 12e3):
        require_mass(mass, 813.0, units_of(None, None))
    require_first_mode(12.0, units_of("mm", None))


@pytest.mark.parametrize("frequency", [25.0 / 31.6, 25.0 * 31.6])
def test_stiffness_and_mass_of_two_systems_are_refused(frequency):
    with pytest.raises(DataError, match="K in N/mm needs M in t"):
        require_first_mode(frequency, units_of("mm", "kg"))


def test_a_stored_body_of_another_unit_is_refused_by_its_mass_and_not_by_the_scale_of_its_modes():
    car = Car.load()
    model, vehicle = car.trimmed_body, car.vehicle
    require_unit_of_mass(model, vehicle.body)
    rigid = MassProperties(mass=1e-3 * model.mass, cog=model.cog, inertia=1e-3 * model.inertia)
    light = replace(model, node_mass=None, mass_properties=rigid, derived=True)
    with pytest.raises(DataError, match="Import the model again with --mass-unit"):
        require_unit_of_mass(light, vehicle.body)
    soft = replace(model, frequencies=0.03 * model.frequencies, derived=True)
    with pytest.raises(ConfigurationError, match=r"^body\.superelement = .*check the units") as caught:
        require_body_modes(vehicle, soft)
    assert "frequency_scale" not in str(caught.value)


def test_round_off_of_a_symmetric_body_is_zero():
    model = Car.load().trimmed_body
    cog = np.array([model.cog[0], 1.4051e-13, model.cog[2]])
    noisy = replace(
        model,
        node_mass=None,
        mass_properties=MassProperties(mass=model.mass, cog=cog, inertia=np.diag([180.0, 670.0, 820.0])),
        derived=True,
    )
    lines = vehicle_lines(noisy)
    assert not any("e-" in line for line in lines)
    assert "0," in next(line for line in lines if line.startswith("cog"))
