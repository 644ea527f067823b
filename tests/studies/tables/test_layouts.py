"""Layouts of tables that once gave a wrong number without a word: other signs, columns, titles and notes."""

import pytest

from tests.studies.tables.test_car_table import POINTS, WORDS, read, require_points, rows
from vehicle.errors import VehicleError

SHEET = "Hardpoint,x [mm],y [mm],z [mm]\n"
NUMBERS: dict[str, tuple[str, dict[str, float | None]]] = {
    "points between thousands, decimal comma": (
        "Grösse;Wert;Einheit\nRadstand;2.631;mm\nSpurweite;1.540,5;mm\nAchslast vorn;7.600;N\n",
        {"wheelbase": 2.631, "track_front": 1.5405, "front_axle_load": 7600.0 / 9.81}),
    "four columns of corners": (
        "Parameter,Front left,Front right,Rear left,Rear right,Unit\nCorner weight,480,482,500,505,kg\n"
        "wheel rate,30,30,28,28,N/mm\n",
        {"front_axle_load": 962.0, "rear_axle_load": 1005.0, "wheel_rate_front": 3e4, "wheel_rate_rear": 2.8e4}),
    "unit after empty cells": ("Total mass,3300,,lb\n", {"kerb_mass": 3300.0 * 0.45359237}),
    "unit after a second value": ("Total mass,3300,4000,lb\n", {"kerb_mass": 3300.0 * 0.45359237}),
    "weight as a force": ("Vehicle weight,14.715,kN\n", {"kerb_mass": 1500.0}),
    "rates of both wheels": (
        "Front wheel rate (axle),50,N/mm\nRear suspension stiffness (both springs),48,kN/m\n"
        "wheel damping front,3000,Ns/m,per axle\n",
        {"wheel_rate_front": 2.5e4, "wheel_rate_rear": 2.4e4, "wheel_damping_front": 1500.0}),
    "axle or wheel in a note": (
        "name,value,unit,comment\nunsprung mass front,48,kg,axle\nunsprung mass rear,80,kg,per wheel\n",
        {"unsprung_mass_front": 48.0, "unsprung_mass_rear": 160.0}),
    "words and symbol": (
        "Sprung mass ms,1200,kg\nUnsprung mass front mus_f,80,kg\nUnsprung mass rear mus_r,76,kg\n",
        {"kerb_mass": 1356.0, "unsprung_mass_front": 80.0, "unsprung_mass_rear": 76.0}),
    "half track": ("Half-track,765,mm\n", {"track_front": 1.53, "track_rear": 1.53}),
    "mass with driver": ("Mass with driver,300,kg\n", {"kerb_mass": 300.0}),
    "every number with its unit": ("name,value\nsprung mass front corner,375 kg\nunsprung mass front,45 kg\n",
                                   {"front_axle_load": 840.0, "unsprung_mass_front": 90.0}),
    "suspension after the axle": ("Front suspension stiffness,25,kN/m\n", {"wheel_rate_front": 2.5e4}),
    "referred to the wheel": (SHEET + rows(WORDS["front"]) + "\nFederrate vorn (radbezogen);22".replace(";", ",")
                              + ",N/mm\n", {"wheel_rate_front": 2.2e4, "spring_stiffness_front": None}),
    "height of the car": ("Height,1450,mm\nwheelbase,2.6,m\n", {"wheelbase": 2.6, "cog_height": None}),
    "units in the cells of both axles": ("Parameter,Front,Rear\nRide frequency,1.25 Hz,1.40 Hz\n",
                                         {"ride_frequency_front": 1.25, "ride_frequency_rear": 1.4}),
    "sentence on an axle": ("The car has a live rear axle.\nLive rear axle and MacPherson struts of a mid size car\n"
                            "Total mass,1900,kg\nTyre stiffness,250,N/mm\n",
                            {"kerb_mass": 1900.0, "tyre_stiffness_front": 2.5e5, "rear_axle_load": None}),
    "origin at an axle": ("# origin on the ground at the front axle\ntotal mass,1650,kg\ntyre stiffness,250,N/mm\n",
                          {"kerb_mass": 1650.0, "tyre_stiffness_rear": 2.5e5}),
    "car after the points of an axle": (
        SHEET + "Front suspension\n" + rows(WORDS["plain"]) + "\nParameter,Value,Unit\nTotal weight,1400,kg\n"
        "tyre stiffness,200,N/mm\n", {"kerb_mass": 1400.0, "tyre_stiffness_rear": 2e5}),
    "car after the points, without a header": (
        SHEET + "Front suspension\n" + rows(WORDS["plain"]) + "\ntyre stiffness,200,N/mm\n",
        {"tyre_stiffness_front": 2e5, "tyre_stiffness_rear": 2e5}),
}  # fmt: skip


@pytest.mark.parametrize("case", NUMBERS)
def test_numbers_of_a_layout(case, tmp_path):
    text, wanted = NUMBERS[case]
    table = read(tmp_path, text, name="car.csv")
    for key, value in wanted.items():
        number = table.numbers.get(key)
        assert number is None if value is None else number == pytest.approx(value, rel=1e-9), key


def test_further_values_of_a_row_are_left_out_by_name(tmp_path):
    table = read(tmp_path, "Parameter,Car A,Car B,Unit\nTotal mass,1400,1800,kg\n", name="car.csv")
    assert table.numbers["kerb_mass"] == 1400.0
    assert any("further values 1800" in text for _, text in table.left_out)
    table = read(tmp_path, "Parameter,Laden,Unladen,Unit\nTotal mass,1800,1400,kg\n", name="car.csv")
    assert table.numbers["kerb_mass"] == 1400.0 and any("'Laden'" in text for _, text in table.left_out)


def test_a_motion_ratio_above_one_is_a_guess(tmp_path):
    table = read(tmp_path, "spring rate front,20,N/mm\nmotion ratio front,1.1,-\n", name="car.csv")
    assert table.numbers["wheel_rate_front"] == pytest.approx(1.1**2 * 2e4, rel=1e-12)
    assert any("spring travel per wheel travel" in text for _, text in table.guessed)


OPTIMUM = ("Wheel Center", "CHAS_LowFor", "CHAS_LowAft", "UPRI_LowPnt", "strut top")
LAYOUTS = {
    "points as columns": "Point," + ",".join(WORDS["plain"]) + "\n" + "\n".join(
        ",".join((f"{axis} [mm]", *(f"{1e3 * at[index]:.6f}" for at in POINTS.values())))
        for index, axis in enumerate("xyz")) + "\n",
    "title of the axle in the head, both sides": "Front,X,Y,Z,X,Y,Z\n" + "\n".join(
        f"{name},{1e3 * x:.6f},{1e3 * y:.6f},{1e3 * z:.6f},{1e3 * x:.6f},{-1e3 * y:.6f},{1e3 * z:.6f}"
        for name, (x, y, z) in zip(OPTIMUM, POINTS.values(), strict=True)) + "\n",
    "inches in a sentence": "ISO 8855 axes (x forward, y left, z up), inches, left side points\nname,x,y,z\n"
                            + rows(WORDS["plain"], (-1, -1, 1), side=-1.0, unit=1.0 / 0.0254),
}  # fmt: skip


@pytest.mark.parametrize("layout", LAYOUTS)
def test_points_of_a_layout(layout, tmp_path):
    require_points(read(tmp_path, LAYOUTS[layout]))


@pytest.mark.parametrize("head", ["Points,Front,,,Rear,,\n,x,y,z,x,y,z\n",
                                  "Point,Front x [mm],Front y [mm],Front z [mm],Rear x,Rear y,Rear z\n"])  # fmt: skip
def test_both_axles_beside_each_other(head, tmp_path):
    lines = []
    for name, key in (("wheel centre", "wheel_center"), ("strut top", "strut_top")):
        x, y, z = (1e3 * value for value in POINTS[key])
        lines.append(f"{name},{x:.6f},{y:.6f},{z:.6f},{x + 2600.0:.6f},{y - 10.0:.6f},{z:.6f}")
    table = read(tmp_path, "axes: x rearward, y right, z up\n\n" + head + "\n".join(lines) + "\n", name="car.csv")
    assert table.numbers["wheelbase"] == pytest.approx(2.6, abs=1e-9)
    assert table.points["front"]["strut_top"] == pytest.approx(POINTS["strut_top"], abs=1e-9)
    assert table.points["rear"]["damper_upper"] == pytest.approx((0.03, 0.56, 0.56), abs=1e-9)


def test_german_words_of_axes_and_origin(tmp_path):
    text = ("Achsen: x nach hinten, y nach rechts, z nach oben; Ursprung Vorderachse\nPunkt,x [mm],y [mm],z [mm]\n"
            "Radmitte hinten,2700,750,300\nFederbein oben hinten,2730,570,860\n")  # fmt: skip
    table = read(tmp_path, text, name="car.csv")
    assert table.points["rear"]["damper_upper"] == pytest.approx((0.03, 0.57, 0.56), abs=1e-9)


BAD = {
    "all wheels": ("Total unsprung mass,90,kg\n", "of an axle or of all wheels"),
    "all wheels by size": ("Unsprung mass,160,kg\n", "of an axle or of all wheels"),
    "points of two meanings": ("mass;1.400;kg\nwheelbase;2,6;m\ntrack;1.5;m\n", "thousand or a decimal"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_number_of_two_meanings_is_refused(case, tmp_path):
    text, message = BAD[case]
    with pytest.raises(VehicleError, match=message):
        read(tmp_path, text, name="car.csv")
