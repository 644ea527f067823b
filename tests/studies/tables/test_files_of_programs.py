"""Tyre files against their formulas, Adams models, URDF: points, masses and inertias against independent values."""

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest

from tests.studies.tables.made_files import ADM, CMD, PAR, SUB, TIR_52, TIR_61, urdf
from tests.validation import validated
from vehicle.engines.simulation.car_masses import car_masses
from vehicle.errors import VehicleError
from vehicle.runs.car import Car
from vehicle.studies.design.new_car import new_car
from vehicle.studies.design.stated_numbers import stated_numbers
from vehicle.studies.design.template_car import template_car
from vehicle.studies.tables.car_table import car_table
from vehicle.studies.tables.tyre_file import read_tyre_file

STEP = 1e-5
"""Slip of a difference quotient at zero slip."""


def written(folder: Path, name: str, text: str) -> Path:
    (folder / name).write_text(text)
    return folder / name


def read(*paths):
    return car_table(paths, template_car("sedan").point_names)


def magic(slip, stiffness, c, d):
    """D sin(C atan(B x)), B = K / (C D): the slope at zero is K for any C and D."""
    return d * math.sin(c * math.atan(stiffness / (c * d) * slip))


@pytest.mark.parametrize("load", [2500.0, 4000.0, 5500.0])
def test_slip_stiffness_of_a_tyre_file_is_the_slope_of_its_force(load, tmp_path):
    """Second derivation: the whole force at a small slip, with the numbers of the file typed once more."""
    tyre = read_tyre_file(written(tmp_path, "a.tir", TIR_52))
    df = (load - 4000.0) / 4000.0
    along = load * (21.7 + 13.5 * df) * math.exp(-0.4 * df)
    across = 20.5 * 4000.0 * math.sin(2.0 * math.atan(load / (1.95 * 4000.0)))
    forces = [
        magic(STEP, stiffness, c, d * load) / STEP for stiffness, c, d in ((along, 1.65, 1.2), (across, 1.3, 1.0))
    ]
    validated(
        "Tyres", f"tyre file MF 5.2 at {load:.0f} N: slip and cornering stiffness",
        np.array([tyre.longitudinal(load), tyre.lateral(load)]), np.array(forces),
        source="second derivation: difference quotient of the magic formula (Pacejka 4.E9, 4.E19)", rel=1e-6, unit="N",
    )  # fmt: skip
    assert tyre.trail(load) == pytest.approx(load * (0.09 - 0.009 * df) * 0.3135 / 4000.0, rel=1e-12)


def test_relaxation_lengths_of_a_tyre_file_are_stiffness_over_carcass(tmp_path):
    tyre = read_tyre_file(written(tmp_path, "a.tir", TIR_52))
    along, across = tyre.carcass()
    assert along is not None and across is not None
    assert tyre.longitudinal(4000.0) / along == pytest.approx(2.0 * 0.3135, rel=1e-12)
    sigma = 2.3 * math.sin(2.0 * math.atan(1.0 / 1.9)) * 0.3135
    assert tyre.lateral(4000.0) / across == pytest.approx(sigma, rel=1e-12)
    assert (tyre.vertical_stiffness, tyre["VERTICAL_DAMPING"], tyre["UNLOADED_RADIUS"]) == (2.1e5, 50.0, 0.3135)


def test_a_newer_tyre_file_has_its_pressure(tmp_path):
    """MF 6.1 at 230 kPa instead of 200: dp = 0.15, by hand."""
    tyre = read_tyre_file(written(tmp_path, "a.tir", TIR_61))
    assert tyre.vertical_stiffness == pytest.approx(2.1e5 * (1.0 + 0.7 * 0.15), rel=1e-12)
    assert tyre.longitudinal(4000.0) == pytest.approx(4000.0 * 21.7 * (1.0 - 0.35 * 0.15 + 0.1 * 0.0225), rel=1e-12)
    angle = math.atan(1.0 / (1.95 * (1.0 + 1.2 * 0.15)))
    assert tyre.lateral(4000.0) == pytest.approx(20.5 * 4000.0 * 1.09 * math.sin(1.9 * angle), rel=1e-12)
    assert tyre.carcass() == (3.6e5, 1.1e5)


def test_a_curve_of_load_replaces_the_vertical_stiffness(tmp_path):
    curve = "[DEFLECTION_LOAD_CURVE]\n{pen fz}\n0 0\n0.01 1800\n0.02 4100\n0.03 6900\n"
    tyre = read_tyre_file(written(tmp_path, "a.tir", TIR_52 + curve))
    assert tyre.vertical_stiffness == pytest.approx(230e3, rel=1e-9)


def test_a_tyre_file_gives_the_tyres_of_a_new_car_and_names_what_it_leaves_out(tmp_path):
    table = read(written(tmp_path, "a.tir", TIR_52))
    left_out = " ".join(text for _, text in table.left_out)
    assert "PCX1, PDX1" in left_out and "PCY1" in left_out and "PKX1" not in left_out
    result = new_car("mine", "sedan", stated_numbers(None, {}, table.numbers), table)
    tyre = result.car["front.bushings.tyre.stiffness"].value
    assert tyre[2] == pytest.approx(2.1e5, rel=1e-6)
    assert result.car["rear.bushings.tyre.damping"].value[2] == 50.0
    load = result.car.static.tyre_load["fr"]
    wheels = {wheel.name: wheel for wheel in result.car.vehicle.composition.wheels}
    # The free radius less the deflection.
    assert wheels["fr"].center[2] - wheels["fr"].patch[2] == pytest.approx(0.3135 - load / 2.1e5, abs=2e-5)
    assert result.car["front.bushings.tyre.slip_stiffness"].value == pytest.approx(
        read_tyre_file(tmp_path / "a.tir").longitudinal(load), rel=1e-3
    )


@pytest.mark.parametrize(("name", "text"), [("axle.adm", ADM), ("axle.cmd", CMD)])
def test_points_of_an_adams_model_are_those_of_its_ground(name, text, tmp_path):
    """The ball joint of the deck lies on a part that is turned by 90 deg about z: (-160, 10) becomes (-10, -160)."""
    table = read(written(tmp_path, name, text))
    expected = {"wheel_center": (0.0, 0.75, 0.0), "arm_front": (-0.02, 0.4, -0.14), "arm_rear": (0.3, 0.41, -0.135),
                "lower_ball": (-0.01, 0.86, -0.005), "strut_top": (0.045, 0.575, 0.54)}  # fmt: skip
    if name.endswith("cmd"):
        expected["lower_ball"] = (0.005, 0.7, -0.16)
    for point, at in expected.items():
        assert table.points["front"][point] == pytest.approx(at, abs=1e-9), point
    assert table.numbers["track_front"] == pytest.approx(1.5)
    if name.endswith("adm"):
        assert table.parameters["front", "parts.knuckle.mass"][0] == 9.5


def test_masses_and_inertia_of_a_urdf_are_those_of_mujoco(tmp_path):
    """Second derivation: MuJoCo compiles the same file; its subtree mass, CoG and inertia."""
    path = written(tmp_path, "car.urdf", urdf())
    table = read(path)
    free = urdf().replace('<robot name="car">', '<robot name="car"><mujoco><compiler fusestatic="false"/></mujoco>')
    model = mujoco.MjModel.from_xml_string(free)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mass = model.body_mass.sum()
    cog = (model.body_mass[:, None] * data.xipos).sum(axis=0) / mass
    inertia = np.zeros((3, 3))
    for body in range(model.nbody):
        turn, arm = data.ximat[body].reshape(3, 3), data.xipos[body] - cog
        inertia += turn @ np.diag(model.body_inertia[body]) @ turn.T
        inertia += model.body_mass[body] * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    numbers = table.numbers
    found = [numbers["kerb_mass"], 1.3 - numbers["cog_x"], numbers["cog_height"], numbers["roll_inertia"],
             numbers["pitch_inertia"], numbers["yaw_inertia"]]  # fmt: skip
    validated(
        "Published cars", "URDF of a car: mass, CoG, moments of inertia", np.array(found),
        np.array([mass, cog[0], cog[2], *np.diag(inertia)]), source="second derivation: MuJoCo compiles the URDF",
        rel=1e-5, unit="kg, m, kg m2",
    )  # fmt: skip
    assert (numbers["wheelbase"], numbers["track_front"], numbers["tyre_radius"]) == pytest.approx((2.6, 1.5, 0.31))
    assert numbers["unsprung_mass_rear"] == 40.0
    car = new_car("mine", "sedan", stated_numbers(None, {}, numbers), table).car
    assert isinstance(car, Car)
    assert car_masses(car.model).mass == pytest.approx(1530.0, rel=1e-6)


def test_points_and_masses_of_an_adams_subsystem(tmp_path):
    table = read(written(tmp_path, "front.sub", SUB))
    assert table.points["front"]["lower_ball"] == pytest.approx((0.005, 0.7, -0.16), abs=1e-9)
    assert table.points["front"]["tie_outer"] == pytest.approx((0.15, 0.72, -0.05), abs=1e-9)
    assert table.parameters["front", "parts.knuckle.mass"][0] == 12.5
    left_out = " ".join(text for _, text in table.left_out)
    assert "front.spr" in left_out and "subframe_front" in left_out


def test_keywords_of_a_carsim_file(tmp_path):
    table = read(written(tmp_path, "car.par", PAR))
    expected = {"kerb_mass": 1231.5, "wheelbase": 2.6, "track_front": 1.481, "track_rear": 1.486, "tyre_radius": 0.298,
                "unsprung_mass_rear": 60.5, "wheel_rate_front": 27e3, "wheel_rate_rear": 30e3,
                "cog_x": (1111.0 * 1.04 + 60.5 * 2.6) / 1231.5}  # fmt: skip
    for key, value in expected.items():
        assert table.numbers[key] == pytest.approx(value, rel=1e-6), key
    assert any("FD_TABLE" in text and "OPT_BK" in text for _, text in table.left_out)


def test_what_replaces_the_vertical_stiffness_of_a_tyre_file_is_named(tmp_path):
    curve = "[DEFLECTION_LOAD_CURVE]\n{pen fz}\n0 0\n0.01 1800\n0.02 4100\n0.03 6900\n"
    table = read(written(tmp_path, "a.tir", TIR_52.replace("PKX3 ", "PPX1 = -0.4\nPKX3 ") + curve))
    assert "DEFLECTION_LOAD_CURVE" in table.origins.get("tyre_stiffness_front", "")
    left_out = " ".join(text for _, text in table.left_out)
    assert "VERTICAL_STIFFNESS" in left_out and "PPX1" in left_out
    scaled = read(written(tmp_path, "b.tir", TIR_52.replace("LFZO  ", "LCZ = 0.5\nLFZO  ")))
    assert scaled.numbers["tyre_stiffness_front"] == pytest.approx(1.05e5, rel=1e-12)
    assert "LCZ 0.5" in scaled.origins["tyre_stiffness_front"]


def test_a_steering_wheel_is_no_wheel_of_the_car(tmp_path):
    steering = """<link name="steering_wheel"><inertial><mass value="1"/></inertial></link>
    <joint name="column" type="fixed"><parent link="base"/><child link="steering_wheel"/></joint></robot>"""
    table = read(written(tmp_path, "car.urdf", urdf().replace("</robot>", steering)))
    assert (table.numbers["kerb_mass"], table.numbers["unsprung_mass_front"]) == (1531.0, 40.0)


WRONG = [
    ("fiala.tir", TIR_52.replace("FITTYP                   =52", "PROPERTY_FILE_FORMAT = 'FIALA'"),
     "FIALA.*MF-Tyre 6.1"),
    ("no_load.tir", TIR_52.replace("FNOMIN                   =4000\n", ""), "FNOMIN = missing"),
    ("kilo.tir", TIR_52.replace("'newton'", "'knewton'"), "FNOMIN = 4000000.0 N, must be 500"),
    ("no_slope.tir", TIR_52.replace("PKY1                     =-20.5", "PKY1 = 0"), "PKY1 is missing or 0"),
    ("unit.adm", ADM.replace(", LENGTH = MILLIMETER", ""), "unit of length"),
    ("none.adm", "! nothing\nPART/1, GROUND\n", "no point or part with a known name"),
    ("three.urdf", urdf().replace("wheel_rr", "hoop_rr"), "has 3 links"),
    ("dtd.urdf", '<!DOCTYPE x [<!ENTITY a "b">]>' + urdf(), "document type"),
    ("negative.urdf", urdf(wheel_mass=-1.0), "negative mass|has 0 links"),
    ("loop.urdf", urdf().replace('<joint name="mount" type="fixed"><parent link="base"/>',
                                 '<joint name="up" type="fixed"><parent link="engine"/><child link="base"/></joint>'
                                 '<joint name="mount" type="fixed"><parent link="base"/>'), "loop"),
    ("text.urdf", "<robot", "no XML"),
    ("a.mnf", "x", "flexible body.*body import"),
    ("a.par", "x", "nothing in it is a number"),
    ("a.sub", SUB.replace("LENGTH = 'mm'\n", ""), "unit of length"),
    ("b.sub", "[UNITS]\nLENGTH = 'mm'\n", "no block .HARDPOINT."),
    ("a.spck", "x", "Simpack.*CSV"),
    ("a.asy", "[SUBSYSTEM]\nUSAGE = '<x>/subsystems.tbl/front.sub'\n", "assembly.*--table front.sub"),
    ("a.foo", "x", "the ending .foo is none of CSV"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "text", "message"), WRONG, ids=[row[0] for row in WRONG])
def test_a_file_that_cannot_be_read_is_refused_by_name(name, text, message, tmp_path):
    with pytest.raises(VehicleError, match=message):
        read(written(tmp_path, name, text))
