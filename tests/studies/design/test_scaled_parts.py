"""Parts of a new car scaled by its mass, classes of cars, and the interval that a number can reach."""

import re

import pytest

from tests.validation import validated
from vehicle.commands.new import main
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car
from vehicle.studies.design.car_class import CLASSES
from vehicle.studies.design.new_car import NewCar, new_car
from vehicle.studies.design.stated_numbers import StatedNumbers


def unusual(result: NewCar) -> list[str]:
    """Return the notes on figures outside their usual ranges."""
    return [note for note in result.notes if note.startswith("unusual")]


@pytest.mark.parametrize("mass", [900.0, 2500.0])
def test_a_car_of_any_mass_has_parts_of_its_size(mass):
    result = new_car("one", "sedan", StatedNumbers(kerb_mass=mass))
    assert unusual(result) == []
    data, sedan = result.car.show(), Car.load("sedan").show()
    assert [figure for figure in data.usual if figure.unusual] == []
    ratio = mass / sedan.mass_kg
    validated(
        "Published cars", f"new car of {mass:g} kg from sedan: unsprung mass", data.unsprung_kg,
        ratio * sedan.unsprung_kg, rel=1e-3, unit="kg", source="closed form: m_u / m as in the template",
    )  # fmt: skip
    for axle, template in zip(data.axles, sedan.axles, strict=True):
        # Deflection of the tyre in proportion to its size: m g / k with k as m^(2/3).
        assert axle.tyre_n_per_m == pytest.approx(template.tyre_n_per_m * ratio ** (2.0 / 3.0), rel=1e-3)
        assert axle.ride_frequency_hz == pytest.approx(template.ride_frequency_hz, rel=1e-3)
    table = result.car.vehicle.table
    assert table["engine"]["parts"]["engine"]["mass"] == pytest.approx(220.0 * ratio, rel=1e-3)
    if ratio != 1.0:
        assert re.search(r"mass = .*# \[kg\] value from template sedan times [0-9.]+,", result.text)


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_alone_makes_a_car_without_unusual_figures(name):
    result = new_car("one", "sedan", StatedNumbers(car_class=name))
    assert unusual(result) == []
    values = {check.name: check.value for check in result.checks}
    for number in ("kerb_mass", "cog_height", "wheelbase", "tyre_radius", "ride_frequency_front"):
        assert values[number] == pytest.approx(CLASSES[name][number], rel=1e-3)
    assert values["front_axle_load"] == pytest.approx(CLASSES[name]["front_share"] * values["kerb_mass"], rel=1e-3)
    assert f"kerb mass {CLASSES[name]['kerb_mass']:g} kg (class {name})" in result.text


def test_an_electric_car_has_no_engine_on_hydromounts():
    car = new_car("one", "sedan", StatedNumbers(car_class="electric-suv")).car
    engine = car.vehicle.table["engine"]
    assert engine["template"] == "electric_drive" and set(engine["bushings"]) == {
        "right_mount", "left_mount", "rear_mount"}  # fmt: skip
    assert engine["parts"]["engine"]["mass"] == 105.0  # not scaled: that of the class
    rigid = [mode for mode in car.modes("sliding") if mode.energy["engine"] > 0.5]
    assert len(rigid) == 6 and all(8.0 < mode.frequency < 20.0 for mode in rigid)


def test_stated_numbers_precede_those_of_the_class():
    stated = StatedNumbers(car_class="small", kerb_mass=1050.0, front_axle_load=640.0)
    result = new_car("one", "sedan", stated)
    values = {check.name: check.value for check in result.checks}
    names: dict[str, set[str]] = {}
    for check in result.checks:
        names.setdefault(check.origin, set()).add(check.name)
    axles = [f"{name}_{axle}" for name in ("ride_frequency", "track") for axle in ("front", "rear")]
    assert names == {
        "": {"kerb_mass", "front_axle_load"},
        "class small": {*axles, "wheelbase", "cog_height", "tyre_radius"},
        "sedan": {"damping_ratio_front", "damping_ratio_rear"},
        "sedan, parts scaled with the kerb mass": {
            f"{name}_{axle}" for name in ("wheel_hop", "roll_stiffness") for axle in ("front", "rear")
        },
        "sedan, same radius of gyration": {"roll_inertia", "pitch_inertia", "yaw_inertia"},
        "the other numbers": {"rear_axle_load", "cog_x", "pitch_frequency"},
    }
    assert values["kerb_mass"] == pytest.approx(1050.0) and values["front_axle_load"] == pytest.approx(640.0, rel=1e-3)
    with pytest.raises(ConfigurationError, match=r"--car-class 'bus': .*small, sedan, van"):
        new_car("one", "sedan", StatedNumbers(car_class="bus"))


def test_a_template_or_a_class_is_needed(tmp_path, capsys):
    assert main([str(tmp_path / "mine"), "--kerb-mass", "1000"]) == 2
    said = capsys.readouterr().err
    assert "--from sedan" in said and "--car-class" in said


def test_an_unusual_figure_of_the_template_is_named():
    result = new_car("one", "kinematic_reference", StatedNumbers(kerb_mass=900.0))
    (caster,) = [note for note in unusual(result) if "caster [deg]" in note]
    assert re.search(r"front: caster \[deg\] 11\.04, .*1 to 9.*template kinematic_reference$", caster)
    (stated,) = unusual(new_car("one", "sedan", StatedNumbers(tyre_radius=0.45)))[:1]
    assert re.search(r"loaded tyre radius \[mm\] 450, .*240 to 400.*tyre radius 0\.45 m \(given\)$", stated)
    # A ride frequency follows from the stated wheel rate, its other form.
    stiff = unusual(new_car("one", "sedan", StatedNumbers(wheel_rate_front=6e4)))
    (frequency,) = [note for note in stiff if "front: ride frequency" in note]
    assert frequency.endswith("follows from wheel rate front 60000 N/m (given)")


def test_a_refused_hop_says_what_can_be_reached():
    """Both ends of the interval are cars; the message has no iterate that nobody typed.

    A hop below the interval is refused by the page docs/howto/new.md.
    """
    with pytest.raises(ConfigurationError) as caught:
        new_car("one", "sedan", StatedNumbers(wheel_hop_rear=25.0))
    found = re.match(
        r"--wheel-hop-rear 25 Hz: .* ([0-9.]+) to ([0-9.]+) Hz, with rear.bushings.tyre.stiffness.z from ([0-9.e+]+) "
        r"to ([0-9.e+]+) N/m \(static deflection of 50 to 6 mm\)",
        str(caught.value),
    )
    assert found, str(caught.value)
    low, high, softest, stiffest = map(float, found.groups())
    load = sum(Car.load("sedan").static.tyre_load[wheel] for wheel in ("rr", "rl")) / 2.0
    assert (load / softest, load / stiffest) == pytest.approx((0.05, 0.006), rel=1e-3)
    for end in (low * 1.01, high * 0.99):
        made = new_car("one", "sedan", StatedNumbers(wheel_hop_rear=end))
        (value,) = (check.value for check in made.checks if check.name == "wheel_hop_rear")
        assert value == pytest.approx(end, rel=1e-2)
