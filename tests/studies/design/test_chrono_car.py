"""A car of Project Chrono: masses, laws and tyres from its files, what is left out, both engines, wrong files."""

import json
import re

import numpy as np
import pytest

from tests.chrono_files import CHASSIS, FIALA, FILES, SPINDLE, TMEASY, WHEEL, WISHBONE, write_chrono
from vehicle import Car
from vehicle.commands.new import main
from vehicle.errors import VehicleError
from vehicle.model.parameters.parameter_list import parameter_list
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.design.chrono_car import chrono_car


def imported(folder, name="wishbone_car", tyre="tmeasy", changes=None):
    files = write_chrono(folder, changes)
    return chrono_car("small", files / f"{name}.json", tyre and files / f"{tyre}.json")


@pytest.fixture(scope="module")
def wishbones(tmp_path_factory):
    return imported(tmp_path_factory.mktemp("wishbones"))


@pytest.fixture(scope="module")
def struts(tmp_path_factory):
    return imported(tmp_path_factory.mktemp("struts"), "strut_car")


def sides(point):
    return [np.array(point), np.array(point) * (1.0, -1.0, 1.0)]


def test_mass_and_centre_of_gravity_are_those_of_the_files(wishbones):
    masses, moments = 0.0, np.zeros(3)
    for part in CHASSIS["Components"]:
        masses += part["Mass"]
        moments += part["Mass"] * np.array(part["Centroidal Frame"]["Location"])
    for axle in FILES["wishbone_car"]["Axles"]:
        at = np.array(axle["Suspension Location"])
        for name in ("Spindle", "Upright", "Upper Control Arm", "Lower Control Arm"):
            for point in sides(WISHBONE[name]["COM"]):
                masses += WISHBONE[name]["Mass"]
                moments += WISHBONE[name]["Mass"] * (at + point)
        for point in sides(SPINDLE["COM"]):
            wheel = WHEEL["Mass"] + TMEASY["Design"]["Mass [kg]"]
            masses += wheel
            moments += wheel * (at + point)
    whole = wishbones.car.matrices
    mass = sum(whole.body_masses[body][0, 0] for body in whole.body_centres)
    cog = sum(whole.body_masses[body][0, 0] * np.array(at) for body, at in whole.body_centres.items()) / mass
    assert mass == pytest.approx(masses, rel=1e-8)
    expected = moments / masses
    front = np.array(FILES["wishbone_car"]["Axles"][0]["Suspension Location"]) + SPINDLE["COM"]
    centre = np.array(wishbones.car.vehicle.points["wheel_center_fr"])
    # Chrono: x forward, y left; here x to the rear, y right. Small parts sit at points of the parts that carry them.
    assert cog - centre * (1, 0, 1) == pytest.approx((expected - front * (1, 0, 1)) * (-1, -1, 1), abs=1e-3)
    assert cog[1] == pytest.approx(-expected[1], abs=1e-6)


def test_inertia_of_the_chassis_is_that_of_its_components(wishbones):
    body = wishbones.car.vehicle.table["body"]
    first, second = CHASSIS["Components"]
    masses, places = (np.array([part[key] for part in (first, second)]) for key in ("Mass", "Mass"))
    places = np.array([part["Centroidal Frame"]["Location"] for part in (first, second)])
    cog = masses @ places / masses.sum()
    # The second component is turned by 90 degrees about z: its moments about x and y change places.
    tensors = [np.diag(first["Moments of Inertia"]).astype(float), np.diag([6.0, 9.0, 8.0])]
    xy, xz, yz = first["Products of Inertia"]
    tensors[0] += np.array([[0, xy, xz], [xy, 0, yz], [xz, yz, 0]])
    whole = sum(
        t + m * (r @ r * np.eye(3) - np.outer(r, r)) for t, m, r in zip(tensors, masses, places - cog, strict=True)
    )
    assert [body["inertia"][key] for key in ("ixx", "iyy", "izz")] == pytest.approx(np.diag(whole), rel=1e-8)
    # A turn by 180 degrees about z keeps xy and reverses zx and yz; the file has integrals: minus the elements.
    expected = [-whole[0, 1], whole[0, 2], whole[1, 2]]
    assert [body["inertia"][key] for key in ("ixy", "izx", "iyz")] == pytest.approx(expected, rel=1e-7)


def test_inertia_of_an_arm_is_turned_from_its_plane(wishbones):
    part = wishbones.car.vehicle.table["front"]["parts"]["lower_arm"]
    arm = WISHBONE["Lower Control Arm"]
    front, back, ball = (np.array(arm[f"Location {end}"]) for end in ("Chassis Front", "Chassis Back", "Upright"))
    normal = np.cross(back - ball, front - ball)
    x, z = (front - back) / np.linalg.norm(front - back), normal / np.linalg.norm(normal)
    axes = np.array([x, np.cross(z, x), z])
    expected = sum(moment * np.outer(axis, axis) for moment, axis in zip([0.05, 0.04, 0.085], axes, strict=True))
    expected += 0.001 * (np.outer(axes[0], axes[1]) + np.outer(axes[1], axes[0]))
    # The right side here is the left one there with x reversed.
    assert part["inertia"] == pytest.approx(np.diag(expected), rel=1e-7)
    assert part["products"] == pytest.approx([expected[0, 1], expected[0, 2], -expected[1, 2]], rel=1e-6)


def test_laws_of_spring_and_damper(struts):
    front = struts.car.vehicle.table["front"]
    assert front["main_spring"]["table"]["force"][0] == -9000
    v, force = (np.array(front["damper"][key]) for key in ("velocity", "force"))
    assert force == pytest.approx(4000 * v / (1 + np.where(v < 0, 2.0, 0.5) * np.abs(v)), rel=1e-7)
    fine = np.linspace(-2, 2, 401)
    law = 4000 * fine / (1 + np.where(fine < 0, 2.0, 0.5) * np.abs(fine))
    assert np.interp(fine, v, force) == pytest.approx(law, rel=0.03, abs=2.0)
    assert struts.car.vehicle.table["rear"]["damper"]["viscous"] == 3500.0


def test_a_tmeasy_tyre_of_a_load_index_is_that_of_chrono(wishbones):
    table, static = wishbones.car.vehicle.table["front"], wishbones.car.model.static
    tyre = table["bushings"]["tyre"]
    load, largest = static.tyre_load["fr"], 615 * 9.81  # load index 91
    stiffness = largest / (0.16 * (0.31 - 0.19))
    assert tyre["stiffness"][2] == pytest.approx(stiffness)
    assert tyre["damping"][2] == pytest.approx(np.sqrt(stiffness * 9.0))
    q = load / (0.5 * largest)
    assert 0.5 < q < 1.5
    # Chrono's InterpQ, a parabola through 0, P_N and 2 P_N.
    parabola = np.polynomial.Polynomial.fit([0, 1, 2], [0, 15.9826 * 0.5 * largest, 12.8509 * largest], 2)
    assert tyre["cornering_stiffness"] == pytest.approx(parabola(q), rel=5e-3)
    radius = table["hardpoints"]["wheel_center"][2] - table["hardpoints"]["tyre_patch"][2]
    assert radius == pytest.approx(0.31 - load / stiffness, abs=1e-4)


def test_a_fiala_tyre_has_the_slope_at_its_load(tmp_path):
    tyre = imported(tmp_path, tyre="fiala").car.vehicle.table["front"]["bushings"]["tyre"]
    points = np.array(FIALA["Fiala Parameters"]["Vertical Curve Data"])
    # 2.7 kN lie between its second and third point.
    slope = (points[2, 1] - points[1, 1]) / (points[2, 0] - points[1, 0])
    assert tyre["stiffness"][2] == pytest.approx(slope)
    assert (tyre["slip_stiffness"], tyre["cornering_stiffness"]) == (80000.0, 45000.0)


def test_the_static_loads_are_those_that_the_ground_was_placed_for(struts):
    for wheel, load in struts.car.model.static.tyre_load.items():
        axle = "front" if wheel[0] == "f" else "rear"
        table = struts.car.vehicle.table[axle]
        deflection = load / table["bushings"]["tyre"]["stiffness"][2]
        low, high = (table["hardpoints"][name][2] for name in ("tyre_patch", "wheel_center"))
        # The chassis is 10 mm off the middle: right and left wheels differ by a few per cent.
        assert high - low == pytest.approx(0.31 - deflection, abs=1e-3)


@pytest.mark.parametrize("name", ["wishbones", "struts"])
def test_both_engines_run_it_on_plates(name, request):
    car = request.getfixturevalue(name).car
    t = np.arange(0.0, 2.0, 1e-3)
    # Small: the reduced engine has the geometry of the static position; 4 mm differ four times as much.
    z = 1e-3 * np.sin(2 * np.pi * 2.0 * t) * np.minimum(1.0, t)
    runs = {engine: car.run(Signal(time=t, displacement={"fr": z, "rl": 0.5 * z}), engine=engine)
            for engine in ("mujoco", "reduced")}  # fmt: skip
    for channel in ("seat_rail_acc_z", "damper_fr_force", "knuckle_fr_acc_z"):
        exact, fast = (runs[engine][channel] for engine in ("mujoco", "reduced"))
        assert np.sqrt(np.mean((exact - fast) ** 2)) < 1e-2 * np.std(exact), channel
        assert np.std(exact) > 1e-3


def rear_spring(car):
    """Return the note on the rear springs, and its numbers: load, force in Chrono [N], settling [mm]."""
    (note,) = (text for text in car.notes if text.startswith("rear: a main spring"))
    return note, [int(word) for word in re.findall(r"-?\d+", note)]


def test_a_preload_pushes_as_in_chrono(struts, tmp_path):
    """F = F0 - k (length - free length) of LinearSpringForce: at its points the spring has F0 more."""
    preloaded = imported(tmp_path, "strut_car", changes={"wishbones/Spring/Preload": 960.0})
    (_, before), (note, after) = rear_spring(struts), rear_spring(preloaded)
    assert after[0] == before[0] and after[1] - before[1] == pytest.approx(960, abs=1)
    assert after[2] - before[2] == pytest.approx(960 / 48.0, abs=1) and "mm longer" in note


def test_what_is_left_out_is_said(wishbones, struts):
    said = "\n".join(struts.notes)
    for text in ("driveline", "steering", "front: brakes", "Axle: inertia of the drive shafts", "Minimum Length"):
        assert f"{text}" in said and "left out" in said
    assert "front: a main spring carries" in said and "higher under the rear wheels" in said
    # The springs of the rear axle are lines: (4456 N - load) / 48 N/mm.
    note, (carried, there, longer) = rear_spring(struts)
    length = np.linalg.norm(np.subtract(WISHBONE["Spring"]["Location Chassis"], WISHBONE["Spring"]["Location Arm"]))
    assert there == pytest.approx(48000 * (0.55 - length), abs=1) and "mm longer" in note
    assert longer == pytest.approx((there - carried) / 48.0, abs=1)
    assert "Minimum Length" not in "\n".join(wishbones.notes)


def test_every_number_says_where_it_comes_from(struts, tmp_path):
    file = tmp_path / "vehicle.toml"
    file.write_text(struts.text, encoding="utf-8")
    car = Car.load(file)
    assert car.vehicle == struts.car.vehicle
    sources = {entry.path: entry.source for entry in parameter_list(car.vehicle, file)}
    own = [path for path, source in sources.items() if source != "default"]
    assert all(sources[path].startswith(("Chrono", "assumed", "given")) for path in own)
    assert sources["front.hardpoints.strut_top"] == "Chrono strut.json, Spring / Location Chassis"
    assert sources["front.parts.tyre.mass"] == "Chrono wheel.json and tmeasy.json"


def test_the_command_writes_the_car_and_prints_what_is_left_out(tmp_path, capsys, monkeypatch):
    files = write_chrono(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main(["mine", "--from", f"chrono:{files / 'strut_model.json'}"]) == 0
    said = capsys.readouterr().out
    assert "note: left out, front: brakes" in said and "kerb mass [kg]" in said
    assert Car.load(tmp_path / "mine" / "vehicle.toml").vehicle.name == "mine"
    assert (
        main(["other", "--from", f"chrono:{files / 'strut_model.json'}", "--json", "--ride-frequency-rear", "1.4"]) == 0
    )
    checks = json.loads(capsys.readouterr().out)
    assert checks["checks"]["ride_frequency_rear"]["value"] == pytest.approx(1.4, rel=1e-2)
    assert any("left out" in note for note in checks["notes"])
    assert main(["bad", "--from", f"chrono:{files / 'strut_car.json'}"]) == 2
    assert "states no tyre; add the file of a Chrono tyre" in capsys.readouterr().err
    assert main(["bad", "--from", "sedan", "--chrono-tyre", "x.json"]) == 2
    assert "--chrono-tyre: belongs to --from chrono:" in capsys.readouterr().err


def test_an_impossible_moment_of_inertia_is_changed_and_said(tmp_path):
    moments = {"wishbones/Lower Control Arm/Moments of Inertia": [0.04, 0.04, 0.0894]}
    car = imported(tmp_path, changes={**moments, "wishbones/Lower Control Arm/Products of Inertia": [0, 0, 0]})
    inertia = np.sort(np.linalg.eigvalsh(_tensor(car.car.vehicle.table["front"]["parts"]["lower_arm"])))
    assert inertia == pytest.approx([0.0447, 0.0447, 0.0894], rel=1e-4)
    assert any("Lower Control Arm: the largest moment of inertia exceeds" in note for note in car.notes)


def _tensor(part):
    (xx, yy, zz), (xy, zx, yz) = part["inertia"], part.get("products", (0, 0, 0))
    return np.array([[xx, -xy, -zx], [-xy, yy, -yz], [-zx, -yz, zz]])


WEAK = {
    "Vertical": {
        "Nominal Vertical Force [N]": 3000.0, "Tire Vertical Damping [Ns/m]": 500.0,
        "Tire Spring Curve Data": [[0.01, 1000.0], [0.02, 1500.0], [0.03, 1500.0]],
    },
    "Longitudinal": {"Initial Slopes dFx/dsx [N]": [55e3, 110e3]},
    "Lateral": {"Initial Slopes dFy/dsy [N]": [48e3, 77e3]},
}  # fmt: skip
"""Parameters of a tyre with 125 N/mm z - 2500 N/mm2 z^2, which carries 1.56 kN at most."""

BAD = {
    "weak tyre": ({"tmeasy/Parameters": WEAK}, r"tmeasy.json: d1 z \+ d2 z\^2 .* reaches 1562 N, must carry \d+ N"),
    "curve": (
        {"wishbones/Spring/Spring Coefficient": None, "wishbones/Spring/Spring Curve Data": [[0.0, 0.0]]},
        r"Spring / Spring Curve Data must have two points or more, whose first numbers rise",
    ),
    "falling curve": (
        {"wishbones/Shock/Damping Curve Data": [[-1, -900], [1, 900], [0, 0]]},
        r"Shock / Damping Curve Data must have two points or more, whose first numbers rise",
    ),
    "no mass": ({"wishbones/Upright/Mass": None}, r"wishbones.json: Upright / Mass is missing; add it"),
    "text": ({"wishbones/Upright/Mass": "heavy"}, r"Upright / Mass has 'heavy', must be a finite number"),
    "point": ({"wishbones/Upright/COM": [0, 1]}, r"Upright / COM must be a list of 3 finite numbers"),
    "NaN": ({"wishbones/Tierod/Location Upright": [0, float("nan"), 0]}, r"Location Upright must be a list of 3"),
    "suspension": ({"wishbones/Template": "SolidAxle"}, r"type 'SolidAxle', must be DoubleWishbone or MacPhersonStrut"),
    "tyre": ({"tmeasy/Template": "RigidTire"}, r"a tyre of type 'RigidTire', must be TMeasyTire, .*--chrono-tyre"),
    "axles": ({"wishbone_car/Axles": []}, r"0 axles, must be 2"),
    "file": ({"wishbone_car/Chassis/Input File": "small/none.json"}, r"names small/none.json, which is neither"),
    "spring": ({"wishbones/Spring/Spring Coefficient": None}, r"has neither Spring Coefficient nor Spring Curve Data"),
    "damper": ({"wishbones/Shock/Damping Coefficient": None}, r"has neither Damping Coefficient nor Damping Curve"),
    "outside": ({"chassis/Components/0/Centroidal Frame/Location": [9, 0, 0.3]}, r"must be within the wheelbase"),
    "load index": ({"tmeasy/Load Index": 5}, r"Load Index 5, must be 60 to 130"),
    "line": ({"wishbones/Lower Control Arm/Location Upright": [0.17, 0.36, -0.09]}, r"lie on a line"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_a_file_that_cannot_be_a_car_is_refused_by_name(case, tmp_path):
    changes, message = BAD[case]
    with pytest.raises(VehicleError, match=message):
        imported(tmp_path, changes=changes)


def test_a_file_that_is_no_json_is_refused(tmp_path):
    (tmp_path / "car.json").write_text('{"Axles": [')
    with pytest.raises(VehicleError, match=r"car\.json: not a JSON file"):
        chrono_car("small", tmp_path / "car.json")
    with pytest.raises(VehicleError, match=r"none\.json: the file does not exist"):
        chrono_car("small", tmp_path / "none.json")
