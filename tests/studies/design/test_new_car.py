"""New cars: stated numbers are met, what is not stated follows its source, a car that cannot be is rejected by name."""

import json
import math
import re

import numpy as np
import pytest
import scipy

from tests.validation import validated
from vehicle.commands.new import main
from vehicle.engines.kinematics.axle_ride import axle_ride, axle_rides
from vehicle.engines.kinematics.ride_figures import ride_figures
from vehicle.engines.simulation.car_masses import car_masses
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car, Road
from vehicle.runs.car.inertia_survey import SURVEY, AxleGeometry
from vehicle.studies.design.stated_numbers import stated_numbers
from vehicle.studies.design.tyre_size import unloaded_radius

SEDAN = {
    "kerb-mass": 1652.9, "front-axle-load": 844.8, "cog-height": 0.4889, "wheelbase": 2.757, "track-front": 1.5,
    "track-rear": 1.499, "tyre-radius": 0.305, "ride-frequency-front": 1.385, "ride-frequency-rear": 1.39,
    "pitch-frequency": 1.456, "wheel-hop-front": 11.53, "wheel-hop-rear": 12.5, "damping-ratio-front": 0.4165,
    "damping-ratio-rear": 0.2441, "roll-stiffness-front": 1119.0, "roll-stiffness-rear": 703.2,
}  # fmt: skip
"""Numbers of the shipped sedan, rounded as a data sheet has them."""


def made(folder, *words, source="sedan"):
    """Run the command; return the printed checks and the car that is read from its file."""
    assert main([str(folder), "--from", str(source), "--json", *words]) == 0
    return Car.load(folder / "vehicle.toml")


def words(numbers):
    return [word for name, value in numbers.items() for word in (f"--{name}", str(value))]


def stated(**numbers):
    return stated_numbers(None, numbers)


@pytest.fixture(scope="module")
def compact(tmp_path_factory):
    """A car of seven numbers, far from the sedan."""
    numbers = {"kerb-mass": 1350, "front-axle-load": 820, "cog-height": 0.53, "wheelbase": 2.6, "track-front": 1.52,
               "track-rear": 1.48, "tyre-radius": 0.31, "ride-frequency-front": 1.2, "ride-frequency-rear": 1.4,
               "damping-ratio-front": 0.3}  # fmt: skip
    return made(tmp_path_factory.mktemp("new") / "compact", *words(numbers))


def test_masses_and_lengths_are_met(compact):
    """Closed form: axle loads m g b / L and m g a / L; all else is read from the model of the written file."""
    whole, loads = car_masses(compact.model), compact.static.tyre_load
    wheels = {wheel.name: wheel for wheel in compact.vehicle.composition.wheels}
    assert whole.mass == pytest.approx(1350.0, rel=1e-8)
    validated(
        "Static equilibrium", "new car of 1350 kg, 820 kg on its front axle: axle loads",
        np.array([loads["fr"] + loads["fl"], loads["rr"] + loads["rl"]]) / 9.81, np.array([820.0, 530.0]),
        source="closed form: the scales under the axles, statement of the user", rel=1e-3, unit="kg",
    )  # fmt: skip
    behind = whole.cog[0] - wheels["fr"].center[0]
    assert behind == pytest.approx(2.6 * 530.0 / 1350.0, rel=1e-6)
    assert whole.cog[2] - wheels["fr"].patch[2] == pytest.approx(0.53, abs=1e-6)
    assert wheels["rl"].center[0] - wheels["fl"].center[0] == pytest.approx(2.6, abs=1e-6)
    assert wheels["fr"].center[1] - wheels["fl"].center[1] == pytest.approx(1.52, abs=1e-6)
    assert wheels["rr"].center[1] - wheels["rl"].center[1] == pytest.approx(1.48, abs=1e-6)
    assert {round(wheel.center[2] - wheel.patch[2], 6) for wheel in wheels.values()} == {0.31}


def test_frequencies_are_met(compact):
    front, rear = (axle_ride(compact.model, axle) for axle in ("front", "rear"))
    validated(
        "Linear system", "new car of ride frequencies 1.2 and 1.4 Hz: ride frequencies of its model",
        np.array([front.ride_frequency, rear.ride_frequency]), np.array([1.2, 1.4]),
        source="closed form: statement of the user, sqrt(K_r / m_s) / 2 pi", rel=1e-2, unit="Hz",
    )  # fmt: skip
    assert front.damping_ratio == pytest.approx(0.3, rel=1e-3)
    # Not stated: the damping ratio of the template.
    assert rear.damping_ratio == pytest.approx(axle_ride(Car.load("sedan").model, "rear").damping_ratio, rel=1e-3)


@pytest.mark.parametrize("axle", ["front", "rear"])
def test_wheel_rate_and_unsprung_mass_follow_from_the_matrices_too(axle):
    """Second derivation: body and engine held in the matrices of the whole car, on tyres that roll."""
    ride = axle_ride(Car.load("sedan").model, axle)
    matrices = Car.load("sedan", {"driving.speed": 20.0}).matrices
    system, wheels = matrices.system, matrices.system.inputs
    sides = [index for index, wheel in enumerate(wheels) if wheel.startswith(axle[0])]
    tyres = matrices.tyre_rows.T * matrices.tyre_stiffness @ matrices.tyre_rows
    held = np.vstack([system.constraints, matrices.body_rows["body"], matrices.body_rows["engine"],
                      matrices.tyre_rows])  # fmt: skip
    travel = np.zeros(len(held))
    travel[len(held) - len(wheels) + np.array(sides)] = 1.0
    stiffness, free = system.stiffness - tyres, scipy.linalg.null_space(held)
    prescribed = np.linalg.lstsq(held, travel, rcond=None)[0]
    # Least squares: no stiffness opposes the rotation of a rolling wheel about its axle.
    motion = (
        prescribed - free @ np.linalg.lstsq(free.T @ stiffness @ free, free.T @ stiffness @ prescribed, rcond=1e-12)[0]
    )
    rate = float(motion @ stiffness @ motion) / 2.0
    # Mass that rises with the wheels: each body by the travel of its centre of gravity.
    rising = sum(matrices.body_masses[name][0, 0] * rows[2] @ motion for name, rows in matrices.body_rows.items())
    mass = float(rising) / 2.0
    validated(
        "Suspension kinematics", f"sedan, {axle} axle: wheel rate of the axle on rolling tyres", ride.wheel.stiffness,
        rate, source="second derivation: K of the whole car with body and engine held, statically condensed", rel=1e-4,
        unit="N/m",
    )  # fmt: skip
    assert ride.unsprung_mass == pytest.approx(mass, rel=1e-4)


def test_the_numbers_of_the_sedan_give_its_comfort(tmp_path, capsys):
    car = made(tmp_path / "same", *words(SEDAN))
    printed = json.loads(capsys.readouterr().out)
    checks, (parts, *_) = printed["checks"], printed["parts"]
    assert {"axles", "powertrain", "tyres"} <= {*parts.split(", ")}
    assert {name for name, check in checks.items() if check["stated"]} == {name.replace("-", "_") for name in SEDAN}
    assert max(abs(check["deviation"]) for check in checks.values()) < 1e-4
    road = Road("B", speed=80, duration=10)
    same, sedan = (one.run(road, engine="reduced").comfort().unweighted.overall for one in (car, Car.load("sedan")))
    validated(
        "Published cars", "sedan's numbers stated to `new`: comfort on a class B road at 80 km/h", same, sedan,
        source="second derivation: the shipped sedan", rel=0.03, unit="m/s2",
    )  # fmt: skip


def test_every_value_says_where_it_comes_from(compact):
    text = (compact.folder / "vehicle.toml").read_text()
    lines = [line for line in text.splitlines() if " = " in line and not line.startswith("#")]
    assert len(lines) > 100
    for line in lines:
        assert re.search(r"# \[[^\]]+\] .*(given|estimated|template sedan|rigid|products of|about the)", line), line
    assert "mass = 998.146039  # [kg] kerb mass 1350 kg (given), front axle load 820 kg (given), less 351.85 kg" in text
    assert "main_spring" in text and "from ride frequency front 1.2 Hz (given)" in text
    damping_ratio = axle_ride(Car.load("sedan").model, "rear").damping_ratio
    assert f"estimated: damping ratio rear of sedan, {damping_ratio:.4g}" in text


def test_a_numbers_file_a_damper_test_and_a_load(tmp_path, capsys):
    (tmp_path / "test.csv").write_text("velocity [m/s],force [N]\n-1,-900\n-0.1,-180\n0,0\n0.1,320\n1,1600\n")
    (tmp_path / "numbers.toml").write_text(
        'kerb_mass = 1500.0\ndamper_curve_front = "test.csv"\nwheel_hop_front = 12.5\n'
        '[load.driver]\nmass = 75.0\nat = "seat"\n'
    )
    numbers = ("--numbers", str(tmp_path / "numbers.toml"))
    car = made(tmp_path / "loaded", *numbers, "--pitch-frequency", "1.8", "--tyre-size", "205/45R16")
    assert car.vehicle.table["front"]["damper"]["force"] == [-900.0, -180.0, 0.0, 320.0, 1600.0]
    assert sum(car.static.tyre_load.values()) / 9.81 == pytest.approx(1575.0, rel=1e-6)
    figures = ride_figures(car.model, axle_rides(car.model))
    assert figures["pitch"].frequency_hz == pytest.approx(1.8, rel=1e-2)
    assert figures["front wheel hop"].frequency_hz == pytest.approx(12.5, rel=1e-2)
    said = json.loads(capsys.readouterr().out)
    assert said["checks"]["kerb_mass"]["value"] == pytest.approx(1500.0)
    assert any("205/45R16 sets the radius alone" in note for note in said["notes"])


def test_a_number_is_typed_or_of_the_file_and_an_axle_load_in_percent_is_a_share(tmp_path):
    file = tmp_path / "numbers.toml"
    file.write_text('kerb_mass = 1500.0\nwheelbase = 2.7\nfront_axle_load = "57%"\n')
    assert stated_numbers(file, {}).front_axle_load == pytest.approx(855.0, rel=1e-12)
    typed = stated_numbers(file, {"kerb_mass": 1400.0, "wheelbase": None})
    assert (typed.kerb_mass, typed.wheelbase) == (1400.0, 2.7)
    assert stated(kerb_mass=1000.0, rear_axle_load="43 %").rear_axle_load == pytest.approx(430.0)


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ("--kerb-mass 120", "--kerb-mass: .*0.0726, .*engine.parts.engine.mass"),
        ("--kerb-mass 1500 --front-axle-load 1800", "--front-axle-load: .*2.757"),
        ("--kerb-mass 1450 --front-axle-load 57", "57 kg: .*3.9 % .* 1450 kg .* 20 %; .*--front-axle-load 57%"),
        ("--rear-axle-load 43%", "--rear-axle-load 43%: .*--kerb-mass"),
        ("--front-axle-load many%", "'many%': .*57%"),
        ("--cog-height 550", "--cog-height: found 550.0 m, .* 1.5 .*0.44 to 0.85 m"),
        ("--damping-ratio-front 30", "front: found 30.0, .* 3.0 .*30 %"),
        ("--cog-x 3", "--cog-x: .* 3.000 m"),
        ("--kerb-mass 1500 --front-axle-load 800 --rear-axle-load 800", "1600 kg"),
        ("--ride-frequency-front 0.4", "0.4 Hz: .* 0.78.* to 3.4.* Hz.*front.main_spring"),
        ("--track-front 0.8", "--track-front 0.8 m: .* 0.826 m, .*front.hardpoints.tie_inner .*13 mm"),
        ("--roll-inertia 200", "I.*--yaw-inertia"),
        ("--wheel-hop-front 80", "--wheel-hop-front: found 80.0 Hz, .* 30.0"),
        ("--pitch-frequency 2 --pitch-inertia 3000", "--pitch-inertia: each follows from the other"),
        ("--tyre-size 205-55-16", "'205-55-16': .*205/55R16"),
        ("--tyre-size 205/55R99", "99 inch, .* 10 to 24"),
        ("--tyre-size 205/55R16 --tyre-radius 0.3", "--tyre-radius: the size gives the radius"),
        ("--damper-curve-front none.csv", "front.damper.curve: .*none.csv"),
    ],
)
def test_a_car_that_cannot_be_is_rejected_by_name(numbers, message, tmp_path, capsys):
    assert main([str(tmp_path / "bad"), "--from", "sedan", *numbers.split()]) == 2
    assert re.search(message, capsys.readouterr().err)
    assert not (tmp_path / "bad").exists()


def test_templates_without_four_wheels_and_names_of_shipped_cars_are_rejected(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for words, message in ((["mine", "--from", "focus"], "two axles"), (["sedan", "--from", "sedan"], "shipped car")):
        assert main(words) == 2
        assert message in capsys.readouterr().err


def test_estimates_are_inside_the_survey_for_a_measured_car():
    """BMW 320i of the CommonRoad vehicle models: m 1093.3 kg, a 1.156 m, b 1.423 m, I_z 1791.6 kg m2."""
    geometry = AxleGeometry(track=1.375, front=1.156196, rear=1.422717)
    indices = [index.mean for index in SURVEY.values()]
    yaw = SURVEY["k_z^2 / a b"]
    expected = 1791.599
    validated(
        "Published cars", "BMW 320i: yaw inertia estimated by the mean of 73 measured cars",
        geometry.inertia(1093.295, indices)[2], expected,
        source="publication: CommonRoad vehicle models 2017, parameters of vehicle 2; tolerance: range of the 73 cars",
        within=(expected * yaw.least / yaw.mean, expected * yaw.most / yaw.mean), unit="kg m2",
    )  # fmt: skip
    back = geometry.indices(1093.295, geometry.inertia(1093.295, indices))
    assert back == pytest.approx(indices, rel=1e-12)


@pytest.fixture(scope="module")
def surveyed(tmp_path_factory):
    """A car on tyres 205/55 R 16 with the moments of inertia of the survey."""
    folder = tmp_path_factory.mktemp("new") / "survey"
    sizes = ("--kerb-mass", "1500", "--front-axle-load", "850", "--tyre-size", "205/55 R 16 91V")
    return made(folder, "--inertia", "survey", *sizes)


def test_the_size_of_a_tyre_is_its_radius_without_load(surveyed):
    """By hand: half the rim of 16 inch, 203.2 mm, and a side wall of 0.55 205 = 112.75 mm (UN Regulation 30)."""
    wheels = {wheel.name: wheel for wheel in surveyed.vehicle.composition.wheels}
    deflection = 425.0 * 9.81 / surveyed["front.bushings.tyre.stiffness"].value[2]
    assert 0.015 < deflection < 0.025
    assert wheels["fl"].center[2] - wheels["fl"].patch[2] + deflection == pytest.approx(0.31595, abs=1e-5)

    assert unloaded_radius("215/65R16C 109/107T") == unloaded_radius("215/65R16") == pytest.approx(0.34295, abs=1e-6)
    # A truck: half of 17.5 inch, 222.25 mm, and 0.75 215 = 161.25 mm.
    assert unloaded_radius("215/75 R 17.5 C 126/124M") == pytest.approx(0.3835, abs=1e-6)


def test_a_new_car_has_the_step_that_it_needs_and_not_that_of_its_template(surveyed):
    """The step of the sedan, 1 ms, makes a creeping motion of a van of 2100 kg wrong by 12 %."""
    assert Car.load("sedan").vehicle.solver.timestep == 1e-3
    assert surveyed.vehicle.solver.timestep is None


def test_survey_inertia_is_that_of_the_whole_car(surveyed):
    car = surveyed
    whole, wheels = car_masses(car.model), {wheel.name: wheel for wheel in car.vehicle.composition.wheels}
    a = whole.cog[0] - wheels["fr"].center[0]
    b = wheels["rr"].center[0] - whole.cog[0]
    assert whole.inertia[1, 1] == pytest.approx(1.042 * 1500.0 * a * b, rel=1e-6)
    assert whole.inertia[2, 2] == pytest.approx(1.091 * 1500.0 * a * b, rel=1e-6)
    track = (1.500124 + 1.4986) / 2.0
    assert math.sqrt(whole.inertia[0, 0] / 1500.0) / track == pytest.approx(0.409, rel=1e-4)


def test_contradictions_are_found_before_any_computation():
    with pytest.raises(ConfigurationError, match="the curve sets the damping"):
        stated(damping_ratio_front=0.3, damper_curve_front="a.csv")
    with pytest.raises(ConfigurationError, match="did you mean kerb_mass"):
        stated(kerb_mas=3.0)


def test_a_template_that_brakes_is_taken_at_rest(tmp_path):
    """Under -4 m/s2 the front axle has 600 N more a wheel, and damping and springs would follow that load."""
    file = tmp_path / "braking.toml"
    file.write_text('base = "sedan"\nname = "braking"\n[driving]\nacceleration = -4.0\n')
    resting, braking = (
        made(tmp_path / f"from_{name}", "--kerb-mass", "1500", source=source)
        for name, source in (("sedan", "sedan"), ("braking", file))
    )
    assert not braking.vehicle.driving.accelerates
    assert braking.static.tyre_load == resting.static.tyre_load
    assert [damper.law for damper in braking.vehicle.composition.dampers] == [
        damper.law for damper in resting.vehicle.composition.dampers
    ]
